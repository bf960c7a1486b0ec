// SPDX-License-Identifier: Apache-2.0
// Signed distance to the surface of a CT of a ring (13 and 5 mm radius, 0.35 mm voxels, 128^3): this program, OpenVDB's
// meshToLevelSet on marching tetrahedra of the same values, and a 3-4-5 chamfer of the thresholded voxels. Counters: error
// against the exact distance within three voxels of the surface, in voxels.
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/volume/iso_distance.hpp"
#include "tools/analysis/workers.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tactus;
using namespace tactus::analysis;

namespace {

constexpr double voxel = 0.35e-3;
constexpr int size = 128;

double exact(const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 13e-3, p.z) - 5e-3; }

const volume::Grid& ring() {
    static const volume::Grid grid = [] {
        volume::Grid made{{size, size, size}, Vec3(-0.5 * (size - 1) * voxel), Vec3(voxel), {}};
        for (int k = 0; k < size; ++k)
            for (int j = 0; j < size; ++j)
                for (int i = 0; i < size; ++i)
                    made.values.push_back(
                        static_cast<float>(std::clamp(300.0 - 1.5e6 * exact(made.position(i, j, k)), -1000.0, 1600.0)));
        return made;
    }();
    return grid;
}

void report(benchmark::State& state, const volume::Grid& distance) {
    std::vector<double> errors;
    for (int k = 0; k < size; ++k)
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) {
                const double true_distance = exact(distance.position(i, j, k));
                // OpenVDB's band ends at three voxels.
                if (std::abs(true_distance) < 2.5 * voxel)
                    errors.push_back(std::abs(double(distance.at(i, j, k)) - true_distance) / voxel);
            }
    std::sort(errors.begin(), errors.end());
    state.counters["median_voxel"] = errors[errors.size() / 2];
    state.counters["p95_voxel"] = errors[errors.size() * 95 / 100];
    state.counters["worst_voxel"] = errors.back();
}

void distance_by_tactus(benchmark::State& state) {
    const RunJobs run = on_threads(static_cast<int>(state.range(0)));
    volume::Grid distance;
    for (auto _ : state) distance = volume::distance_to_iso(ring(), 300.0f, run);
    report(state, distance);
}
BENCHMARK(distance_by_tactus)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Only the band, where this program fills the whole volume; OpenVDB uses all cores.
void distance_by_openvdb(benchmark::State& state) {
    openvdb::initialize();
    const geometry::TriangleSurface surface = geometry::iso_surface(ring(), 300.0f, true);
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const Vec3& v : surface.vertices) points.emplace_back(float(v.x), float(v.y), float(v.z));
    for (const auto& t : surface.triangles)
        triangles.emplace_back(static_cast<unsigned>(t[0]), static_cast<unsigned>(t[1]), static_cast<unsigned>(t[2]));
    openvdb::Mat4d map = openvdb::Mat4d::identity();
    map.preScale(openvdb::Vec3d(voxel));
    map.setTranslation(openvdb::Vec3d(ring().origin.x));
    const auto transform = openvdb::math::Transform::createLinearTransform(map);
    openvdb::FloatGrid::Ptr level_set;
    for (auto _ : state)
        level_set = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles, 3.0f);
    volume::Grid distance = ring();
    const auto access = level_set->getConstAccessor();
    for (int k = 0; k < size; ++k)
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) distance.at(i, j, k) = access.getValue({i, j, k});
    report(state, distance);
}
BENCHMARK(distance_by_openvdb)->Unit(benchmark::kMillisecond)->UseRealTime();

// Borgefors' weights over two passes, from the voxels of one side to those of the other, half a voxel less on both.
void chamfer(const std::vector<char>& inside, std::vector<int>& steps, bool wanted) {
    const auto at = [](int i, int j, int k) { return static_cast<std::size_t>((k * size + j) * size + i); };
    for (std::size_t n = 0; n < steps.size(); ++n) steps[n] = (inside[n] != 0) == wanted ? 1 << 20 : 0;
    for (const int way : {1, -1})
        for (int kk = 0; kk < size; ++kk)
            for (int jj = 0; jj < size; ++jj)
                for (int ii = 0; ii < size; ++ii) {
                    const int i = way > 0 ? ii : size - 1 - ii, j = way > 0 ? jj : size - 1 - jj,
                              k = way > 0 ? kk : size - 1 - kk;
                    int best = steps[at(i, j, k)];
                    for (int n = 0; n < 13; ++n) {
                        const int x = i + way * (n % 3 - 1), y = j + way * (n / 3 % 3 - 1), z = k + way * (n / 9 - 1);
                        if (x < 0 || y < 0 || z < 0 || x >= size || y >= size || z >= size) continue;
                        const int axes = (n % 3 != 1) + (n / 3 % 3 != 1) + (n / 9 != 1);
                        best = std::min(best, steps[at(x, y, z)] + 2 + axes);
                    }
                    steps[at(i, j, k)] = best;
                }
}

void distance_by_chamfer(benchmark::State& state) {
    std::vector<char> inside;
    for (const float value : ring().values) inside.push_back(value >= 300.0f);
    std::vector<int> in(inside.size()), out(inside.size());
    volume::Grid distance = ring();
    for (auto _ : state) {
        chamfer(inside, in, true);
        chamfer(inside, out, false);
        for (std::size_t n = 0; n < inside.size(); ++n)
            distance.values[n] = static_cast<float>(voxel * (inside[n] ? 0.5 - in[n] / 3.0 : out[n] / 3.0 - 0.5));
    }
    report(state, distance);
}
BENCHMARK(distance_by_chamfer)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
