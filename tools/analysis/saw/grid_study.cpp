// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/saw/grid_study.hpp"

#include "assets/bone/air_around.hpp"
#include "tools/analysis/saw/bone_trial.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

const Vec3 half(10e-3, 6e-3, 30e-3);  // m

}  // namespace

bone::Bone box_of_voxels(double voxel) {
    bone::Bone bone;
    bone.name = "box";
    volume::Grid& grid = bone.distance;
    grid.spacing = Vec3(voxel);
    // Air for the tools around, and no face on a layer of samples.
    const int layers = static_cast<int>(std::ceil(bone::air_around / voxel)) + 4;
    grid.origin = -half - (Vec3(layers) + Vec3(0.37, 0.21, 0.43)) * voxel;
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(2.0 * half[axis] / voxel) + 2 * layers + 2;
    grid.values.resize(grid.count());
    bone.density = grid;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 q = glm::abs(grid.position(i, j, k)) - half;
                const double d = glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
                grid.at(i, j, k) = static_cast<float>(d);
                bone.density.at(i, j, k) = d > 0.0 ? 0.0f : 1800.0f;
            }
    return bone;
}

std::vector<GridStudyRow> run_grid_study(std::span<const double> voxels, double thrust, double seconds) {
    const volume::SawSite site{.point = {0.0, -half.y, 0.0},
                               .feed = {0.0, 1.0, 0.0},
                               .stroke = {1.0, 0.0, 0.0},
                               .thickness = 2.0 * half.y,
                               .width = 2.0 * half.x};
    std::vector<GridStudyRow> rows;
    for (const double voxel : voxels) {
        const double thrusts[] = {thrust};
        const BoneTrial trial = run_bone_trial_at(site, box_of_voxels(voxel), thrusts, seconds);
        const BoneTrialRow& row = trial.rows.front();
        rows.push_back({voxel, trial.voxel, row.removal * row.seconds, row.feed});
    }
    return rows;
}

}  // namespace tactus::analysis
