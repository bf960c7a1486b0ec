// SPDX-License-Identifier: Apache-2.0
// A live run in which one thing is done, and what hands felt of it.
#pragma once

#include "engine/run/engine.hpp"
#include "tests/engine/watched_hand.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tactus::test {

/// How soon a force has to be gone.
constexpr double prompt_ms = 20.0;
/// Of a live case on a machine that others keep busy.
constexpr int attempts = 5;

/// The hand `left` on its spring, and two chaotic nodes that hear each other, one of them at `rate`.
std::string with_slow_group(const std::string& rate);

/// A live run with one thing done after `at` seconds of the hand's time; 'watch' goes on being called.
struct LiveCase {
    std::string text;
    double seconds = 30.0;
    std::function<void(run::Engine&)> deed;  ///< once
    std::function<bool(run::Engine&)> is_over;  ///< asked after the deed: the run is to stop
    take::TakeWriter* take = nullptr;
    double at = 0.5;
};

struct LiveOutcome {
    std::int64_t done_ns = 0, returned_ns = 0, stopped_ns = 0;
    run::Engine::PortHashes hashes;
    std::vector<std::string> faults;
};

LiveOutcome run_case(const LiveCase& what, const WatchedHand& hand);

inline double ms_between(std::int64_t from, std::int64_t to) { return static_cast<double>(to - from) * 1e-6; }

}  // namespace tactus::test
