// SPDX-License-Identifier: Apache-2.0
// Commands that change the arrangement of a plan. A hand, a window and a program give the same ones, and one function
// applies them (plan_history.hpp), so that a run and its plan file cannot disagree.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>

namespace tactus::plan {

// Fragments are meant by their index in the plan. Poses are of the fragment's file: p_case = R p_file + t.

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
enum class FitBasis : std::uint8_t { fracture, hand, mirror };
/// The same at a fit to its partner; −1: the fit names none.
struct SettleFragment {
    int fragment = -1, partner = -1;
    Pose pose;
    FitNumbers fit;
    FitBasis basis = FitBasis::fracture;
};
/// The two fragments, and all that move with them, move together from now on.
struct JoinFragments {
    int fragment = -1, other = -1;
};
/// The fragment leaves all its groups.
struct SplitFragment {
    int fragment = -1;
};
struct LockFragment {
    int fragment = -1;
    bool is_locked = true;
};
struct HideFragment {
    int fragment = -1;
};
/// Shows all hidden fragments.
struct ShowFragments {};
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

using PlanCommand =
    std::variant<PlaceFragment, SettleFragment, JoinFragments, SplitFragment, LockFragment, HideFragment, ShowFragments,
                 UndoStep, RedoStep, GoToAlternative, DropAlternative, RestoreAlternative>;
static_assert(std::is_trivially_copyable_v<PlanCommand>, "commands pass through rings");

/// A command as a run records it.
struct PlanRecord {
    std::int64_t number = 0;  ///< of the command in the run, from 0: a gap means that one was lost
    PlanCommand command;
};

/// Adds the fields of a command, and not the bytes between them.
void add_to(Hash& hash, const PlanCommand& command) noexcept;

/// A command as numbers, as it passes through the parameters of a node: kind (place in the variant, from 1; 0: none), two
/// places (fragments, or an alternative), a switch (locked; a FitBasis), position, orientation (w x y z), FitNumbers.
/// SI units. Numbers that a kind does not use are 0.
inline constexpr std::size_t plan_command_numbers = 17;
using PlanCommandNumbers = std::array<double, plan_command_numbers>;
PlanCommandNumbers numbers_of(const PlanCommand& command) noexcept;
/// None for numbers that are no command: an unknown kind, places that are not whole or beyond ±1e6. Poses are not checked.
std::optional<PlanCommand> command_of(const PlanCommandNumbers& numbers) noexcept;

}  // namespace tactus::plan
