// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/target_deviation.hpp"

#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_files.hpp"
#include "dsp/core/constants.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <fmt/format.h>

namespace tactus::analysis {

using reconstruction::SegmentDeviation;

namespace {

/// A target is a mesh, a bone file or a scan, as for 'plan mirror'.
geometry::TriangleSurface target_surface(const std::filesystem::path& file) {
    return is_mesh(file) ? surface_of_file(file, {}) : mesh::export_surface(bone_of_file(file).distance);
}

}  // namespace

std::vector<NamedDeviation> deviation_from_target(const plan::CasePlan& plan, const std::filesystem::path& folder) {
    const plan::PlanState state = plan::state_of(plan);
    if (!state.reconstruction || !state.mirror || !plan::changed_files(plan, folder).empty()) return {};
    const FlapStudy study(plan, state, folder);
    const reconstruction::DeviationTarget target(
        laid_surface(*state.mirror, target_surface(plan::file_of(state.mirror->file, folder))));
    std::vector<NamedDeviation> all;
    for (SegmentDeviation& one : reconstruction::deviation_of(study.inputs(), study.placed_plan(), target))
        all.push_back({fmt::format("segment-{}", all.size() + 1), std::move(one)});
    return all;
}

std::string deviation_words(const NamedDeviation& one) {
    const auto& [curve, contour] = one.deviation;
    std::string text = one.segment + ": ";
    text += curve ? fmt::format("curve {:.1f} mm rms from the target's, {:.1f} mm at most", curve->rms / mm,
                                curve->greatest / mm)
                  : "the target does not reach along it";
    if (contour)
        text += fmt::format("; contour {:.1f} mm rms, {:+.1f} to {:+.1f} mm beyond the target's", contour->rms / mm,
                            contour->lowest / mm, contour->highest / mm);
    return text;
}

}  // namespace tactus::analysis
