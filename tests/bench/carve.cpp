// SPDX-License-Identifier: Apache-2.0
// Cost of one update of the saw at 60 Hz: a 40 mm blade over its whole length in 46 mm of bone, 0.33 mm voxels.
#include "dsp/carve/carver.hpp"
#include "dsp/carve/redistance.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double voxel = 0.00033;
const Vec3 low{-0.023, -0.012, -0.006}, high{0.023, 0.0, 0.006};

std::unique_ptr<volume::BoneEditor> slab(double density) {
    volume::Grid grid;
    grid.spacing = Vec3(voxel);
    grid.origin = low - Vec3(0.004);
    grid.size = {164, 61, 61};
    grid.values.resize(grid.count());
    volume::Grid rho = grid;
    for (int k = 0; k < grid.size[2]; ++k) {
        for (int j = 0; j < grid.size[1]; ++j) {
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 p = grid.position(i, j, k);
                const Vec3 q = glm::max(low - p, p - high);
                const double d = glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
                grid.at(i, j, k) = static_cast<float>(d);
                rho.at(i, j, k) = static_cast<float>(density);
            }
        }
    }
    return std::make_unique<volume::BoneEditor>(grid, rho, volume::BoneEditorOptions{});
}

/// Arguments: density in kg/m³; inclination of the blade to the surface in mrad.
void carve_update(benchmark::State& state) {
    const Quat tilt = glm::angleAxis(1e-3 * static_cast<double>(state.range(1)), Vec3(0, 0, 1));
    const Quat orientation = tilt * glm::angleAxis(std::numbers::pi, Vec3(1, 0, 0));
    std::unique_ptr<volume::BoneEditor> bone;
    carve::Carver carver;
    std::vector<carve::CarveSample> samples(17);
    int updates = 0;
    for (auto _ : state) {
        state.PauseTiming();
        if (updates % 120 == 0) {  // 2 s of sawing, then another bone
            bone = slab(static_cast<double>(state.range(0)));
            carver.prepare(*bone, {});
        }
        for (std::size_t n = 0; n < samples.size(); ++n) {
            const double time = 0.001 * (17.0 * (updates % 120) + static_cast<double>(n));
            samples[n] = {Pose{Vec3(0, 0.0001 - 0.003 * time, 0), orientation}, 0.001, 7.0, 228.0, true};
        }
        ++updates;
        state.ResumeTiming();
        benchmark::DoNotOptimize(carver.update(*bone, samples));
        state.PauseTiming();
        bone->reclaim(bone->publish().version);
        state.ResumeTiming();
    }
}
/// What re-distancing would add: four bricks with a field twice too steep.
void redistance_four_bricks(benchmark::State& state) {
    const auto bone = slab(1800.0);
    const volume::BrickLayout& layout = bone->layout();
    carve::Redistance redistance;
    redistance.prepare(*bone, 0.003);
    const std::vector<std::uint32_t> bricks{1, 2, 3, 4};
    for (auto _ : state) {
        state.PauseTiming();
        for (int k = 0; k <= volume::brick_cells; ++k) {
            for (int j = 0; j <= volume::brick_cells; ++j) {
                for (int i = volume::brick_cells; i <= 5 * volume::brick_cells; ++i) {
                    bone->set(i, j, k, static_cast<float>(2.0 * layout.spacing.z * (k - 3.5)));
                }
            }
        }
        redistance.prepare(*bone, 0.003);
        redistance.add(bricks);
        state.ResumeTiming();
        benchmark::DoNotOptimize(redistance.tick(*bone, 4));
    }
}
BENCHMARK(redistance_four_bricks)->Iterations(200)->Unit(benchmark::kMicrosecond);

BENCHMARK(carve_update)
    ->ArgNames({"density", "mrad"})
    ->Args({1800, 0})
    ->Args({1800, 100})
    ->Args({600, 0})
    ->Args({600, 100})
    ->Iterations(240)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
