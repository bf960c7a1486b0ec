// SPDX-License-Identifier: Apache-2.0
// A system that refuses to make threads.
#pragma once

namespace tactus::test {

/// Until it is destroyed, the thread that is asked for after `allowed` others is refused, and every one after it. One at a
/// time.
struct RefusedThreads {
    explicit RefusedThreads(int allowed);
    ~RefusedThreads();
    RefusedThreads(const RefusedThreads&) = delete;
    RefusedThreads& operator=(const RefusedThreads&) = delete;
    /// How many were asked for.
    int asked() const;
};

/// For the program's own pthread_create (virtual_clock.cpp): whether this thread is refused.
bool refuses_thread() noexcept;

}  // namespace tactus::test
