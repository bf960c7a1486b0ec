// SPDX-License-Identifier: Apache-2.0
// Drives every node type that outputs a wrench through its parameter range, with hands of many forces and speeds and at
// many rates, and judges the force on the hand. The node types, their parameters and their inputs are read from their
// declarations, so a new node is swept without an entry here.
#pragma once

#include "graph/node/node.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tactus::test {

/// Values of a node's members; members that are left out keep their defaults.
struct NodeSetting {
    std::map<std::string, double> numbers;  ///< of parameters, SI
    std::map<std::string, std::string> words;  ///< of choices and flags

    std::string text() const;  ///< "stiffness=800 keep=outside"
};

/// How the hand moves.
struct SweptHand {
    double force = 3.0;  ///< N: the hand presses until the node renders this much
    double speed = 0.1;  ///< m/s, mean along the path
    double rate = 1000.0;  ///< Hz
};

struct ForceTrial {
    const NodeType* type = nullptr;
    NodeSetting setting;
    SweptHand hand;
    std::uint64_t seed = 0;  ///< of the path, of the orientation and of what optional inputs carry
    int max_ticks = 250;  ///< of the path; longer paths are made smaller
};

struct ForceOutcome {
    std::string refusal;  ///< why the node does not accept the setting; "": it does
    double largest_N = 0.0;  ///< of the node on the closed path
    double largest_Nm = 0.0;
    double jump_N = 0.0;  ///< largest change in one tick that no refinement of the path makes smaller
    double jump_Nm = 0.0;
    double work_J = 0.0;  ///< done on the hand on the closed path beyond what sampling explains
    double given_N = 0.0;  ///< largest force that device_output gave, over its limit
    double gained_J = 0.0;  ///< energy that a free hand got out of device_output beyond the bound of the energy cap
    std::vector<std::string> failures;

    bool is_engaged() const { return largest_N > 0.02 || largest_Nm > 1e-3; }
};

/// All types of the catalogue with an output of type wrench, except those that end at a device.
std::vector<const NodeType*> force_types();

/// Every pair of extreme values of two members occurs in at least one of these settings (covering array of strength 2).
std::vector<NodeSetting> pairwise_corners(const NodeType& type);

/// Random setting number `n` that the node accepts: each member keeps its default with a probability of 0.3.
NodeSetting random_setting(const NodeType& type, std::uint64_t n);

/// The settings of the bench, by number: five times the defaults, the corners, and random ones. Where the node refuses a
/// corner, members that contradict each other keep their defaults.
std::vector<NodeSetting> bench_settings(const NodeType& type, std::uint64_t random_count);

/// Random hand number `n`: 0.5 to 20 N, 0.01 to 1 m/s, 500 to 4000 Hz, each uniform in its logarithm.
SweptHand random_hand(std::uint64_t n);

/// Drives the node along a closed path and then lets a free hand press it through `device_output`.
///
/// Jumps: the path is replayed with its displacement refined 16 times. A change of more than 0.2 N (10 mN·m) and 2 % of the
/// largest force in one tick is refined by another 16 times: a steep law becomes smaller, a true jump stays.
///
/// Energy: a force F that is held while the hand moves by d does F·d. If the force goes from F to F' in that tick, a
/// continuous one does no less than F·d − |(F' − F)·d|, and its sum over a closed path is zero for a conservative force and
/// negative with friction and dampers. So sampling explains |(F' − F)·d| per tick: on the refined path a sixteenth.
///
/// Limit and cap: a mass of 0.1 to 1 kg flies into the contact, is pressed with the force of the hand, and pulls away.
/// `device_output` may give it 1.05 times what it took and EnergyCap::max_gain.
ForceOutcome run_trial(const ForceTrial& trial);

}  // namespace tactus::test
