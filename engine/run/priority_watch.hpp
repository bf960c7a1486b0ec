// SPDX-License-Identifier: Apache-2.0
// Takes real-time priority away from threads of groups that starve others, and gives it back.
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

/// Sets the real-time priority of a thread, 0: none. False when the system refuses.
bool set_priority(pthread_t thread, int priority) noexcept;

class PriorityWatch {
public:
    PriorityWatch();

    // Control thread.
    /// From now on the thread of the group `name` is watched. `busy_since`: when its present call began, steady ns, or 0.
    /// Further threads than 64 are not watched.
    void add(const std::string& name, pthread_t thread, int priority, const std::atomic<std::int64_t>& busy_since);
    /// Of a thread that is watched, or not; a group that is demoted gets it later.
    void set(pthread_t thread, int priority) noexcept;
    /// Before the thread is joined.
    void remove(pthread_t thread) noexcept;
    /// What happened since the last call, for people.
    std::vector<std::string> take_notices();

    /// Thread of a watchdog, of one at a time. Calls the system; waits for nobody.
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
        std::atomic<int> cause{0};  ///< of its last demotion, a DemotionCause; 0 once it was reported
    };
    /// The control thread holds it for as long as it takes to write a few words.
    void lock() noexcept;
    void unlock() noexcept { is_busy_.store(false, std::memory_order_release); }

    std::atomic<bool> is_busy_{false};
    std::array<Watched, 64> watched_;
    std::vector<GroupLoad> loads_;
    Demotions demotions_;
};

}  // namespace tactus::run
