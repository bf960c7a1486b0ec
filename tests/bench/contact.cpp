// SPDX-License-Identifier: Apache-2.0
// Cost of one contact pass of the blade, and of a sample in bricks beside the same values in one dense array.
#include "dsp/contact/blade.hpp"

#include <benchmark/benchmark.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace tactus;

constexpr double radius = 0.015;

/// A ball of bone in a cube of 128 samples, 0.35 mm apart.
volume::Grid ball() {
    volume::Grid grid{{128, 128, 128}, Vec3(-0.0222), Vec3(0.35e-3), {}};
    grid.values.resize(grid.count());
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                grid.at(i, j, k) = static_cast<float>(glm::length(grid.position(i, j, k)) - radius);
    return grid;
}

const volume::BoneEditor& bone_of() {
    static const volume::BoneEditor editor = [] {
        volume::Grid density = ball();
        std::ranges::fill(density.values, 1800.0f);
        return volume::BoneEditor(ball(), density, {.band = 0.1, .max_dirty = 1, .max_versions = 1});
    }();
    return editor;
}

/// Steps of 0.05 mm around the ball, just under its surface.
Vec3 path(int step) {
    const double angle = step * (0.05e-3 / radius);
    return (radius - 0.2e-3) * Vec3(std::cos(angle), std::sin(angle) * 0.8, std::sin(angle) * 0.6);
}

const std::vector<Vec3>& positions() {
    static const std::vector<Vec3> made = [] {
        std::vector<Vec3> points;
        for (int i = 0; i < 4096; ++i) points.push_back(path(i));
        return points;
    }();
    return made;
}

volume::Sample sample_dense(const volume::Grid& grid, const Vec3& p) {
    const Vec3 at = (p - grid.origin) / grid.spacing;
    const int i = static_cast<int>(at.x), j = static_cast<int>(at.y), k = static_cast<int>(at.z);
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.z >= 0.0) || i > grid.size[0] - 2 || j > grid.size[1] - 2 ||
        k > grid.size[2] - 2)
        return {};
    const double fx = at.x - i, fy = at.y - j, fz = at.z - k;
    const auto c = [&](int x, int y, int z) { return static_cast<double>(grid.at(i + x, j + y, k + z)); };
    const auto mix = [](double a, double b, double t) { return a + (b - a) * t; };
    const double c000 = c(0, 0, 0), c100 = c(1, 0, 0), c010 = c(0, 1, 0), c110 = c(1, 1, 0);
    const double c001 = c(0, 0, 1), c101 = c(1, 0, 1), c011 = c(0, 1, 1), c111 = c(1, 1, 1);
    const double x00 = mix(c000, c100, fx), x10 = mix(c010, c110, fx);
    const double x01 = mix(c001, c101, fx), x11 = mix(c011, c111, fx);
    const double y0 = mix(x00, x10, fy), y1 = mix(x01, x11, fy);
    const double dx = mix(mix(c100 - c000, c110 - c010, fy), mix(c101 - c001, c111 - c011, fy), fz);
    const Vec3 slope(dx, mix(x10 - x00, x11 - x01, fz), y1 - y0);
    return {mix(y0, y1, fz), slope / grid.spacing, true};
}

void sample_in_bricks(benchmark::State& state) {
    const volume::BoneSnapshot snapshot = bone_of().current();
    for (auto _ : state)
        for (const Vec3& p : positions()) benchmark::DoNotOptimize(snapshot.sample(p));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(positions().size()));
}
BENCHMARK(sample_in_bricks);

void sample_in_dense_array(benchmark::State& state) {
    const volume::Grid grid = ball();
    for (auto _ : state)
        for (const Vec3& p : positions()) benchmark::DoNotOptimize(sample_dense(grid, p));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(positions().size()));
}
BENCHMARK(sample_in_dense_array);

void blade_pass(benchmark::State& state) {
    const volume::BoneSnapshot snapshot = bone_of().current();
    const contact::BladePoints blade;
    int step = 0;
    for (auto _ : state) {
        // A stroke of 4 mm along the blade, the teeth 0.5 mm deep.
        const double along = 0.002 * std::sin(0.01 * step++);
        const Pose tool{Vec3(along, 0.5e-3 - radius, 0.0), Quat(1, 0, 0, 0)};
        benchmark::DoNotOptimize(contact::blade_contact(snapshot, blade, tool, tool.position, 3000.0));
    }
}
BENCHMARK(blade_pass);

}  // namespace
