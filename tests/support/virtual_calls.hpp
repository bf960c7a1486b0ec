// SPDX-License-Identifier: Apache-2.0
// The C library's functions in virtual time, for the definitions that the test programs have of them.
#pragma once

#include <cstdint>

#include <poll.h>
#include <pthread.h>
#include <time.h>

namespace tactus::test::virtual_time {

struct Thread;
/// The calling thread, when it takes part in a VirtualClock.
extern constinit thread_local Thread* current;

inline bool applies() noexcept { return current != nullptr; }

// By threads that take part. Results are those of the functions of the same names.
int sleep(clockid_t clock, int flags, const timespec& when) noexcept;
int sleep_for(const timespec& duration) noexcept;
int lock(pthread_mutex_t* mutex) noexcept;
int unlock(pthread_mutex_t* mutex) noexcept;
/// `until` null: for ever.
int wait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept;
int poll(pollfd* files, nfds_t count, int longest_ms) noexcept;

/// By any thread: wakes threads that take part. False: none of them waits for the condition.
bool wake(const void* address, bool all) noexcept;

}  // namespace tactus::test::virtual_time
