// SPDX-License-Identifier: Apache-2.0
// Vessels of a plan: those of the scan where they were scanned, those of a flap on the segments that they run along.
#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "assets/vessel/course_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/pedicle.hpp"
#include "dsp/vessel/line_branch.hpp"
#include "dsp/vessel/tube_surface.hpp"
#include "tools/analysis/leaving.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/scene_model.hpp"
#include "tools/render/triangle_patch.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::render {

using namespace scene_colours;

namespace {

Vec3 colour_of(const reconstruction::FlapVessel& vessel) {
    return vessel.kind == reconstruction::VesselKind::vein ? vein_colour : artery_colour;
}

/// Places of the segments in the scene of a plan.
std::vector<int> segments_of(const plan::CasePlan& plan, const plan::PlanState& state) {
    std::vector<int> segments;
    for (const int piece : state.pieces)
        if (analysis::is_segment(plan.fragments[static_cast<std::size_t>(piece)].name)) segments.push_back(piece);
    return segments;
}

void add_tube(VesselTubes::Vessel& to, const std::vector<Vec3>& line, double radius, int place) {
    const geometry::TriangleSurface tube = vessel::tube_surface(vessel::branch_of_line(line, radius));
    if (!tube.triangles.empty())
        to.parts.push_back({triangle_patch(tube, geometry::packed_colour(to.colour, 1.0)), place});
}

/// Those of the scan.
VesselTubes scanned_tubes(const std::vector<reconstruction::FlapVessel>& vessels) {
    VesselTubes tubes;
    for (const reconstruction::FlapVessel& vessel : vessels) {
        tubes.all.push_back({vessel.name, colour_of(vessel), false, {}});
        add_tube(tubes.all.back(), vessel.points, vessel.radius, -1);
    }
    return tubes;
}

/// Whether a vessel runs along the course of a file. One that cannot be read is of no vessel: the run says so.
bool runs_along(const reconstruction::FlapVessel& vessel, const std::filesystem::path& course) {
    constexpr double beside = 1e-3;  // m
    try {
        const std::vector<Vec3> points = vessel::load_course(course).points;
        return std::ranges::all_of(vessel.points, [&](const Vec3& p) {
            for (std::size_t n = 1; n < points.size(); ++n) {
                const Vec3 along = points[n] - points[n - 1], to = p - points[n - 1];
                const double share = std::clamp(glm::dot(to, along) / glm::dot(along, along), 0.0, 1.0);
                if (glm::length(to - share * along) < beside) return true;
            }
            return false;
        });
    } catch (const Error&) {
        return false;
    }
}

/// Those of the flap: the fibula is planned for it, which takes long. `courses`: files of the ropes of the patch.
VesselTubes flap_tubes(const std::filesystem::path& file, const plan::CasePlan& plan,
                       const std::vector<std::filesystem::path>& courses) {
    VesselTubes tubes;
    try {
        const plan::PlanState state = plan::state_of(plan);
        const reconstruction::Reconstruction& made = *state.reconstruction;
        reconstruction::FibulaInputs inputs = made.inputs;
        inputs.donor = reconstruction::read_surface(plan::file_of(made.donor.file, file.parent_path()));
        const reconstruction::FibulaPlan fibula = reconstruction::plan_fibula(inputs);
        const std::vector<int> segments = segments_of(plan, state);
        for (const reconstruction::FlapVessel& vessel : made.flap.vessels) {
            tubes.all.push_back({vessel.name, colour_of(vessel), false, {}});
            tubes.all.back().is_rope =
                std::ranges::any_of(courses, [&](const auto& course) { return runs_along(vessel, course); });
            for (const reconstruction::VesselPart& part : reconstruction::parts_of(vessel, inputs, fibula))
                if (part.kind == reconstruction::VesselPart::Kind::attached && part.segment < segments.size())
                    add_tube(tubes.all.back(), part.points, vessel.radius, segments[part.segment]);
        }
    } catch (const Error& error) {
        tubes.problem = fmt::format("the vessels of the flap are not drawn: {}", error.message());
    }
    return tubes;
}

}  // namespace

