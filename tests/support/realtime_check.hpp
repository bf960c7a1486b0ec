// SPDX-License-Identifier: Apache-2.0
// Shows that code inside a RealtimeScope is real-time safe. Two layers watch it:
//   1. malloc and its kin, mutexes, condition variables and sleeps are replaced in the test executable and counted;
//   2. Linux syscall user dispatch traps every system call of the watched thread (x86-64 only).
// Under ThreadSanitizer only allocations are seen, because it owns the other functions and delays signals.
#pragma once

#include "dsp/core/realtime.hpp"

#include <cstdint>
#include <string>

namespace tactus {

/// What happened inside real-time scopes. Layer 1 counts on all threads, layer 2 on the watched one.
struct RealtimeViolations {
    std::int64_t allocations = 0;  ///< malloc, calloc, realloc, aligned_alloc, posix_memalign
    std::int64_t releases = 0;     ///< free of a non-null pointer
    std::int64_t locks = 0;        ///< mutexes, read-write locks, the guard of a local static that is used first
    std::int64_t waits = 0;        ///< condition variables and semaphores, nanosleep, usleep, clock_nanosleep
    std::int64_t prints = 0;       ///< printf and its kin, fwrite, fputs, puts: also those that only fill a buffer
    std::int64_t system_calls = 0;
    std::int64_t system_call = -1;  ///< number of the last one

    bool none() const { return allocations + releases + locks + waits + prints + system_calls == 0; }
    /// "2 allocations, 1 system call (last: number 1)", or "none".
    std::string describe() const;
};

/// Which kinds can be seen in this build on this machine; `missing` says why not all, for the test to print.
struct RealtimeWatch {
    bool locks_and_waits = false;
    bool system_calls = false;
    std::string missing;
};
RealtimeWatch realtime_watch();

namespace detail {

/// Counts between construction and `finish`. Does not nest.
class Watching {
public:
    Watching();
    ~Watching();
    Watching(const Watching&) = delete;
    Watching& operator=(const Watching&) = delete;
    RealtimeViolations finish();

private:
    bool armed_ = false;
};

}  // namespace detail

/// Runs `code` and counts what it does inside the real-time scopes that it opens itself.
template <class Code>
RealtimeViolations watch_scopes(Code&& code) {
    detail::Watching watching;
    code();
    return watching.finish();
}

/// Runs `code` inside a real-time scope and counts what it does.
template <class Code>
RealtimeViolations watch(Code&& code) {
    return watch_scopes([&] {
        const RealtimeScope scope;
        code();
    });
}

}  // namespace tactus
