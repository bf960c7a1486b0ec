// SPDX-License-Identifier: Apache-2.0
// The channels of sound cards that the nodes of a plan use.
#pragma once

#include "graph/compile/schedule.hpp"

#include <optional>
#include <string>

namespace tactus::compile {

struct SoundTarget {
    std::string card;  ///< substring of its name; "": the card of the run
    int channel = 1;   ///< from 1
};

/// The channel on which a node plays; nothing if the node plays no sound or has a stream of its own.
std::optional<SoundTarget> sound_target(const ScheduleNode& node);

/// The channel from which a node records; nothing if it records none. Such a node has the text parameters `sensor` and
/// `card`.
std::optional<SoundTarget> sound_source(const ScheduleNode& node);

/// Assigns a node without a channel to channel 1 of a card from which a node of its group records, if no other node
/// uses that channel. Many cards cannot be opened twice.
void join_heard_cards(Schedule& plan);

/// Checks that each output channel of a card has one node, and that all nodes with channels of one card are in one
/// group.
void check_sounds(const Schedule& plan, patch::Problems& problems);

}  // namespace tactus::compile
