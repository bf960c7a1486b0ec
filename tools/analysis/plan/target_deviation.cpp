// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/target_deviation.hpp"

#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/kept_result.hpp"
#include "assets/plan/plan_files.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/constants.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <utility>

namespace tactus::analysis {

using reconstruction::SegmentDeviation;

namespace {

/// A target is a mesh, a bone file or a scan, as for 'plan mirror'.
geometry::TriangleSurface target_surface(const std::filesystem::path& file) {
    return is_mesh(file) ? surface_of_file(file, {}) : mesh::export_surface(bone_of_file(file).distance);
}

// To be raised with every change of code that changes a deviation.
constexpr int deviation_algorithm = 2;
constexpr std::size_t numbers_per_segment = 8;

/// All that a deviation depends on.
plan::ResultKey key_of_deviation(const plan::CasePlan& plan, const plan::PlanState& state,
                                 const std::filesystem::path& folder) {
    plan::ResultKey key("deviation from a target", deviation_algorithm);
    const auto add_pose = [&key](const Pose& pose) {
        for (int axis = 0; axis < 3; ++axis) key.add("position", pose.position[axis]);
        const Quat& q = pose.orientation;
        for (const double part : {q.w, q.x, q.y, q.z}) key.add("turn", part);
    };
    const plan::MirrorTarget& mirror = *state.mirror;
    key.add_file(plan::file_of(mirror.file, folder)).add("mirrored", mirror.is_mirrored ? 1.0 : 0.0);
    for (int axis = 0; axis < 3; ++axis) key.add("normal", mirror.plane_normal[axis]);
    key.add("offset", mirror.plane_offset);
    add_pose(mirror.pose);
    // Its text holds the hashes of its meshes.
    key.add_text("reconstruction", reconstruction::json_of(*state.reconstruction).dump());
    for (std::size_t n = 0; n < plan.fragments.size(); ++n) {
        key.add_text("name", plan.fragments[n].name);
        add_pose(state.arrangement.pose(static_cast<int>(n)));
    }
    return key;
}

std::vector<double> numbers_of(const std::vector<SegmentDeviation>& all) {
    std::vector<double> numbers;
    for (const auto& [curve, contour] : all) {
        const SegmentDeviation::Curve c = curve.value_or(SegmentDeviation::Curve{});
        const SegmentDeviation::Contour o = contour.value_or(SegmentDeviation::Contour{});
        for (const double number :
             {curve ? 1.0 : 0.0, c.rms, c.greatest, contour ? 1.0 : 0.0, o.rms, o.lowest, o.highest, o.share})
            numbers.push_back(number);
    }
    return numbers;
}

SegmentDeviation deviation_in(std::span<const double> numbers) {
    SegmentDeviation one;
    if (numbers[0] != 0.0) one.curve = {numbers[1], numbers[2]};
    if (numbers[3] != 0.0) one.contour = {numbers[4], numbers[5], numbers[6], numbers[7]};
    return one;
}

}  // namespace

std::vector<NamedDeviation> deviation_from_target(const plan::CasePlan& plan, const std::filesystem::path& folder) {
    const plan::PlanState state = plan::state_of(plan);
    if (!state.reconstruction || !state.mirror || !plan::changed_files(plan, folder).empty()) return {};
    std::string ignored;  // a damaged result is computed again
    const std::vector<double> numbers =
        plan::result_of(key_of_deviation(plan, state, folder), std::nullopt, ignored, [&] {
            const FlapStudy study(plan, state, folder);
            const reconstruction::DeviationTarget target(
                laid_surface(*state.mirror, target_surface(plan::file_of(state.mirror->file, folder))));
            return numbers_of(reconstruction::deviation_of(study.inputs(), study.placed_plan(), target));
        });
    std::vector<NamedDeviation> all;
    for (std::size_t n = 0; n + numbers_per_segment <= numbers.size(); n += numbers_per_segment)
        all.push_back({fmt::format("segment-{}", all.size() + 1),
                       deviation_in(std::span(numbers).subspan(n, numbers_per_segment))});
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
