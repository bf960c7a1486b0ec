// SPDX-License-Identifier: Apache-2.0
// The C function that registers a mesh to another one.
#include "dsp/fit/registration/registration.hpp"
#include "dsp/fit/registration/vertex_points.hpp"
#include "tools/embed/c_errors.hpp"
#include "tools/embed/c_mesh.hpp"
#include "tools/embed/tactus.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

using namespace tactus;

namespace {

std::vector<contact::SurfacePoint> points_of(const tactus_mesh* mesh, const char* what) {
    std::vector<contact::SurfacePoint> points = fit::vertex_points(embed::surface_of(mesh, what));
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
