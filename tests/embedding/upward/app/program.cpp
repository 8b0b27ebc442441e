// A program that reaches past the public headers.
#include "core/low.hpp"
