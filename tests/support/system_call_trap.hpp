// SPDX-License-Identifier: Apache-2.0
// Layer 2: traps the system calls of the calling thread (Linux syscall user dispatch).
#pragma once

namespace tactus {

/// From here each system call of this thread inside a real-time scope is counted, then done. False where the kernel, the
/// processor or a sanitizer does not allow it.
bool arm_system_call_trap();
void disarm_system_call_trap();
/// Whether those of this thread are trapped now.
bool traps_system_calls() noexcept;

}  // namespace tactus
