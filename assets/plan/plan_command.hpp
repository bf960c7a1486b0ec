// SPDX-License-Identifier: Apache-2.0
// Commands that change the arrangement of a plan. A hand, a window and a program give the same ones, and one function
// applies them (plan_history.hpp), so that a run and its plan file cannot disagree.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"

#include <cstdint>
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
/// The same at a fit to its partner; −1: the fit names none.
struct SettleFragment {
    int fragment = -1, partner = -1;
    Pose pose;
    FitNumbers fit;
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

}  // namespace tactus::plan
