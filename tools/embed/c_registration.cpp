// SPDX-License-Identifier: Apache-2.0
// The C function that registers a mesh to another one.
#include "dsp/fit/registration/registration.hpp"
#include "dsp/fit/registration/vertex_points.hpp"
#include "tools/embed/c_errors.hpp"
#include "tools/embed/tactus.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

using namespace tactus;

namespace {

geometry::TriangleSurface surface_of(const tactus_mesh* mesh, const char* what) {
    if (!mesh || !mesh->vertices || !mesh->triangles || mesh->vertex_count == 0 || mesh->triangle_count == 0)
        throw Error(fmt::format("the {} mesh has no vertices or no triangles", what));
    constexpr std::size_t max_count = std::numeric_limits<int>::max();
    if (mesh->vertex_count > max_count || mesh->triangle_count > max_count)
        throw Error(fmt::format("the {} mesh has more than {} vertices or triangles", what, max_count));
    geometry::TriangleSurface surface;
    surface.vertices.reserve(mesh->vertex_count);
    for (std::size_t n = 0; n < mesh->vertex_count; ++n) {
        const double* const v = mesh->vertices + 3 * n;
        surface.vertices.emplace_back(v[0], v[1], v[2]);
        if (!is_finite(surface.vertices.back()))
            throw Error(fmt::format("vertex {} of the {} mesh is not finite", n, what));
    }
    Vec3 low = surface.vertices.front(), high = low;
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const Vec3 size = high - low;
    const double extent = std::max({size.x, size.y, size.z});
    if (!(extent >= 1e-3 && extent <= 5.0))
        throw Error(fmt::format("the {} mesh is {:.3g} m across; vertices are in m, and a mesh is 1 mm to 5 m across",
                                what, extent));
    surface.triangles.reserve(mesh->triangle_count);
    for (std::size_t n = 0; n < mesh->triangle_count; ++n) {
        const std::int32_t* const t = mesh->triangles + 3 * n;
        for (int c = 0; c < 3; ++c)
            if (t[c] < 0 || static_cast<std::size_t>(t[c]) >= mesh->vertex_count)
                throw Error(fmt::format("triangle {} of the {} mesh has the vertex {}; there are {}", n, what, t[c],
                                        mesh->vertex_count));
        surface.triangles.push_back({t[0], t[1], t[2]});
    }
    return surface;
}

std::vector<contact::SurfacePoint> points_of(const tactus_mesh* mesh, const char* what) {
    std::vector<contact::SurfacePoint> points = fit::vertex_points(surface_of(mesh, what));
    if (points.size() < 4) throw Error(fmt::format("the {} mesh has no area", what));
    return points;
}

void put_pose(const Pose& pose, double (&position)[3], double (&orientation)[4]) {
    for (int axis = 0; axis < 3; ++axis) position[axis] = pose.position[axis];
    // Of the two quaternions of a rotation, the one whose w is not negative.
    const Quat q = pose.orientation.w < 0.0 ? -pose.orientation : pose.orientation;
    const double all[4] = {q.w, q.x, q.y, q.z};
    std::copy(std::begin(all), std::end(all), orientation);
}

const char* text_of(fit::RegistrationVerdict verdict) {
    switch (verdict) {
        case fit::RegistrationVerdict::fit: return "fit";
        case fit::RegistrationVerdict::ambiguous: return "ambiguous";
        case fit::RegistrationVerdict::none: break;
    }
    return "none";
}

}  // namespace

extern "C" {

int tactus_register(const tactus_mesh* moving, const tactus_mesh* fixed, int anywhere,
                    tactus_registration* registration, tactus_error* error) {
    return embed::guarded(error, -1, [&] {
        if (!registration) throw Error("there is no room for the registration: NULL was given");
        const std::vector<contact::SurfacePoint> moving_points = points_of(moving, "moving"),
                                                 fixed_points = points_of(fixed, "fixed");
        const fit::RegistrationTarget target(fixed_points);
        const Pose as_given;
        const fit::JudgedRegistration found =
            fit::search_registration(moving_points, fixed_points, target, anywhere != 0 ? nullptr : &as_given);
        tactus_registration made{};
        made.verdict = text_of(found.verdict);
        put_pose(found.best.pose, made.position, made.orientation);
        made.rms = found.score;
        made.median = found.best.median;
        made.p90 = found.best.p90;
        made.covered = found.best.covered;
        made.rival_rms = std::numeric_limits<double>::infinity();
        if (!found.rivals.empty()) {
            made.rival_rms = found.rivals.front().score;
            put_pose(found.rivals.front().pose, made.rival_position, made.rival_orientation);
        }
        *registration = made;
        return 0;
    });
}

}  // extern "C"
