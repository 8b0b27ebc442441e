// The folder above.
#pragma once
#include "core/low.hpp"
