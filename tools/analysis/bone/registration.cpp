// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/registration.hpp"

#include "dsp/fit/registration/point_registration.hpp"

namespace tactus::analysis {

namespace {

struct Part {
    std::vector<contact::SurfacePoint> points;
    Vec3 middle{0.0};
    double area = 0.0;
};

Part part_of(const std::vector<contact::SurfacePoint>& moving, const std::vector<std::size_t>& region) {
    Part part;
    for (const std::size_t n : region) {
        part.points.push_back(moving[n]);
        part.middle += moving[n].area * moving[n].position;
        part.area += moving[n].area;
    }
    part.middle /= part.area;
    return part;
}

std::optional<RegisteredRegion> register_region(const std::vector<contact::SurfacePoint>& moving,
                                                const fit::Registration& bulk, const fit::RegistrationTarget& target,
                                                const RegisterSettings& settings) {
    auto region = fit::displaced_region(moving, bulk.pose, target, settings.away, settings.gap, settings.margin);
    if (region.empty()) return std::nullopt;
    RegisteredRegion found;
    Part part = part_of(moving, region);
    const fit::PointRegistration plain = fit::register_points(part.points, target, bulk.pose);
    found.plain_away = motion_between(bulk.pose, plain.pose, part.middle);
    found.plain_to_points = plain.to_points;
    found.plain_median = plain.to_surface;
    found.registration = fit::register_surface(part.points, target, bulk.pose, {.widest = 8e-3, .finest = 0.8e-3});
    // Points that slid along the surface have a small distance to it. With the known motion of the part, all points
    // that move with it are added.
    for (int round = 0; round < 2; ++round) {
        auto all = fit::region_nearer(moving, bulk.pose, found.registration.pose, target, 0.2 * settings.away,
                                      settings.away, settings.gap);
        if (all.size() < region.size() / 2) break;
        region = std::move(all);
        part = part_of(moving, region);
        found.registration =
            fit::register_surface(part.points, target, found.registration.pose, {.widest = 0.8e-3, .finest = 0.4e-3});
    }
    found.points = region.size();
    found.area = part.area;
    found.away = motion_between(bulk.pose, found.registration.pose, part.middle);
    return found;
}

}  // namespace

RegisteredSurface register_files(const RegisterSettings& settings) {
    const std::vector<contact::SurfacePoint> fixed = points_of_file(settings.fixed);
    const std::vector<contact::SurfacePoint> moving = points_of_file(settings.moving);
    const fit::RegistrationTarget target(fixed);
    RegisteredSurface found;
    if (settings.mirror) {
        const fit::MirrorFit fit = fit::fit_mirror(moving, fixed);
        found.registration = fit.registration;
        found.pose = fit.pose;
        found.plane = fit.plane;
        return found;
    }
    const fit::RegistrationSettings whole{.by_parts = settings.region};
    const Pose in_files;
    found.judged = fit::search_registration(moving, fixed, target, settings.anywhere ? nullptr : &in_files, whole);
    found.registration = found.judged->best;
    found.pose = found.registration.pose;
    if (settings.region) found.region = register_region(moving, found.registration, target, settings);
    return found;
}

}  // namespace tactus::analysis
