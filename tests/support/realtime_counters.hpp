// SPDX-License-Identifier: Apache-2.0
// Layer 1: counts of forbidden library calls inside real-time scopes, and the system calls of layer 2.
#pragma once

#include "tests/support/realtime_check.hpp"

namespace tactus {

/// Sets all counts to zero and installs the sanitizer's hooks where malloc cannot be replaced.
void start_counting();
RealtimeViolations counted();
void count_system_call(std::int64_t number) noexcept;
/// False where the sanitizer owns the functions.
bool interposes_locks();

}  // namespace tactus
