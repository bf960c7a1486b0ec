// SPDX-License-Identifier: Apache-2.0
// The field after long cuts, against the exact distance to the same kerf.
#include "tests/dsp/carve/saw.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

/// |∇d| of the trilinear interpolant at points that lie near the cut, ascending.
std::vector<double> gradients(const volume::Grid& grid, const volume::Grid& exact, double deepest) {
    std::vector<double> found;
    for (int k = 2; k < grid.size[2] - 2; ++k) {
        for (int j = 2; j < grid.size[1] - 2; ++j) {
            for (int i = 2; i < grid.size[0] - 2; ++i) {
                const Vec3 p = grid.position(i, j, k) + Vec3(0.37, 0.21, 0.61) * voxel;
                if (std::abs(p.x) > 0.003 || std::abs(p.z) > 0.003 || p.y > 0.0005 || p.y < -deepest - 0.002) continue;
                if (std::abs(trilinear(exact, p)) > 2.0 * voxel) continue;
                Vec3 gradient(0.0);
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3 step(0.0);
                    step[axis] = 1e-6;
                    gradient[axis] = (trilinear(grid, p + step) - trilinear(grid, p - step)) / 2e-6;
                }
                found.push_back(glm::length(gradient));
            }
        }
    }
    std::ranges::sort(found);
    return found;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

void compare(const DenseField& field, const volume::Grid& exact, double deepest, double tolerance) {
    const auto carved = gradients(field.grid, exact, deepest), right = gradients(exact, exact, deepest);
    REQUIRE(carved.size() > 1000);
    const std::size_t p95 = carved.size() * 95 / 100;
    CHECK(carved[p95] <= right[p95] + 0.02);
    CHECK(carved.back() <= std::max(right.back(), 1.02) + 0.01);
    CHECK(mean(carved) == Approx(mean(right)).margin(0.01));
    double worst = 0.0;
    for (int k = 0; k < exact.size[2]; ++k) {
        for (int j = 0; j < exact.size[1]; ++j) {
            for (int i = 0; i < exact.size[0]; ++i) {
                const Vec3 p = exact.position(i, j, k);
                const auto d = static_cast<double>(exact.at(i, j, k));
                if (std::abs(p.x) > 0.003 || std::abs(d) > 2.0 * voxel) continue;
                worst = std::max(worst, std::abs(d - static_cast<double>(field.grid.at(i, j, k))));
            }
        }
    }
    CHECK(worst < tolerance);
}

}  // namespace

TEST_CASE("a straight cut leaves the exact distance to its kerf") {
    for (const double density : {200.0, 600.0, 1800.0}) {
        DenseField field = block(Vec3(0.0), density);
        carve::CarveCore carver({}, Vec3(voxel));
        carve_through(carver, field, stroke({0, 0.0006, 0}, {0, -0.010, 0}, density > 1000.0 ? 6.0 : 1.0));
        const double deepest = depth(carver);
        const volume::Grid& g = field.grid;
        const volume::Grid exact =
            sampled(g.origin, g.position(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1) - 0.1 * voxel, g.spacing,
                    [deepest](const Vec3& p) {
                        const double kerf = 0.0005 - std::hypot(std::max(-deepest - p.y, 0.0), p.z);
                        return std::max(box_distance(p, block_low, block_high), kerf);
                    });
        compare(field, exact, deepest, 2e-6);
    }
}

TEST_CASE("a cut by an unsteady hand leaves the exact distance to the kerf it made") {
    DenseField field = block(Vec3(0.0), 600.0);
    carve::CarveCore carver({}, Vec3(voxel));
    std::vector<std::vector<carve::EdgeNode>> edges;
    std::vector<carve::CarveSample> samples;
    for (int update = 0; update < 60; ++update) {
        samples.clear();
        for (int n = 0; n < 17; ++n) {
            const double t = 0.001 * (17 * update + n);
            const Vec3 at(0.002 * std::sin(5.0 * t), 0.0006 - 0.003 * t, 0.0002 * std::sin(7.0 * t));
            const Quat turn = glm::angleAxis(0.03 * std::sin(3.0 * t), Vec3(0, 0, 1)) *
                              glm::angleAxis(0.02 * std::sin(4.0 * t), Vec3(1, 0, 0));
            samples.push_back({Pose{at, turn * downwards}, 0.001, 7.0, 228.0, true});
        }
        carver.update(field, samples);
        const auto nodes = carver.edge().nodes();
        edges.emplace_back(nodes.begin(), nodes.end());
    }
    // The swept edge as many short ways of points along it.
    const auto swept = [&](const Vec3& p) {
        double nearest = 1.0;
        for (std::size_t e = 1; e < edges.size(); ++e) {
            for (std::size_t n = 0; n + 1 < edges[e].size(); ++n) {
                if (std::abs(edges[e][n].at.x - p.x) > 0.002) continue;
                for (double u = 0.0; u < 1.0; u += 0.125) {
                    const Vec3 from = glm::mix(edges[e - 1][n].at, edges[e - 1][n + 1].at, u);
                    const Vec3 way = glm::mix(edges[e][n].at, edges[e][n + 1].at, u) - from;
                    const double length = glm::dot(way, way);
                    const double t = length > 0.0 ? std::clamp(glm::dot(p - from, way) / length, 0.0, 1.0) : 0.0;
                    const Vec3 off = from + way * t - p;
                    nearest = std::min(nearest, glm::dot(off, off));
                }
            }
        }
        return std::sqrt(nearest);
    };
    const volume::Grid& g = field.grid;
    const volume::Grid exact = sampled(g.origin, g.position(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1) - 0.1 * voxel,
                                       g.spacing, [&](const Vec3& p) {
                                           const double uncut = box_distance(p, block_low, block_high);
                                           if (std::abs(p.x) > 0.004 || std::abs(p.z) > 0.003 || p.y < -0.006)
                                               return uncut;
                                           return std::max(uncut, 0.0005 - swept(p));
                                       });
    compare(field, exact, depth(carver), 3e-5);
}
