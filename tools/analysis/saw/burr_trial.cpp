// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/saw/burr_trial.hpp"

#include "tools/analysis/saw/saw_trial.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <vector>

namespace tactus::analysis {

BurrTrialResult run_burr_trial(const BurrTrial& trial) {
    constexpr double carve_frequency = 60.0, hand_damping = 300.0, deepest = 30e-3;  // Hz, N·s/m, m
    SawTrial block;
    block.voxel = trial.voxel;
    block.density = trial.density;
    block.width = block.thickness = 4.0 * trial.shape.radius;
    block.depth = deepest;
    const auto bone = saw_block(block);
    carve::Carver carver;
    saw::SawShape edge;
    edge.kerf = 2.0 * trial.shape.radius;
    carver.prepare(*bone, carve_settings_for(edge));
    saw::Burr burr(trial.shape, trial.stiffness);
    const saw::CuttingLaw law;
    const saw::Drive drive{true, trial.turn_rate, 1.0 / trial.tick_rate};
    Pose pose{{0.0, 0.0, trial.shape.radius + 0.1e-3}, glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0))};
    volume::BoneSnapshot read = bone->current();
    std::vector<carve::CutFront> path;
    const auto settle = static_cast<std::int64_t>(trial.settle * trial.tick_rate);
    const auto ticks = settle + static_cast<std::int64_t>(trial.seconds * trial.tick_rate);
    BurrTrialResult result;
    double start = pose.position.z, removed = 0.0, measured = 0.0;
    std::int64_t carved = 0;
    for (std::int64_t n = 0; n < ticks; ++n) {
        if (n == settle) {
            start = burr.at().z;
            removed = carver.removed_m3();
        }
        const saw::BurrContact now = burr.step(read, pose, drive, law);
        if (n >= settle) {
            result.thrust += now.wrench.force.z;
            result.along += now.along;
            result.width += now.width;
            ++measured;
        }
        burr.fill(path.emplace_back(), pose, true);
        if (static_cast<double>(n + 1) * carve_frequency >= static_cast<double>(carved + 1) * trial.tick_rate) {
            ++carved;
            read = bone->publish();
            bone->reclaim(read.version);
            carver.update(*bone, path);
            path.clear();
        }
        if (n >= settle && burr.at().z < -deepest + 3.0 * trial.shape.radius) break;
        pose.position.z -= (trial.thrust - now.wrench.force.z) / hand_damping / trial.tick_rate;
    }
    const double seconds = measured / trial.tick_rate;
    result.feed = (start - burr.at().z) / seconds;
    result.thrust /= measured;
    result.along /= measured;
    result.width /= measured;
    result.removal = (carver.removed_m3() - removed) / seconds;
    return result;
}

}  // namespace tactus::analysis
