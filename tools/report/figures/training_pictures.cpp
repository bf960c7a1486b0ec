// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/training_pictures.hpp"

#include "dsp/geometry/iso_surface.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tactus::report {

namespace {

constexpr int width = 640, height = 520;
const Vec3 bone_colour{0.90, 0.86, 0.76}, uncut_colour{0.45, 0.42, 0.38}, spared_colour{0.80, 0.12, 0.10},
    plan_colour{0.10, 0.30, 0.85};

using Colouring = std::function<Vec3(const Vec3&)>;

display::PictureMesh mesh_of(const volume::Grid& distance, const Colouring& colour) {
    const geometry::TriangleSurface surface = geometry::iso_surface(distance, 0.0f, false);
    std::vector<Vec3> normals(surface.vertices.size(), Vec3(0.0));
    display::PictureMesh mesh;
    for (const auto& t : surface.triangles) {
        const auto at = [&](std::size_t n) { return surface.vertices[static_cast<std::size_t>(t[n])]; };
        const Vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        for (const int corner : t) {
            normals[static_cast<std::size_t>(corner)] += normal;
            mesh.triangles.push_back(static_cast<std::uint32_t>(corner));
        }
    }
    for (std::size_t n = 0; n < normals.size(); ++n) {
        const Vec3 c = colour(surface.vertices[n]);
        for (int a = 0; a < 3; ++a) {
            mesh.positions.push_back(static_cast<float>(surface.vertices[n][a]));
            mesh.normals.push_back(static_cast<float>(normals[n][a] * 1e6));
            mesh.colours.push_back(static_cast<float>(c[a]));
        }
    }
    return mesh;
}

/// A bar of square section between two points.
void add_bar(display::PictureMesh& mesh, const Vec3& from, const Vec3& to, const Vec3& side, double thick,
             const Vec3& colour) {
    const Vec3 other = glm::normalize(glm::cross(to - from, side));
    const Vec3 across[4]{side, other, -side, -other};
    for (int n = 0; n < 4; ++n) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
        const Vec3 a = 0.5 * thick * (across[n] + across[(n + 1) % 4]),
                   b = 0.5 * thick * (across[(n + 1) % 4] + across[(n + 2) % 4]);
        for (const Vec3& p : {from + a, from + b, to + b, to + a})
            for (int axis = 0; axis < 3; ++axis) {
                mesh.positions.push_back(static_cast<float>(p[axis]));
                mesh.normals.push_back(static_cast<float>(across[(n + 1) % 4][axis]));
                mesh.colours.push_back(static_cast<float>(colour[axis]));
            }
        for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.triangles.push_back(first + corner);
    }
}

/// Extent of the bone along the stroke within the planned plane, m.
std::pair<double, double> extent_in_plan(const analysis::ScoredRun& run, const training::PlannedCut& cut) {
    const training::CutBone bone{run.before.distance, run.after.distance};
    double low = 0.0, high = 0.0;
    const double step = bone.smallest_spacing(), most = std::min(0.1, cut.half_length);
    for (double s = -most; s <= most; s += step)
        for (double d = 0.0; d <= cut.depth; d += step)
            if (bone.before_at(cut.position(s, d)) < 0.0) {
                low = std::min(low, s);
                high = std::max(high, s);
                break;
            }
    return {low, high};
}

display::PictureMesh outline_of_plan(const analysis::ScoredRun& run, const training::PlannedCut& cut) {
    auto [low, high] = extent_in_plan(run, cut);
    if (!std::isfinite(cut.half_length)) {
        low -= 2e-3;
        high += 2e-3;
    }
    const double top = -3e-3;
    const Vec3 corners[4]{cut.position(low, top), cut.position(high, top), cut.position(high, cut.depth),
                          cut.position(low, cut.depth)};
    display::PictureMesh mesh;
    for (int n = 0; n < 4; ++n) add_bar(mesh, corners[n], corners[(n + 1) % 4], cut.normal, 0.3e-3, plan_colour);
    return mesh;
}

void add_spared(std::vector<display::PictureMesh>& meshes, const analysis::ScoredRun& run) {
    for (const training::SparedStructure& s : run.task.spared)
        meshes.push_back(mesh_of(s.distance, [](const Vec3&) { return spared_colour; }));
}

