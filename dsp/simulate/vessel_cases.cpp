// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/vessel_cases.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::simulate {

namespace {

constexpr double voxel = 1e-3, fine = 0.1e-3;

std::function<double(double)> constant(double radius) {
    return [radius](double) { return radius; };
}

// Neither along an axis nor through samples.
std::vector<Vec3> oblique(double low, double high) {
    return straight(Vec3(20.2, 17.1, low) * voxel, Vec3(19.1, 22.3, high) * voxel, fine);
}

}  // namespace

VesselCase helix_case(double radius, double noise, std::uint64_t seed) {
    VesselPhantom phantom({48, 48, 64}, voxel);
    VesselCase made{fmt::format("helix, R {} voxels, noise {}", radius, noise), {}, {}, {}, radius * voxel, {}};
    made.lines = {helix(Vec3(23.5, 23.5, 31.5) * voxel, 14 * voxel, 30 * voxel, 1.6, fine)};
    phantom.add_tube(made.lines[0], constant(made.radius), 1.0);
    made.seed = made.lines[0][made.lines[0].size() / 2];
    made.scan = phantom.scan(0.0, noise, seed);
    return made;
}

VesselCase ends_case(double radius, double noise, std::uint64_t seed) {
    VesselPhantom phantom({40, 40, 90}, voxel);
    VesselCase made{fmt::format("ends, R {} voxels, noise {}", radius, noise), {}, {}, {}, radius * voxel, {}};
    made.lines = {oblique(20, 68)};
    phantom.add_tube(made.lines[0], constant(made.radius), 1.0);
    made.seed = made.lines[0][made.lines[0].size() / 2];
    made.scan = phantom.scan(0.0, noise, seed);
    return made;
}

VesselCase branch_case(double radius, double angle_deg, double ratio, std::uint64_t seed) {
    VesselPhantom phantom({90, 56, 90}, voxel);
    VesselCase made{fmt::format("Y, R {} voxels, {} deg, {}", radius, angle_deg, ratio == 1.0 ? "1:1" : "2:1"),
                    {},
                    {},
                    {},
                    radius * voxel,
                    Vec3(45.2, 28.1, 44.0) * voxel};
    const double angle = angle_deg * std::numbers::pi / 180.0;
    const auto direction = [](double a) { return Vec3(std::sin(a), 0.0, std::cos(a)); };
    const bool is_even = ratio == 1.0;
    const Vec3 joint = *made.joint;
    const std::vector<Vec3> trunk = straight(Vec3(45.2, 28.1, 4.0) * voxel, joint, fine);
    const std::vector<Vec3> first = straight(joint, joint + 38 * voxel * direction(is_even ? -0.5 * angle : 0.0), fine);
    const std::vector<Vec3> second =
        straight(joint, joint + 38 * voxel * direction(is_even ? 0.5 * angle : angle), fine);
    phantom.add_tube(trunk, constant(made.radius), 1.0);
    phantom.add_tube(first, constant(is_even ? 0.8 * made.radius : made.radius), 1.0);
    phantom.add_tube(second, constant(is_even ? 0.8 * made.radius : ratio * made.radius), 1.0);
    made.lines = {trunk, first, second};
    made.seed = trunk[trunk.size() / 2];
    made.scan = phantom.scan(0.0, 0.2, seed);
    return made;
}

VesselCase stenosis_case(const TrueStenosis& stenosis, std::uint64_t seed, double noise) {
    constexpr double margin = 20.0, whole = 74.0;  // samples
    std::array<int, 3> size{40, 40, 90};
    std::vector<Vec3> line = oblique(8, 82);
    Vec3 side(1.0, 0.0, 0.0);
    if (const auto& direction = stenosis.direction) {
        const Vec3 start = Vec3(margin) * (1.0 - *direction) + Vec3(8.2, 8.1, 8.0) * *direction;
        for (int axis = 0; axis < 3; ++axis)
            size[static_cast<std::size_t>(axis)] = static_cast<int>(2.0 * start[axis] + whole * (*direction)[axis]) + 1;
        line = straight(start * voxel, (start + whole * *direction) * voxel, fine);
        side = glm::normalize(side - direction->x * *direction);
    }
    VesselPhantom phantom(size, voxel);
    const double radius = stenosis.radius * voxel;
    VesselCase made{
        fmt::format("stenosis {} % over {} R, R {} voxels", stenosis.percent, stenosis.length, stenosis.radius),
        {},
        {},
        {},
        radius,
        {}};
    made.lines = {std::move(line)};
    const double length = glm::length(made.lines[0].back() - made.lines[0].front());
    const auto lost = [&](double s) {  // of the radius
        const double x = std::abs(s - 0.6) * length / (stenosis.length * radius);
        if (x >= 0.5) return 0.0;
        const double inner = stenosis.shape == TrueStenosis::Shape::flat ? 0.25 : 0.0;
        const double y = std::max(0.0, x - inner) / (0.5 - inner);
        return 0.01 * stenosis.percent * 0.5 * (1.0 + std::cos(std::numbers::pi * y));
    };
    phantom.add_lumen(
        made.lines[0], [&](double s) { return radius * (1.0 - lost(s)); }, 1.0,
        [&](double s) { return stenosis.aside * radius * lost(s) * side; });
    made.seed = made.lines[0][made.lines[0].size() / 4];
    made.scan = phantom.scan(0.0, noise, seed);
    return made;
}

