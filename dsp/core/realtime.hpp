// SPDX-License-Identifier: Apache-2.0
// The real-time scope: code inside must not allocate, lock, wait, log, throw or do I/O. Tests watch `realtime_depth`.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace tactus {

/// Number of real-time scopes that the calling thread is in. Read by the test interposer.
extern thread_local constinit int realtime_depth;

struct RealtimeScope {
    RealtimeScope() noexcept { ++realtime_depth; }
    ~RealtimeScope() { --realtime_depth; }
    RealtimeScope(const RealtimeScope&) = delete;
    RealtimeScope& operator=(const RealtimeScope&) = delete;
};

/// Flushes denormal numbers to zero on the calling thread: they slow a decaying filter 20-fold. Every computing thread
/// calls this, also offline and while preparing, so that results agree.
inline void flush_denormals_to_zero() noexcept {
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040);
#elif defined(__aarch64__)
    unsigned long control;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    asm volatile("msr fpcr, %0" ::"r"(control | (1UL << 24)));
#endif
}

}  // namespace tactus