display::Image view_of(const std::vector<display::PictureMesh>& meshes, const Vec3& direction) {
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    const display::PictureMesh& bone = meshes.front();
    for (std::size_t n = 0; n + 2 < bone.positions.size(); n += 3) {
        const Vec3 p(bone.positions[n], bone.positions[n + 1], bone.positions[n + 2]);
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    if (!(low.x <= high.x)) low = high = Vec3(0.0);
    const Vec3 up = std::abs(direction.z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
    display::View view = display::fit_view(low, high, direction, up, static_cast<double>(width) / height);
    view.eye = view.target + (view.eye - view.target) * 0.95;
    return display::render_picture(meshes, view, width, height);
}

}  // namespace

Vec3 deviation_colour(double distance, double tolerance) {
    const double t = std::clamp(distance / (2.0 * tolerance), -1.0, 1.0);
    return t < 0.0 ? glm::mix(Vec3(0.97), Vec3(0.10, 0.30, 0.85), -t) : glm::mix(Vec3(0.97), Vec3(0.80, 0.10, 0.10), t);
}

display::Image draw_cut_bone(const analysis::ScoredRun& run, std::size_t index) {
    const training::PlannedCut& cut = run.task.cuts[index];
    std::vector<display::PictureMesh> meshes{mesh_of(run.after.distance, [](const Vec3&) { return bone_colour; }),
                                             outline_of_plan(run, cut)};
    add_spared(meshes, run);
    return view_of(meshes, glm::normalize(cut.feed + 0.35 * cut.stroke - 0.6 * cut.normal));
}

display::Image draw_cut_face(const analysis::ScoredRun& run, std::size_t index) {
    const training::PlannedCut& cut = run.task.cuts[index];
    const std::optional<training::CutPlane>& plane = run.planes[index];
    const training::CutBone bone{run.before.distance, run.after.distance};
    const Vec3 point = plane ? plane->point : cut.point, normal = plane ? plane->normal : cut.normal;
    const double h = bone.smallest_spacing(), kerf = run.task.blade.kerf;
    // The half behind the cut, closed by the plane of the cut where bone was left.
    volume::Grid half = run.after.distance;
    std::size_t n = 0;
    for (int k = 0; k < half.size[2]; ++k)
        for (int j = 0; j < half.size[1]; ++j)
            for (int i = 0; i < half.size[0]; ++i, ++n)
                half.values[n] =
                    std::max(half.values[n], static_cast<float>(glm::dot(half.position(i, j, k) - point, normal)));
    std::vector<display::PictureMesh> meshes{mesh_of(half, [&](const Vec3& p) {
        if (bone.before_at(p) > -0.5 * h) return bone_colour;
        if (glm::dot(p - point, normal) > -0.3 * h && bone.after_at(p) < -0.3 * h) return uncut_colour;
        // The wall stands half a kerf beside the middle of the cut.
        return deviation_colour(cut.coordinates(p).z + 0.5 * kerf, cut.tolerance);
    })};
    add_spared(meshes, run);
    return view_of(meshes, glm::normalize(-normal + 0.25 * cut.feed + 0.2 * cut.stroke));
}

display::Figure draw_attempt(const analysis::ScoredRun& run) {
    const training::Task& task = run.task;
    display::Figure figure(920.0, 560.0);
    std::vector<display::FigurePoint> depth, distance, force;
    const std::size_t every = std::max<std::size_t>(1, run.samples.size() / 1500);
    const training::PlannedCut& planned = task.cuts.front();
    double deepest = planned.depth, widest = 2.0 * planned.tolerance, most = task.limits.force.value_or(1.0);
    for (std::size_t n = 0; n < run.samples.size(); ++n) {
        const training::AttemptSample& s = run.samples[n];
        const double pressed = glm::length(s.force);
        most = std::max(most, pressed);
        // All forces, so that no peak is left out; the rest thinned.
        force.push_back({s.time, pressed});
        if (n % every != 0) continue;
        const training::PlannedCut& nearest = task.cuts[training::nearest_cut(task.cuts, s.pose)];
        const training::CutDeviation now = training::deviation_of(nearest, task.blade, s.pose);
        depth.push_back({s.time, now.depth * 1e3});
        deepest = std::max(deepest, now.depth);
        if (now.depth < -2e-3) continue;
        distance.push_back({s.time, now.distance * 1e3});
        widest = std::max(widest, std::abs(now.distance));
    }
    const double end = std::max(1e-3, run.samples.empty() ? 1.0 : run.samples.back().time);
    const Scale time{0.0, end, false};
    const auto panel = [&](int row, Scale up) {
        return Axes{figure, 60.0, 26.0 + 182.0 * row, 840.0, 120.0, time, up};
    };
    const Axes first = panel(0, {-5.0, 1.2e3 * deepest + 1.0, false});
    first.draw("Depth of the teeth along the planned feed", "", "mm");
    first.curve(depth, curve_colours[0], 0.0, false);
    first.level(planned.depth * 1e3, curve_colours[1], "depth stop");
    if (task.cuts.size() == 1 && run.severances.front().severed)
        first.level(run.severances.front().exit * 1e3, curve_colours[2], "far side of the bone", true);
    const Axes second = panel(1, {-1.05e3 * widest, 1.05e3 * widest, false});
    second.draw("Distance from the planned plane, from 2 mm above the bone on", "", "mm");
    second.curve(distance, curve_colours[0], 0.0, false);
    second.level(planned.tolerance * 1e3, curve_colours[1], "tolerance");
    second.level(-planned.tolerance * 1e3, curve_colours[1], "");
    const Axes third = panel(2, {0.0, 1.25 * most, false});
    third.draw("Force on the hand", "time, s", "N");
    third.curve(force, curve_colours[0], 0.0, false);
    if (task.limits.force) third.level(*task.limits.force, curve_colours[1], "limit");
    return figure;
}

}  // namespace tactus::report
