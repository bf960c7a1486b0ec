// SPDX-License-Identifier: Apache-2.0
// The channels of sound cards that a plan plays on.
#pragma once

#include "graph/compile/plan.hpp"

#include <optional>
#include <string>

namespace tactus::compile {

struct SoundTarget {
    std::string card;  ///< part of its name; "": the card of the run
    int channel = 1;   ///< from 1
};

/// The channel that a node plays on; none when it has a stream of its own, or plays nothing.
std::optional<SoundTarget> sound_target(const PlanNode& node);

/// The channel that a node hears; none when it hears nothing. Such a node has the text parameters `sensor` and `card`.
std::optional<SoundTarget> sound_source(const PlanNode& node);

/// A node without a channel plays on channel 1 of a card that a node of its group hears, when no other node does: many cards
/// cannot be opened twice.
void join_heard_cards(Plan& plan);

/// An output channel of a card has one node, and all nodes with channels of one card are in one group.
void check_sounds(const Plan& plan, patch::Problems& problems);

}  // namespace tactus::compile
