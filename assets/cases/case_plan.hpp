// SPDX-License-Identifier: Apache-2.0
// The plan of a case: which fragments there are, and every step that was done with them. Nothing is ever thrown away:
// undo goes back along the steps, a new step after it begins a branch, and named alternatives stand at any of them.
#pragma once

#include "dsp/fit/arrangement.hpp"
#include "dsp/fit/history.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::cases {

/// A bone file or closed mesh; "FILE.vdb#NAME" for one of several bones.
struct PlanFragment {
    std::string name, file;  ///< the file as the plan has it: relative to the plan's folder, or absolute
    std::uint64_t hash = 0;  ///< of the file's bytes
    Vec3 colour{0.90, 0.86, 0.76};
};

/// The healthy side, mirrored and laid on the case: where fragments belong as far as the body is symmetric.
struct MirrorTarget {
    std::string file;
    std::uint64_t hash = 0;
    Vec3 plane_normal{1.0, 0.0, 0.0};  ///< unit, of the mirror in the file's frame
    double plane_offset = 0.0;  ///< m: the mirror is n·x = offset
    Pose pose;  ///< of the mirrored side in the frame of the case
    double residual = 0.0;  ///< m, median distance of what was registered
};

/// What was said of a fit that a step placed.
struct PlanFit {
    std::string partner, verdict;
    double score = 0.0, margin = 0.0;
    double rms = 0.0, gap = 0.0, penetration = 0.0;  ///< m
    double overlap = 0.0;  ///< m²
};

enum class StepKind : std::uint8_t { place, group, add, remove, ungroup, lock, unlock, hide, show, mirror };
std::string_view name_of(StepKind kind);

/// Numbers of fragments are their places in the list.
struct PlanStep {
    int before = -1;  ///< the step that it follows
    StepKind kind = StepKind::place;
    std::string by;  ///< "hand", "snap", "settle", "command"
    std::string time;  ///< as ISO 8601, UTC, or "" when it has none
    std::optional<double> run_second;  ///< within the run that made it, s
    std::vector<int> fragments;  ///< of place: those that moved; else those meant
    std::vector<Pose> poses;  ///< of place: one each; p_case = R p_file + t
    std::string group;  ///< name of the group that is meant
    std::optional<PlanFit> fit;
    std::optional<MirrorTarget> mirror;
};

/// A way through the steps with a name.
struct PlanAlternative {
    std::string name;
    fit::HistoryPlace place;
};

struct CasePlan {
    std::string title;
    std::vector<PlanFragment> fragments;
    std::vector<PlanStep> steps;
    std::vector<PlanAlternative> alternatives{{"main", {}}};
    int current = 0;  ///< alternative

    /// The step before each step, for the functions of dsp/fit/history.hpp.
    std::vector<int> before() const;
    const fit::HistoryPlace& place() const { return alternatives[static_cast<std::size_t>(current)].place; }
    fit::HistoryPlace& place() { return alternatives[static_cast<std::size_t>(current)].place; }
};

/// What the steps of a way come to.
struct PlanState {
    fit::Arrangement arrangement;
    std::vector<std::string> group_names;  ///< per group of the arrangement, "" where there is none
    std::vector<std::optional<PlanFit>> fits;  ///< per fragment: of the step that placed it last
    std::optional<MirrorTarget> mirror;

    /// Number of the group of that name, or Arrangement::none.
    int find_group(std::string_view name) const;
};
/// After the step `head` (-1: as scanned) or at the current alternative's head. Poses are those of the steps, bit by
/// bit.
PlanState state_of(const CasePlan& plan, int head);
PlanState state_of(const CasePlan& plan);

/// Whether a step means something where it is to be applied; throws Error saying what is wrong. `state` is then
/// changed.
void apply(const CasePlan& plan, const PlanStep& step, PlanState& state);

/// Calls visit(number, from, to) once for every step, on whichever way it lies, with the states it leads between; the
/// step before it comes earlier. Throws Error for the first step that cannot be applied.
void visit_steps(const CasePlan& plan, const std::function<void(int, const PlanState&, const PlanState&)>& visit);

/// Checks a step, adds it after the current head and moves the head there. Throws Error and leaves the plan as it was.
void add_step(CasePlan& plan, PlanStep step);
/// The same with the state at the head, which is changed along: many steps cost no more than each of them.
void add_step(CasePlan& plan, PlanState& state, PlanStep step);

/// "group 1", or the next number that no group has.
std::string free_group_name(const PlanState& state);

/// Number of the fragment of that name. Throws Error listing near ones.
int find_fragment(const CasePlan& plan, std::string_view name);

/// A step that places a fragment and all that move with it. Throws Error when something is locked.
PlanStep placing(const CasePlan& plan, int fragment, const Pose& pose, std::string_view by);

/// Adds a fragment, with the hash of its file. `folder` is that of the plan: files below it are named relative to it.
/// Throws Error for a file that is not there and for a name that is taken.
void add_fragment(CasePlan& plan, const std::string& name, const std::filesystem::path& file,
                  const std::filesystem::path& folder, const Vec3& colour);

/// The file of a fragment for reading; `folder` is that of the plan.
std::filesystem::path file_of(const std::string& file, const std::filesystem::path& folder);

/// What is wrong with the fragments' files, one sentence each: missing, or not the bytes that the plan was made with.
std::vector<std::string> changed_files(const CasePlan& plan, const std::filesystem::path& folder);

}  // namespace tactus::cases
