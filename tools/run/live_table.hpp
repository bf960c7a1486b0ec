// SPDX-License-Identifier: Apache-2.0
// Status of a run as a text table: its groups, and the slowest nodes.
#pragma once

#include "engine/run/engine.hpp"
#include "tools/run/force_news.hpp"

#include <string>
#include <vector>

namespace tactus::run {

/// Time of a node per call of its group.
struct NodeTime {
    std::string node, group;
    double mean_us = 0.0, max_us = 0.0;
    double share = 0.0;  ///< mean time as a fraction of the group's period
};

/// Returns at most `count` nodes, largest fraction first. For the control thread, or after the run.
std::vector<NodeTime> slowest_nodes(const run::Engine& engine, std::size_t count);

/// Returns "3 skipped (2 woken late, 1 preempted)", or "" for none.
std::string describe_lateness(const run::GroupRuntime& group);

/// "+12 ppm, 0 underflows (0 frames of silence), 0 frames dropped, 0 left out".
std::string describe_sound(const io::SoundCard& card);

/// Returns several lines without a final line end: time, force, faults, a row per group and the slowest nodes.
std::string live_table(const run::Engine& engine, LetReturn way);

}  // namespace tactus::run
