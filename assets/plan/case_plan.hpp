// SPDX-License-Identifier: Apache-2.0
// The plan of a case: its fragments and a tree of all steps. Steps are never deleted: undo moves back along the steps,
// a step after an undo starts a branch, and named alternatives point to steps.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"
#include "dsp/fit/arrangement/history.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::reconstruction {
struct FlapVessel;
struct Reconstruction;
}  // namespace tactus::reconstruction

namespace tactus::plan {

/// A fragment: a bone file or closed mesh; "FILE.vdb#NAME" for one of several bones.
struct PlanFragment {
    std::string name, file;  ///< the path in the plan: relative to the plan's folder, or absolute
    std::uint64_t hash = 0;  ///< of the file's bytes
    Vec3 colour{0.90, 0.86, 0.76};
};

/// The target for the fragments of a case: the healthy side, mirrored and registered, assuming a symmetric body; or a bone
/// of the same side, such as that of another person, registered without a mirror.
struct MirrorTarget {
    std::string file;
    std::uint64_t hash = 0;
    bool is_mirrored = true;
    Vec3 plane_normal{1.0, 0.0, 0.0};  ///< unit normal of the mirror plane in the file's frame
    double plane_offset = 0.0;  ///< m: the plane is n·x = offset
    Pose pose;  ///< pose of the target in the frame of the case
    double residual = 0.0;  ///< m, median distance after registration

    const char* words() const { return is_mirrored ? "mirrored healthy side" : "other bone of the same side"; }
};

/// Result of the fit that a step applied.
struct PlanFit {
    std::string partner, verdict;
    double score = 0.0, margin = 0.0;
    double rms = 0.0, gap = 0.0, penetration = 0.0;  ///< m
    double overlap = 0.0;  ///< m²
};

enum class StepKind : std::uint8_t {
    place,
    group,
    add,
    remove,
    ungroup,
    lock,
    unlock,
    hide,
    show,
    mirror,
    reconstruct,
    repaint,
    vessels
};
std::string_view name_of(StepKind kind);

/// A file with the hash of its bytes.
struct HashedFile {
    std::string file;  ///< as in PlanFragment
    std::uint64_t hash = 0;
};

/// A step. Fragments are referred to by their index in the plan.
struct PlanStep {
    int before = -1;  ///< the previous step
    StepKind kind = StepKind::place;
    std::string by;  ///< "hand", "snap", "settle", "command"
    std::string time;  ///< ISO 8601, UTC; "" when unknown
    std::optional<double> run_second;  ///< s from the start of the run that made it
    std::vector<int> fragments;  ///< for `place`: the fragments that moved; otherwise the fragments concerned
    std::vector<Pose> poses;  ///< for `place`: one per fragment; p_case = R p_file + t
    std::string group;  ///< name of the group concerned
    std::optional<PlanFit> fit;
    std::optional<MirrorTarget> mirror;
    /// The whole reconstruction of a jaw; `fragments` are its pieces.
    std::shared_ptr<const reconstruction::Reconstruction> reconstruction{};
    std::optional<HashedFile> painted{};  ///< for `repaint`: the file of the fragment from this step on
    /// All vessels of the case from this step on, at their scanned positions.
    std::shared_ptr<const std::vector<reconstruction::FlapVessel>> vessels{};
};

/// A named path through the steps.
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

    /// The previous step of each step, for the functions of dsp/fit/arrangement/history.hpp.
    std::vector<int> before() const;
    const fit::HistoryPlace& place() const { return alternatives[static_cast<std::size_t>(current)].place; }
    fit::HistoryPlace& place() { return alternatives[static_cast<std::size_t>(current)].place; }
};

/// The state after a path of steps.
struct PlanState {
    fit::Arrangement arrangement;
    std::vector<std::string> group_names;  ///< per group of the arrangement, "" for an unnamed one
    std::vector<std::optional<PlanFit>> fits;  ///< per fragment: its last fit, which may be void
    std::optional<MirrorTarget> mirror;
    std::shared_ptr<const reconstruction::Reconstruction> reconstruction{};  ///< the latest one; null: none
    std::vector<int> pieces{};  ///< the fragments of the reconstruction
    std::vector<HashedFile> files{};  ///< per fragment: the plan's, or that of the last `repaint`
    /// The vessels of the case, in the frame of the scan; null: none. A reconstruction has its own vessels.
    std::shared_ptr<const std::vector<reconstruction::FlapVessel>> vessels{};

    /// Number of the group of that name, or Arrangement::none.
    int find_group(std::string_view name) const;
    /// Returns whether the fragment's fit holds: neither it nor its partner has moved from the other since.
    bool holds(int fragment) const { return arrangement.fitted_to(fragment) != fit::Arrangement::none; }
};
/// State after the step `head` (-1: as scanned), or at the head of the current alternative. Poses are bit-identical to
/// those in the steps.
PlanState state_of(const CasePlan& plan, int head);
PlanState state_of(const CasePlan& plan);

/// Applies a step to `state`. The first step `reconstruct` with pieces hides those of all other reconstructions of the
/// plan, which belong to other alternatives. Throws Error if the step is not valid in this state.
void apply(const CasePlan& plan, const PlanStep& step, PlanState& state);

/// Calls visit(number, from, to) for every step of the tree, with the states before and after it; a step comes after
/// its predecessor. Throws Error for the first step that cannot be applied.
void visit_steps(const CasePlan& plan, const std::function<void(int, const PlanState&, const PlanState&)>& visit);

/// Checks a step, appends it to the current head and moves the head. If it throws Error, the plan is unchanged.
void add_step(CasePlan& plan, PlanStep step);
/// The same with the state at the head, which it updates: avoids replaying all earlier steps for each new one.
void add_step(CasePlan& plan, PlanState& state, PlanStep step);

/// "group_1", or the next free number.
std::string free_group_name(const PlanState& state);

/// The fragments with their files in this state, or at the head of the current alternative.
std::vector<PlanFragment> fragments_of(const CasePlan& plan, const PlanState& state);
std::vector<PlanFragment> fragments_of(const CasePlan& plan);

/// Index of a fragment. Throws Error with similar names.
int find_fragment(const CasePlan& plan, std::string_view name);

/// A pose within 100 m of the origin of the scan: beyond, its numbers are wrong.
bool is_near(const Pose& pose) noexcept;

/// Adds a fragment and the hash of its file. `folder` is the plan's folder: paths below it are stored relative. Throws
/// Error for a missing file and for a name in use.
void add_fragment(CasePlan& plan, const std::string& name, const std::filesystem::path& file,
                  const std::filesystem::path& folder, const Vec3& colour);

/// Path of a fragment's file; `folder` is the plan's folder.
std::filesystem::path file_of(const std::string& file, const std::filesystem::path& folder);

/// Paths of all files that the current state of a plan needs.
std::vector<std::filesystem::path> files_of(const CasePlan& plan, const std::filesystem::path& folder);

/// Returns problems of the files at the head of the current alternative, one sentence each: missing, or changed since
/// the plan was made.
std::vector<std::string> changed_files(const CasePlan& plan, const std::filesystem::path& folder);

}  // namespace tactus::plan
