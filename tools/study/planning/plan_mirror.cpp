// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_mirror.hpp"

namespace tactus::study {

namespace {

FacesThere faces_there(const CaseFragment& moving, const Pose& at, const CaseFragment& main, const Pose& stands) {
    return {fit::gap_between(moving.bone.points, at, main.map, stands),
            fit::overlap_volume(moving.bone.distance, at, main.map, stands)};
}

}  // namespace

LaidMirror lay_mirror(const cases::CasePlan& plan, const std::filesystem::path& folder,
                      const std::vector<CaseFragment>& fragments, int main, const std::filesystem::path& healthy) {
    const std::vector<contact::SurfacePoint> points = points_of_file(healthy);
    LaidMirror laid;
    laid.fit = fit::fit_mirror(points, fragments[static_cast<std::size_t>(main)].bone.points);
    cases::CasePlan named;
    cases::add_fragment(named, "healthy", healthy, folder, Vec3(0.0));
    laid.target.file = named.fragments[0].file;
    laid.target.hash = named.fragments[0].hash;
    laid.target.plane_normal = laid.fit.plane.normal;
    laid.target.plane_offset = laid.fit.plane.offset;
    laid.stands = cases::state_of(plan).arrangement.pose(main);
    laid.target.pose = laid.stands * laid.fit.pose;
    laid.target.residual = laid.fit.registration.median;
    laid.surface = fit::mirrored(points, laid.fit.plane, laid.target.pose);
    return laid;
}

MirrorComparison compare_with_mirror(const fit::RegistrationTarget& mirror, const CaseFragment& main,
                                     const Pose& stands, const CaseFragment& other, const Pose& from) {
    fit::RegistrationSettings settings;
    settings.widest = 10e-3;
    const fit::Registration found = fit::register_surface(other.bone.points, mirror, from, settings);
    return {found, motion_between(from, found.pose, middle_of(other.bone.points)),
            faces_there(other, from, main, stands), faces_there(other, found.pose, main, stands)};
}

}  // namespace tactus::study
