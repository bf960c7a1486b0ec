// SPDX-License-Identifier: Apache-2.0
// Decides which groups lose their real-time priority, so that more critical groups, the watchdogs and the rest of the
// machine keep running.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::run {

/// State of a group's thread as measured by a watchdog. Times in ns of one steady clock.
struct GroupLoad {
    int priority = 0;           ///< by rank; larger is more critical
    std::int64_t busy_since = 0;  ///< start of its current call; 0: between two calls
    std::int64_t spent = 0;     ///< processor time since the thread began
};

enum class DemotionCause : std::uint8_t {
    none,
    no_progress,  ///< one call lasts longer than 20 ms
    load,         ///< real-time groups use more than 85 % of a core, and this is the least critical of them
};

/// A thread of real-time priority that never sleeps starves everything below it, and the kernel then stops all real-time
/// threads of that core, the watchdogs too, for the rest of each second (`sched_rt_runtime_us`: 50 ms). Yielding does not
/// help: two groups that use 60 % each exceed a core. Therefore a watchdog demotes groups from outside. Pure logic: for
/// one thread at a time.
class Demotions {
public:
    static constexpr std::int64_t longest_call_ns = 20'000'000;
    static constexpr std::int64_t window_ns = 100'000'000;
    static constexpr double largest_load = 0.85;  ///< of one core
    static constexpr std::int64_t shortest_demotion_ns = 1'000'000'000, longest_demotion_ns = 64'000'000'000;

    /// Checks all groups. Returns for each the cause of its demotion; none: it keeps or regains real-time priority. A
    /// group regains it when its calls have been short for the length of the demotion: 1 s, doubled at each further
    /// one.
    const std::vector<DemotionCause>& look(std::int64_t now, const std::vector<GroupLoad>& groups);

    /// Resets the state of an index that a different group uses from now on.
    void forget(std::size_t group);

private:
    struct State {
        DemotionCause cause = DemotionCause::none;
        std::int64_t until = 0, lasts = shortest_demotion_ns;
        std::int64_t spent_before = 0;  ///< when the window began
        bool is_known = false;  ///< in the current window
    };
    void demote(std::size_t group, DemotionCause cause, std::int64_t now);
    void check_load(std::int64_t now, const std::vector<GroupLoad>& groups);

    std::vector<State> states_;
    std::vector<DemotionCause> causes_;
    std::int64_t window_began_ = 0;
};

}  // namespace tactus::run
