// SPDX-License-Identifier: Apache-2.0
// Which groups lose real-time priority, on a scheduler of strict priorities that is simulated: one core, steps of 0.1 ms.
#include "engine/run/demotions.hpp"
#include "engine/run/priority.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

using namespace tactus;
using compile::Criticality;

namespace {

struct SimulatedGroup {
    Criticality criticality;
    double rate_hz, cost_ms;
    double hangs_from_s = 1e9, hangs_until_s = 1e9;
    // State:
    std::int64_t released = 0, left_ns = 0, busy_since = 0, spent = 0, worst_ns = 0;
    bool is_demoted = false;
    int demotions = 0;
};

/// One core with SCHED_FIFO above SCHED_OTHER, and throttling: real-time threads get 950 ms of each second.
struct SimulatedCore {
    static constexpr std::int64_t step = 100'000;
    std::vector<SimulatedGroup> groups;
    bool has_watchdog = true;
    static constexpr std::int64_t begin = 1'000'000'000;
    run::Demotions demotions;
    std::int64_t now = begin, used_ns = 0, throttled_ns = 0;

    int priority(const SimulatedGroup& group) const {
        const int rank = run::priority_of(group.criticality,
                                          static_cast<Flicks>(static_cast<double>(flicks_per_second) / group.rate_hz));
        return group.is_demoted ? 0 : rank;
    }

    void run(double seconds) {
        const std::int64_t end = now + static_cast<std::int64_t>(seconds * 1e9);
        for (; now < end; now += step) {
            if ((now - begin) % 1'000'000'000 == 0) used_ns = 0;
            release();
            const bool is_throttled = used_ns >= 950'000'000;
            SimulatedGroup* chosen = nullptr;
            for (SimulatedGroup& group : groups) {
                if (group.left_ns <= 0 || (is_throttled && !group.is_demoted)) continue;
                if (!chosen || priority(group) > priority(*chosen)) chosen = &group;
            }
            throttled_ns += is_throttled ? step : 0;
            if (chosen) work(*chosen);
            if (has_watchdog && !is_throttled && now % 1'000'000 == 0) look();
        }
    }

    void release() {
        for (SimulatedGroup& group : groups) {
            const auto due =
                begin + static_cast<std::int64_t>(static_cast<double>(group.released) * 1e9 / group.rate_hz);
            // Late calls are left out, as in a group without backlog.
            if (now < due || group.left_ns > 0) continue;
            ++group.released;
            group.left_ns = static_cast<std::int64_t>(group.cost_ms * 1e6);
            const double at = static_cast<double>(now - begin) * 1e-9;
            if (at >= group.hangs_from_s && at < group.hangs_until_s)
                group.left_ns = static_cast<std::int64_t>((group.hangs_until_s - at) * 1e9);
            group.busy_since = now;
        }
    }

    void work(SimulatedGroup& group) {
        group.left_ns -= step;
        group.spent += step;
        if (!group.is_demoted) used_ns += step;
        if (group.left_ns > 0) return;
        group.worst_ns = std::max(group.worst_ns, now - group.busy_since);
        group.busy_since = 0;
    }

    void look() {
        std::vector<run::GroupLoad> loads;
        for (SimulatedGroup& group : groups) {
            const bool was = std::exchange(group.is_demoted, false);
            loads.push_back({priority(group), group.busy_since, group.spent});
            group.is_demoted = was;
        }
        const auto causes = demotions.look(now, loads);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const bool is_demoted = causes[g] != run::DemotionCause::none;
            groups[g].demotions += is_demoted && !groups[g].is_demoted;
            groups[g].is_demoted = is_demoted;
        }
    }
};

}  // namespace

TEST_CASE("a hand comes before sound, and sound before the world, at every rate") {
    for (const Flicks hand : {ms / 4, ms, 17 * ms})
        for (const Flicks other : {ms / 8, ms, 250 * ms}) {
            using run::priority_of;
            CHECK(priority_of(Criticality::force_output, hand) > priority_of(Criticality::force_value, other));
            CHECK(priority_of(Criticality::force_value, hand) > priority_of(Criticality::sound, other));
            CHECK(priority_of(Criticality::sound, hand) > priority_of(Criticality::world_value, other));
            CHECK(priority_of(Criticality::world_value, hand) > priority_of(Criticality::other, other));
            if (other < hand)
                CHECK(priority_of(Criticality::force_value, other) > priority_of(Criticality::force_value, hand));
        }
}

TEST_CASE("a hand beside two sound groups that ask for more than a core keeps all its ticks") {
    for (const double cost : {0.3, 0.6, 0.8, 1.2}) {
        CAPTURE(cost);
        SimulatedCore core;
        core.groups = {{Criticality::force_output, 1000.0, 0.1},
                       {Criticality::sound, 1000.0, cost},
                       {Criticality::sound, 1000.0, cost}};
        core.run(3.0);
        CHECK(core.groups[0].released == 3000);
        CHECK(core.groups[0].worst_ns < 1'000'000);
        CHECK(core.throttled_ns == 0);
        CHECK(core.groups[0].demotions == 0);
    }
}

TEST_CASE("groups that overrun are demoted before the kernel stops the watchdogs") {
    for (const bool has_watchdog : {true, false}) {
        CAPTURE(has_watchdog);
        SimulatedCore core;
        core.has_watchdog = has_watchdog;
        core.groups = {{Criticality::force_output, 1000.0, 0.1},
                       {Criticality::other, 400.0, 3.0},
                       {Criticality::other, 500.0, 3.0}};
        core.run(3.0);
        CHECK((core.throttled_ns == 0) == has_watchdog);
        CHECK(core.groups[0].demotions == 0);
        if (has_watchdog) CHECK(core.groups[0].worst_ns < 1'000'000);
    }
}

TEST_CASE("a group that hangs is demoted after 20 ms, and gets its priority back when its calls are short again") {
    SimulatedCore core;
    core.groups = {{Criticality::force_output, 1000.0, 0.1}, {Criticality::force_value, 1000.0, 0.1, 0.5, 0.9}};
    core.run(0.519);
    CHECK_FALSE(core.groups[1].is_demoted);
    core.run(0.004);
    CHECK(core.groups[1].is_demoted);
    core.run(0.5);
    CHECK(core.groups[1].busy_since == 0);
    core.run(1.1);
    CHECK_FALSE(core.groups[1].is_demoted);
    CHECK(core.groups[1].demotions == 1);
    CHECK(core.groups[0].demotions == 0);
}

TEST_CASE("the least critical group is demoted by load, not one that uses next to nothing") {
    run::Demotions demotions;
    std::vector<run::GroupLoad> loads{{70, 0, 0}, {60, 0, 0}, {50, 0, 0}, {40, 0, 0}};
    demotions.look(1'000'000'000, loads);
    for (const auto& [group, share] :
         std::vector<std::pair<std::size_t, double>>{{0, 0.1}, {1, 0.5}, {2, 0.4}, {3, 0.001}})
        loads[group].spent = static_cast<std::int64_t>(share * 1e8);
    const auto causes = demotions.look(1'100'000'000, loads);
    using run::DemotionCause;
    CHECK(causes == std::vector{DemotionCause::none, DemotionCause::none, DemotionCause::load, DemotionCause::none});
}
