// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/saw/saw_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace tactus::analysis {

std::unique_ptr<volume::BoneEditor> saw_block(const SawTrial& trial) {
    const Vec3 low(-0.5 * trial.width, -0.5 * trial.thickness, -trial.depth), high(-low.x, -low.y, 0.0);
    volume::Grid grid;
    grid.spacing = Vec3(trial.voxel);
    grid.origin = low - Vec3(0.004);
    const Vec3 size = (high - low + Vec3(0.008)) / trial.voxel;
    grid.size = {static_cast<int>(size.x) + 2, static_cast<int>(size.y) + 2, static_cast<int>(size.z) + 2};
    grid.values.resize(grid.count());
    volume::Grid density = grid;
    std::ranges::fill(density.values, static_cast<float>(trial.density));
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 p = grid.position(i, j, k), q = glm::max(low - p, p - high);
                grid.at(i, j, k) =
                    static_cast<float>(glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0));
            }
    return std::make_unique<volume::BoneEditor>(
        grid, density,
        volume::BoneEditorOptions{.band = 4.0 * trial.voxel + 2e-3, .max_dirty = 900, .max_versions = 3});
}

carve::CarveSettings carve_settings_for(const saw::SawShape& shape) {
    carve::CarveSettings settings;
    settings.kerf = shape.kerf;
    settings.tooth_pitch = shape.pitch;
    settings.stroke = shape.stroke;
    settings.blade_length = (carve::CutFront::max_nodes - 1) * shape.pitch - shape.stroke;
    return settings;
}

SawTrialResult run_saw_trial(const SawTrial& trial) {
    constexpr double carve_rate = 60.0, damping = 300.0;  // Hz, N·s/m of a hand without mass
    const auto bone = saw_block(trial);
    carve::Carver carver;
    carver.prepare(*bone, carve_settings_for(trial.shape));
    saw::SawBlade blade(trial.shape, trial.stiffness);
    const saw::CuttingLaw law;
    const saw::Drive drive{true, trial.blade_rate, 1.0 / trial.tick_rate};
    Pose pose{{0.0, 0.0, 0.3e-3}, glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0))};
    volume::BoneSnapshot read = bone->current();
    std::vector<carve::CutFront> path;
    const auto settle = static_cast<std::int64_t>(trial.settle * trial.tick_rate);
    const auto ticks = settle + static_cast<std::int64_t>(trial.seconds * trial.tick_rate);
    SawTrialResult result;
    double start = 0.0, removed = 0.0, last = 0.0;
    std::int64_t carved = 0;
    for (std::int64_t n = 0; n < ticks; ++n) {
        if (n == settle) {
            start = pose.position.z;
            removed = carver.removed_m3();
            result = {};
        }
        const saw::SawContact now = blade.step(read, pose, drive, law);
        result.thrust += now.thrust;
        result.along += now.along;
        result.teeth += now.teeth;
        carve::CutFront front;
        blade.teeth().fill(front, pose, true);
        path.push_back(front);
        if (static_cast<double>(n + 1) * carve_rate >= static_cast<double>(carved + 1) * trial.tick_rate) {
            ++carved;
            read = bone->publish();
            bone->reclaim(read.version);
            carver.update(*bone, path);
            path.clear();
        }
        last = pose.position.z;
        pose.position.z -= (trial.feed > 0.0 ? trial.feed : (trial.thrust - now.thrust) / damping) / trial.tick_rate;
    }
    const double measured = static_cast<double>(ticks - settle);
    result.feed = (start - last) / trial.seconds;
    result.thrust /= measured;
    result.along /= measured;
    result.teeth /= measured;
    result.removal = (carver.removed_m3() - removed) / trial.seconds;
    return result;
}

}  // namespace tactus::analysis
