// SPDX-License-Identifier: Apache-2.0
// The real-time scope: code inside must not allocate, lock, wait, log, throw or do I/O. Tests watch `realtime_depth`.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace tactus {

/// How many real-time scopes the calling thread is inside of. Read by the test interposer.
extern thread_local constinit int realtime_depth;

struct RealtimeScope {
    RealtimeScope() noexcept { ++realtime_depth; }
    ~RealtimeScope() { --realtime_depth; }
    RealtimeScope(const RealtimeScope&) = delete;
    RealtimeScope& operator=(const RealtimeScope&) = delete;
};

/// Denormal numbers read and written as zero on the calling thread: a decaying filter costs 20 times more on them.
/// Every computing thread calls this, offline and while preparing too, so that results agree.
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
