// Recovers a camera from its two matrices, whatever its convention (embedding promise 5).
#pragma once
#include "clusters/cluster_types.shared.h"
#include "umbrage/frame.hpp"
#include "umbrage/result.hpp"

namespace umbrage::clusters {

/// Its tiles are numbered from 0. Errors: invalid_argument when a matrix is not finite, singular, or neither a perspective nor an
/// orthographic projection.
Result<shared::CameraRecord> camera_record(const CameraDesc&);

}  // namespace umbrage::clusters
