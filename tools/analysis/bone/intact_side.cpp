// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/intact_side.hpp"

#include "dsp/contact/sample_surface.hpp"
#include "dsp/fit/registration/mirror.hpp"
#include "dsp/volume/outer_shell.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/kept_points.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/workers.hpp"

namespace tactus::analysis {

namespace {

// To be raised with every change of code that changes these points: import of scans, outer shell, sampling.
constexpr int sampling = 1;

}  // namespace

std::vector<contact::SurfacePoint> laid_target(const plan::MirrorTarget& target, const std::filesystem::path& folder) {
    std::vector<contact::SurfacePoint> points = points_of_file(plan::file_of(target.file, folder));
    if (target.is_mirrored) return fit::mirrored(points, {target.plane_normal, target.plane_offset}, target.pose);
    return fit::moved(std::move(points), target.pose);
}

geometry::TriangleSurface laid_surface(const plan::MirrorTarget& target, geometry::TriangleSurface surface) {
    const fit::MirrorPlane plane{target.plane_normal, target.plane_offset};
    for (Vec3& v : surface.vertices) v = target.pose.apply(target.is_mirrored ? plane.reflect(v) : v);
    // A mirror turns triangles inside out.
    if (target.is_mirrored)
        for (auto& t : surface.triangles) std::swap(t[1], t[2]);
    return surface;
}

std::optional<fit::RegistrationTarget> healthy_side(const plan::PlanState& state, const std::filesystem::path& folder) {
    if (!state.mirror) return std::nullopt;
    return std::optional<fit::RegistrationTarget>(std::in_place, laid_target(*state.mirror, folder));
}

const std::vector<contact::SurfacePoint>& IntactBone::points() {
    // Half the width of the openings that connect marrow to the outside at a threshold for cortex.
    constexpr double closing = 3e-3;
    if (!points_.empty()) return points_;
    if (is_mesh(file_)) return points_ = points_of_file(file_);
    plan::ResultKey key("outer shell of a bone", sampling);
    key.add_file(file_).add("closing", closing);
    points_ = plan::points_of_key(key, note_, [&] {
        return contact::sample_surface(volume::outer_shell(bone_of_file(file_).distance, closing, on_threads()), {});
    });
    return points_;
}

std::vector<double> IntactBone::numbers_on(std::span<const contact::SurfacePoint> main) {
    const fit::MirrorFit laid = mirror_ ? fit::fit_mirror(points(), main) : fit::fit_same_side(points(), main);
    std::vector<double> numbers;
    add_registration(numbers, laid.registration);
    const Vec3 &n = laid.plane.normal, &p = laid.pose.position;
    const Quat& q = laid.pose.orientation;
    numbers.insert(numbers.end(), {n.x, n.y, n.z, laid.plane.offset, p.x, p.y, p.z, q.w, q.x, q.y, q.z});
    return numbers;
}

std::vector<contact::SurfacePoint> IntactBone::laid(NumberReader& numbers) {
    fit::MirrorPlane plane;
    for (double* number : {&plane.normal.x, &plane.normal.y, &plane.normal.z, &plane.offset}) *number = numbers.next();
    const Pose onto = numbers.pose();
    if (mirror_) return fit::mirrored(points(), plane, onto);
    return fit::moved(points(), onto);
}

}  // namespace tactus::analysis
