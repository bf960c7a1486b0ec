// SPDX-License-Identifier: Apache-2.0
// Commands that change the arrangement of a plan. A hand, a window and a program give the same ones, and one function
// applies them (plan_history.hpp), so that a run and its plan file cannot disagree.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

namespace tactus::plan {

// Fragments are meant by their index in the plan. Poses are of the fragment's file: p_case = R p_file + t.

inline constexpr std::size_t max_fragments = 1000;  ///< of a plan
using FragmentSet = std::bitset<max_fragments>;
/// Numbers that no plan has are left out.
FragmentSet set_of(std::span<const int> fragments) noexcept;
inline FragmentSet set_of(std::initializer_list<int> fragments) noexcept {
    return set_of(std::span(fragments.begin(), fragments.size()));
}

/// Numbers of a fit, as in PlanFit.
struct FitNumbers {
    double score = 0.0, margin = 0.0;
    double rms = 0.0, gap = 0.0, penetration = 0.0;  ///< m
    double overlap = 0.0;  ///< m²
};

/// Leaves a fragment, and all that move with it, at a pose.
struct PlaceFragment {
    int fragment = -1;
    Pose pose;
};
/// What vouches for a pose: a fit of fractures, or a surgeon's decision (tools/analysis/plan/plan_accept.hpp).
enum class FitBasis : std::uint8_t { fracture, hand, mirror, plan };
/// The same at a fit to its partner; −1: the fit names none.
struct SettleFragment {
    int fragment = -1, partner = -1;
    Pose pose;
    FitNumbers fit;
    FitBasis basis = FitBasis::fracture;
};
/// The fragments, and all that move with them, move together from now on, as one group.
struct JoinFragments {
    FragmentSet fragments;
};
/// The fragments, or the outermost groups that they are in, become members of a group, by its number in the arrangement.
struct AddFragments {
    int group = -1;
    FragmentSet fragments;
};
/// The fragments leave all their groups.
struct SplitFragments {
    FragmentSet fragments;
};
/// The members of a group belong to the group around it, or to none.
struct DissolveGroup {
    int group = -1;
};
struct LockFragments {
    FragmentSet fragments;
    bool is_locked = true;
};
struct HideFragments {
    FragmentSet fragments;
    bool is_hidden = true;
};
struct UndoStep {};
struct RedoStep {};
/// Goes to an alternative by its place in the plan's list; their number: begins another one at the present state.
struct GoToAlternative {
    int alternative = -1;
};
/// Removes an alternative that is not the current one. Its steps stay.
struct DropAlternative {
    int alternative = -1;
};
/// Brings the alternative back that was dropped last.
struct RestoreAlternative {};

using PlanCommand = std::variant<PlaceFragment, SettleFragment, JoinFragments, AddFragments, SplitFragments,
                                 DissolveGroup, LockFragments, HideFragments, UndoStep, RedoStep, GoToAlternative,
                                 DropAlternative, RestoreAlternative>;
static_assert(std::is_trivially_copyable_v<PlanCommand>, "commands pass through rings");

/// A command as a run records it.
struct PlanRecord {
    std::int64_t number = 0;  ///< of the command in the run, from 0: a gap means that one was lost
    PlanCommand command;
};

/// Adds the fields of a command, and not the bytes between them.
void add_to(Hash& hash, const PlanCommand& command) noexcept;

/// A number of a command, as a parameter of the node that applies it.
struct PlanCommandNumber {
    std::string_view name, start, least, most;  ///< with units
    std::string_view unit;  ///< " m", or empty
    const char* about;
};
/// The numbers of a command in their order: the command port of case_scene, and what its senders set. SI units. What a
/// kind does not use is 0.
inline constexpr auto plan_command_port = std::to_array<PlanCommandNumber>({
    {"command", "0", "0", "13", "",
     "kind of a command from outside: 1 place, 2 settle, 3 join, 4 add to a group, 5 split, 6 dissolve a group, 7 "
     "lock, "
     "8 hide, 9 undo, 10 redo, 11 go to an alternative, 12 drop an alternative, 13 restore the last dropped one; 0: "
     "none"},
    {"command_first", "0", "-1", "1000000", "", "fragment of place and settle; group or alternative"},
    {"command_second", "0", "-1", "1000000", "", "the partner of settle; -1: none"},
    {"command_set", "0", "0", "65535", "", "fragments of join, add, split, lock and hide: the sum of 2^n of each"},
    {"command_switch", "0", "0", "3", "",
     "lock and hide: 1 does so, 0 undoes it; settle: basis of the pose, 0 the fracture, 1 a surgeon's eye, 2 the "
     "mirrored "
     "side, 3 the plan of a reconstruction"},
    {"command_x", "0 m", "-1000 m", "1000 m", " m", "position of the fragment's file"},
    {"command_y", "0 m", "-1000 m", "1000 m", " m", "the same"},
    {"command_z", "0 m", "-1000 m", "1000 m", " m", "the same"},
    {"command_qw", "1", "-2", "2", "", "orientation of the fragment's file"},
    {"command_qx", "0", "-2", "2", "", "the same"},
    {"command_qy", "0", "-2", "2", "", "the same"},
    {"command_qz", "0", "-2", "2", "", "the same"},
    {"command_score", "0", "-1000000", "1000000", "", "of the fit"},
    {"command_margin", "0", "-1000000", "1000000", "", "of the fit"},
    {"command_rms", "0 m", "-1000 m", "1000 m", " m", "of the fit"},
    {"command_gap", "0 m", "-1000 m", "1000 m", " m", "of the fit"},
    {"command_penetration", "0 m", "-1000 m", "1000 m", " m", "of the fit"},
    {"command_overlap", "0 m^2", "-1000 m^2", "1000 m^2", " m^2", "of the fit"},
});
/// Fragments of a set that pass through the port; a run has no more.
inline constexpr std::size_t max_port_fragments = 16;

using PlanCommandNumbers = std::array<double, plan_command_port.size()>;
/// The kind is 0 for a set with a fragment beyond max_port_fragments.
PlanCommandNumbers numbers_of(const PlanCommand& command) noexcept;
/// None for numbers that are no command: an unknown kind, places that are not whole or beyond ±1e6. Poses are not checked.
std::optional<PlanCommand> command_of(const PlanCommandNumbers& numbers) noexcept;

}  // namespace tactus::plan