void SceneModel::put_vessels(PlanVessels& to, const VesselTubes& tubes) {
    to.problem = tubes.problem;
    for (const VesselTubes::Vessel& vessel : tubes.all) {
        PlanVessel& one = to.all.emplace_back(PlanVessel{vessel.name, vessel.colour, vessel.is_rope, {}});
        for (const VesselTubes::Part& part : vessel.parts) {
            one.parts.push_back({renderer_.meshes().make(), display::bounds_of(part.patch), part.place});
            renderer_.meshes().set_part(one.parts.back().mesh, 0, part.patch);
        }
    }
}

void SceneModel::remove(const PlanVessels& vessels) {
    for (const PlanVessel& vessel : vessels.all)
        for (const MeshOfVessel& part : vessel.parts) renderer_.meshes().remove(part.mesh);
}

void SceneModel::take_vessels(const std::string& name, const std::filesystem::path& file, const plan::CasePlan& plan) {
    const plan::PlanState state = plan::state_of(plan);
    PlanVessels& taken = vessels_[name];
    std::vector<std::filesystem::path> courses;
    for (const SceneOutline::Rope& rope : outline_.ropes)
        if (!rope.course.empty()) courses.emplace_back(rope.course);
    // Most steps of a plan leave its vessels as they are.
    std::string of;
    if (state.reconstruction) {
        of = reconstruction::json_of(*state.reconstruction).dump();
        for (const int piece : state.pieces) of += fmt::format(" {}", piece);
        for (const auto& course : courses) of += " " + course.string();
    } else if (state.vessels)
        for (const reconstruction::FlapVessel& vessel : *state.vessels) {
            of += fmt::format("{} {} {}", vessel.name, static_cast<int>(vessel.kind), vessel.radius);
            for (const Vec3& p : vessel.points) of += fmt::format(" {} {} {}", p.x, p.y, p.z);
        }
    if (of == taken.of) return;
    remove(taken);
    taken = {};
    taken.of = std::move(of);
    if (state.reconstruction)
        taken.making.begin(analysis::Lane::studies,
                           analysis::leaving([file, plan, courses] { return flap_tubes(file, plan, courses); }));
    else if (state.vessels) put_vessels(taken, scanned_tubes(*state.vessels));
}

void SceneModel::use_plan(const std::filesystem::path& file, const plan::CasePlan& plan,
                          std::filesystem::file_time_type written) {
    if (plan_written_ == written) return;
    const auto scene = std::ranges::find_if(outline_.scenes, [](const auto& one) { return !one.plan.empty(); });
    if (scene == outline_.scenes.end()) return;
    plan_written_ = written;
    try {
        use_hardware(plan::state_of(plan).reconstruction, file.parent_path());
        take_vessels(scene->plan, file, plan);
    } catch (const Error&) {
        // The run says what is wrong.
    }
}

void SceneModel::forget_vessels() {
    std::erase_if(vessels_, [&](const auto& known) {
        const bool is_gone =
            std::ranges::find(outline_.scenes, known.first, &SceneOutline::Bodies::plan) == outline_.scenes.end();
        if (is_gone) remove(known.second);
        if (is_gone) named_.erase(known.first);
        return is_gone;
    });
}

void SceneModel::show_vessels() {
    const std::vector<std::optional<Pose>> poses = plan_poses();
    for (auto& [file, vessels] : vessels_) {
        if (vessels.making.is_ready() || (waits_for_files_ && vessels.making.is_busy()))
            put_vessels(vessels, vessels.making.take());
        if (vessels.making.is_busy()) {
            legend_.warnings.push_back("computing the vessels of the flap ...");
            is_waiting_ = true;
        }
        if (!vessels.problem.empty()) legend_.warnings.push_back(vessels.problem);
        for (const PlanVessel& vessel : vessels.all) {
            const auto pose_of_part = [&](const MeshOfVessel& part) {
                const auto place = static_cast<std::size_t>(part.place);
                return part.place < 0 ? Pose{} : place < poses.size() ? poses[place] : std::optional<Pose>{};
            };
            if (vessel.parts.empty() || vessel.is_rope || !is_part_shown(vessel.name, vessel.colour)) continue;
            for (const MeshOfVessel& part : vessel.parts) {
                const std::optional<Pose> pose = pose_of_part(part);
                if (!pose) continue;
                part_of_mesh_.emplace_back(picture_.meshes.size(), vessel.name);
                show(part.mesh, *pose, part.bounds);
            }
            legend_.entries.push_back({vessel.name, vessel.colour});
        }
    }
}

}  // namespace tactus::render
