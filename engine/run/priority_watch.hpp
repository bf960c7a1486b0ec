// SPDX-License-Identifier: Apache-2.0
// Demotes threads of groups that starve others from real-time priority, and restores it.
#pragma once

#include "engine/run/demotions.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <pthread.h>
#include <time.h>

namespace tactus::run {

/// Sets the real-time priority of a thread, 0: none. Returns false if the system refuses.
bool set_priority(pthread_t thread, int priority) noexcept;

class PriorityWatch {
public:
    PriorityWatch();

    // Control thread.
    /// Watches the thread of the group `name` from now on. `busy_since`: start of its current call, steady ns, or 0. At
    /// most 64 threads are watched; further ones are ignored.
    void add(const std::string& name, pthread_t thread, int priority, const std::atomic<std::int64_t>& busy_since);
    /// Sets the priority of a thread, watched or not; a demoted group gets it later.
    void set(pthread_t thread, int priority) noexcept;
    /// Call before the thread is joined.
    void remove(pthread_t thread) noexcept;
    /// Returns messages about changes since the last call.
    std::vector<std::string> take_notices();

    /// For the thread of a watchdog, one at a time. Makes system calls, but never waits.
    void look(std::int64_t now_ns) noexcept;

private:
    struct Watched {
        bool is_used = false;
        std::string name;
        pthread_t thread{};
        clockid_t clock{};
        int priority = 0;
        const std::atomic<std::int64_t>* busy_since = nullptr;
        bool is_demoted = false;
        std::atomic<int> cause{0};  ///< of its last demotion, a DemotionCause; 0 after it was reported
    };
    /// The control thread holds this lock only while it writes a few words.
    void lock() noexcept;
    void unlock() noexcept { is_busy_.store(false, std::memory_order_release); }

    std::atomic<bool> is_busy_{false};
    std::array<Watched, 64> watched_;
    std::vector<GroupLoad> loads_;
    Demotions demotions_;
};

}  // namespace tactus::run
