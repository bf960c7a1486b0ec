// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_export.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/markup/markup.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/transform/transform_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/flap_export.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/analysis/plan/vessel_export.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace tactus::analysis {

namespace {

struct Landmark {
    std::string label;
    Vec3 position;  ///< m
};

/// Landmarks: the centroid of a surface and its extreme points along six directions.
std::vector<Landmark> landmarks_of(const std::vector<contact::SurfacePoint>& points) {
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    std::vector<Landmark> marks{{"middle", middle}};
    constexpr const char* names[] = {"left", "right", "posterior", "anterior", "superior", "inferior"};
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            const auto farthest = std::ranges::max_element(
                points, {}, [&](const contact::SurfacePoint& p) { return sign * p.position[axis]; });
            marks.push_back({names[2 * axis + (sign < 0.0 ? 1 : 0)], farthest->position});
        }
    return marks;
}

/// A point list of Slicer, transformed by `pose`.
std::string markup_of(const std::string& fragment, const std::vector<Landmark>& marks, const Pose& pose) {
    markup::Markup list;
    list.is_locked = true;
    for (const Landmark& mark : marks)
        list.points.push_back({fmt::format("{} {}", fragment, mark.label), pose.apply(mark.position), "",
                               glm::mat3_cast(pose.orientation)});
    return markup::text_of({&list, 1});
}

}  // namespace

ExportedPlan export_plan(const plan::CasePlan& plan, const std::filesystem::path& folder,
                         const std::filesystem::path& out, const std::string& format,
                         const std::string& transform_format) {
    plan::check_files(plan, folder);
    const plan::PlanState state = plan::state_of(plan);
    const std::vector<plan::PlanFragment> fragments = plan::fragments_of(plan, state);
    ExportedPlan exported;
    std::vector<std::string> names;
    std::vector<std::size_t> shown;
    for (std::size_t n = 0; n < fragments.size(); ++n) {
        if (state.arrangement.is_hidden(static_cast<int>(n))) {
            exported.left_out.push_back(fragments[n].name);
            continue;
        }
        names.push_back(file_name_of(fragments[n].name));
        if (std::ranges::count(names, names.back()) > 1)
            throw Error(fmt::format("fragments '{}' and another would both be written to '{}'", fragments[n].name,
                                    names.back()));
        shown.push_back(n);
    }
    if (shown.empty()) throw Error("no fragment is shown; show some with 'tactus plan unhide'");
    std::vector<plan::PlanFragment> of_shown;
    for (const std::size_t n : shown) of_shown.push_back(fragments[n]);
    const std::vector<CaseFragment> loaded = load_each(of_shown, folder);
    run::make_output_folder(out);
    std::vector<ExportedFragment>& written = exported.written;
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const plan::PlanFragment& fragment = fragments[shown[k]];
        const Pose& pose = state.arrangement.pose(static_cast<int>(shown[k]));
        mesh::ColouredSurface surface{surface_of_file(plan::file_of(fragment.file, folder), loaded[k].map.grid),
                                      fragment.colour};
        for (Vec3& v : surface.surface.vertices) v = pose.apply(v);
        const std::vector<std::string> files{names[k] + "." + format, names[k] + "." + transform_format,
                                             names[k] + ".scan.mrk.json", names[k] + ".plan.mrk.json"};
        mesh::write_mesh({&surface, 1}, out / files[0]);
        transform::write_motion(out / files[1], pose);
        const auto marks = landmarks_of(loaded[k].bone.points);
        file::write_whole_file(out / files[2], markup_of(fragment.name, marks, {}));
        file::write_whole_file(out / files[3], markup_of(fragment.name, marks, pose));
        written.push_back({fragment.name, pose, files});
    }
    if (state.reconstruction) {
        FlapStudy study(plan, state, folder);
        written.push_back(
            {"reconstruction",
             {},
             export_flap(study.inputs(), study.fibula(), study.flap(), study.measures(), out, "." + format)});
    }
    if (state.vessels && !state.vessels->empty()) {
        std::vector<std::string> taken;
        for (const ExportedFragment& one : written) taken.insert(taken.end(), one.files.begin(), one.files.end());
        const auto before = static_cast<std::ptrdiff_t>(taken.size());
        for (const reconstruction::FlapVessel& one : *state.vessels)
            export_vessel("vessel-" + one.name, one.points, one.radius, {"." + format, ".vtp", ".mrk.json"}, out,
                          taken);
        written.push_back({"vessels", {}, {taken.begin() + before, taken.end()}});
    }
    return exported;
}

}  // namespace tactus::analysis
