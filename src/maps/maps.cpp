// Compiles the shared header's assertions.
#include "maps/map_types.shared.h"