VesselCase gap_case(double radius, std::uint64_t seed) {
    VesselPhantom phantom({40, 40, 90}, voxel);
    VesselCase made{fmt::format("gap of 2 R, R {} voxels", radius), {}, {}, {}, radius * voxel, {}};
    made.lines = {oblique(8, 82)};
    const std::vector<Vec3>& line = made.lines[0];
    const double length = glm::length(line.back() - line.front());
    const auto first = static_cast<std::ptrdiff_t>(0.6 * double(line.size()));
    const auto second = first + static_cast<std::ptrdiff_t>(2.0 * made.radius / length * double(line.size()));
    phantom.add_tube({line.begin(), line.begin() + first}, constant(made.radius), 1.0);
    phantom.add_tube({line.begin() + second, line.end()}, constant(made.radius), 1.0);
    made.seed = line[line.size() / 4];
    made.scan = phantom.scan(0.0, 0.2, seed);
    return made;
}

VesselCase bone_case(double radius, std::uint64_t seed) {
    VesselPhantom phantom({40, 40, 110}, voxel);
    VesselCase made{fmt::format("bone wall at 0.5 voxel, R {} voxels", radius), {}, {}, {}, radius * voxel, {}};
    made.lines = {straight(Vec3(20.2, 19.9, 8) * voxel, Vec3(20.2, 19.9, 100) * voxel, fine)};
    const double wall = (20.2 + radius + 0.5) * voxel;
    phantom.add_body(
        [&](const Vec3& p) {
            return p.x > wall && p.x < wall + 6 * voxel && std::abs(p.z - 54 * voxel) < 10.0 * made.radius;
        },
        1000.0);
    phantom.add_tube(made.lines[0], constant(made.radius), 350.0);
    made.seed = made.lines[0][made.lines[0].size() / 12];
    made.scan = phantom.scan(0.0, 70.0, seed);
    return made;
}

volume::Grid noise_case(double correlation, std::uint64_t seed) {
    volume::Grid grid{{48, 48, 48}, Vec3(0.0), Vec3(voxel), {}};
    grid.values.assign(grid.count(), 0.0f);
    add_noise(grid, 30.0, correlation, seed);
    return grid;
}

TrackError compared(const vessel::Track& track, const VesselCase& with) {
    TrackError error;
    const std::vector<Vec3>& first = with.lines.front();
    double squares = 0.0, radii = 0.0;
    std::size_t count = 0, measured = 0;
    std::vector<Vec3> ends;
    for (const auto& line : with.lines)
        for (const Vec3& end : {line.front(), line.back()}) ends.push_back(end);
    const Vec3 before = glm::normalize(first[0] - first[1]),
               after = glm::normalize(first.back() - first[first.size() - 2]);
    for (std::size_t b = 0; b < track.branches.size(); ++b)
        for (const vessel::Node& node : track.branches[b].nodes) {
            if (b == 0 && with.lines.size() == 1) {
                if (glm::length(node.position - first.front()) < 6.0 * with.radius)
                    error.overshoot =
                        std::max(error.overshoot, glm::dot(node.position - first.front(), before) / with.radius);
                if (glm::length(node.position - first.back()) < 6.0 * with.radius)
                    error.overshoot =
                        std::max(error.overshoot, glm::dot(node.position - first.back(), after) / with.radius);
            }
            if (node.is_lost || std::ranges::any_of(ends, [&](const Vec3& end) {
                    return glm::length(node.position - end) < 2.0 * with.radius;
                }))
                continue;
            double least = std::numeric_limits<double>::infinity();
            for (const auto& line : with.lines)
                for (const Vec3& place : line) least = std::min(least, glm::length(node.position - place));
            squares += least * least / (voxel * voxel);
            error.worst = std::max(error.worst, least / voxel);
            ++count;
            if (b == 0) radii += node.radius / voxel, ++measured;
        }
    if (count > 0) error.rms = std::sqrt(squares / double(count));
    if (measured > 0) error.mean_radius = radii / double(measured);
    std::size_t near = 0, all = 0;
    for (const auto& line : with.lines)
        for (std::size_t n = 0; n < line.size(); n += 10) {
            ++all;
            near += std::ranges::any_of(track.branches, [&](const vessel::Branch& branch) {
                return std::ranges::any_of(branch.nodes, [&](const vessel::Node& node) {
                    return glm::length(node.position - line[n]) < 1.5 * with.radius;
                });
            });
        }
    error.covered = double(near) / double(all);
    error.joint = std::numeric_limits<double>::infinity();
    if (with.joint)
        for (const vessel::Branch& branch : track.branches)
            if (branch.parent >= 0)
                error.joint =
                    std::min(error.joint, glm::length(branch.nodes.front().position - *with.joint) / with.radius);
    return error;
}

}  // namespace tactus::simulate
