// Execution modes with literal operands (Invocations, OutputVertices) set per pipeline: specialization constants cannot.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace umbrage::layered {

constexpr uint32_t kInvocations = 0, kOutputVertices = 26;  ///< SPIR-V, 3.6 Execution Mode.

/// A copy of the module whose OpExecutionMode `mode` has this literal. Precondition: there is one.
std::vector<uint32_t> with_execution_mode(std::span<const uint32_t> spirv, uint32_t mode, uint32_t literal);

}  // namespace umbrage::layered
