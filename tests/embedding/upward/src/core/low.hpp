// Includes from a folder above it: check_layers.cmake must say so.
#pragma once
#include "gpu/high.hpp"
