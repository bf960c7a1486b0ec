// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/saw/bone_trial.hpp"

#include "dsp/carve/kerf_voxels.hpp"
#include "dsp/core/error.hpp"
#include "dsp/saw/saw_blade.hpp"
#include "tools/analysis/saw/saw_trial.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>

namespace tactus::analysis {

namespace {

constexpr double tick_rate = 1000.0, carve_rate = 60.0;  // Hz
constexpr double damping = 300.0;  // N·s/m of a hand without mass
constexpr double settle = 0.5, wait = 10.0;  // s

BoneTrialRow cut(volume::BoneEditor& bone, const volume::SawSite& site, double thrust, const saw::SawShape& shape,
                 double stiffness, double measured) {
    carve::Carver carver;
    carver.prepare(bone, carve_settings_for(shape));
    saw::SawBlade blade(shape, stiffness);
    const Mat3 axes(site.stroke, site.feed, glm::cross(site.stroke, site.feed));
    const Quat stand = glm::normalize(glm::quat_cast(axes));
    volume::BoneSnapshot read = bone.current();
    std::vector<carve::CutFront> path;
    BoneTrialRow row{.thrust = thrust};
    double depth = -1e-3, touched = 0.0, start = 0.0, removed = 0.0;
    std::int64_t carved = 0;
    for (std::int64_t n = 0; static_cast<double>(n) < (wait + measured) * tick_rate && row.seconds < measured; ++n) {
        const Pose pose{site.point + site.feed * depth, stand};
        const saw::SawContact now = blade.step(read, pose, {true, 228.0, 1.0 / tick_rate}, {});
        blade.teeth().fill(path.emplace_back(), pose, true);
        if (static_cast<double>(n + 1) * carve_rate >= static_cast<double>(carved + 1) * tick_rate) {
            ++carved;
            read = bone.publish();
            bone.reclaim(read.version);
            carver.update(bone, path);
            path.clear();
        }
        touched += now.count > 0 ? 1.0 / tick_rate : 0.0;
        if (depth > site.thickness + 1e-3 || (touched > settle && now.count == 0)) break;  // through
        if (touched > settle) {
            if (row.seconds == 0.0) {
                start = depth;
                removed = carver.removed_m3();
            }
            row.seconds += 1.0 / tick_rate;
            row.feed = (depth - start) / row.seconds;
            row.removal = (carver.removed_m3() - removed) / row.seconds;
        }
        depth += std::clamp((thrust - now.thrust) / damping, -0.1, 0.1) / tick_rate;
    }
    return row;
}

}  // namespace

BoneTrial run_bone_trial(const bone::Bone& bone, std::span<const double> thrusts, const saw::SawShape& shape,
                         double stiffness) {
    const auto site = volume::find_saw_site(bone.distance, bone.density);
    if (!site) throw Error(fmt::format("bone '{}' has no site for a saw cut", bone.name));
    return run_bone_trial_at(*site, bone, thrusts, 2.0, shape, stiffness);
}

BoneTrial run_bone_trial_at(const volume::SawSite& site, const bone::Bone& bone, std::span<const double> thrusts,
                            double measured, const saw::SawShape& shape, double stiffness) {
    const Vec3& spacing = bone.distance.spacing;
    const double voxel = std::max({spacing.x, spacing.y, spacing.z});
    BoneTrial trial{site, std::min(voxel, shape.kerf / carve::voxels_per_kerf), {}};
    const volume::SiteVolume fine = volume::refine_at(site, bone.distance, bone.density, trial.voxel, {.travel = 2e-3});
    for (const double thrust : thrusts) {
        volume::BoneEditor editor(fine.distance, fine.density,
                                  {.band = 4.0 * trial.voxel + 2.0 * shape.kerf, .max_dirty = 900, .max_versions = 3});
        trial.rows.push_back(cut(editor, site, thrust, shape, stiffness, measured));
    }
    return trial;
}

}  // namespace tactus::analysis
