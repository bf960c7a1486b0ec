// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_cuts.hpp"

#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::analysis {

namespace {

/// Throws Error unless the pieces of the jaw lie where the scan has them: its cuts are planes of the scan.
void check_jaw(const plan::CasePlan& plan, const plan::PlanState& state) {
    for (const int piece : state.pieces) {
        const std::string& name = plan.fragments[static_cast<std::size_t>(piece)].name;
        const Pose& pose = state.arrangement.pose(piece);
        if (is_segment(name) || state.arrangement.is_hidden(piece)) continue;
        if (pose.position != Vec3(0.0) || std::abs(pose.orientation.w) != 1.0)
            throw Error(
                fmt::format("'{}' was moved: the cuts of the jaw are planes of its scan; move it back first", name));
    }
}

}  // namespace

CutsOfPieces cut_as_placed(const std::filesystem::path& path, const std::string& alternative) {
    const std::filesystem::path folder = path.parent_path();
    const plan::CasePlan plan = plan::load_case_plan(path);
    const plan::PlanState state = plan::state_of(plan);
    const FlapStudy study(plan, state, folder);
    check_jaw(plan, state);
    CutsOfPieces found;
    found.before = study.fibula();
    std::vector<Pose> placed;
    for (const FlapStudy::SegmentPlace& segment : study.segments()) {
        found.segments.push_back(plan.fragments[static_cast<std::size_t>(segment.fragment)].name);
        if (!segment.is_placed)
            throw Error(fmt::format("'{}' is still in the leg; place it with 'tactus plan redo' or 'tactus plan move'",
                                    found.segments.back()));
        placed.push_back(segment.pose);
    }
    if (placed.empty()) throw Error("the plan does not have all segments of its reconstruction");
    found.cuts = reconstruction::cuts_of_placed(study.inputs(), study.fibula(), placed);
    const reconstruction::Reconstruction& all = study.reconstruction();
    const auto file_of = [&](const std::optional<reconstruction::MeshFile>& mesh) {
        return mesh ? plan::file_of(mesh->file, folder) : std::filesystem::path();
    };
    found.made = make_reconstruction(
        {found.cuts.inputs, all.flap, file_of(all.donor), file_of(all.jaw), file_of(all.tumour), {}}, path,
        alternative);
    return found;
}

}  // namespace tactus::analysis
