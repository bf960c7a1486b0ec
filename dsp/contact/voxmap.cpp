// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/voxmap.hpp"

#include "dsp/contact/field_sample.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/large_pages.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/volume/interpolation.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace tactus::contact {

namespace {

// Paths of steps to the 26 neighbours are longer than a straight line by at most this factor:
// √(1 + (√2 − 1)² + (√3 − √2)²).
constexpr double lattice_factor = 1.1284;
constexpr std::size_t max_samples = std::size_t(1) << 30;

double steepness_of(const volume::Grid& grid, const RunJobs& run) {
    struct Step {
        int x, y, z;
        double inverse_length;
    };
    std::array<Step, 13> steps;
    std::size_t count = 0;
    for (int z = 0; z <= 1; ++z)
        for (int y = z ? -1 : 0; y <= 1; ++y)
            for (int x = z || y ? -1 : 1; x <= 1; ++x)
                steps[count++] = {x, y, z, 1.0 / glm::length(Vec3(x, y, z) * grid.spacing)};
    // A row of maxima, because a compiler may not reorder a single one.
    constexpr int lanes = 16;
    using Steepest = std::array<std::array<float, lanes>, 13>;
    std::vector<Steepest> of_layer(static_cast<std::size_t>(grid.size[2]), Steepest{});
    run(grid.size[2], [&](int k) {
        Steepest& steepest = of_layer[static_cast<std::size_t>(k)];
        leave_if_stopped();
        for (int j = 0; j < grid.size[1]; ++j)
            for (std::size_t s = 0; s < steps.size(); ++s) {
                const Step& step = steps[s];
                if (j + step.y < 0 || j + step.y >= grid.size[1] || k + step.z >= grid.size[2]) continue;
                const int first = std::max(0, -step.x), end = grid.size[0] - std::max(0, step.x);
                const float* here = &grid.values[grid.index(0, j, k)];
                const float* there = &grid.values[grid.index(0, j + step.y, k + step.z)] + step.x;
                std::array<float, lanes> row = steepest[s];
                int i = first;
                for (; i + lanes <= end; i += lanes)
                    for (int lane = 0; lane < lanes; ++lane) {
                        const float d = std::abs(there[i + lane] - here[i + lane]);
                        row[static_cast<std::size_t>(lane)] = std::max(row[static_cast<std::size_t>(lane)], d);
                    }
                for (; i < end; ++i) row[0] = std::max(row[0], std::abs(there[i] - here[i]));
                steepest[s] = row;
            }
    });
    double most = 0.0;
    for (const Steepest& steepest : of_layer)
        for (std::size_t s = 0; s < steps.size(); ++s)
            most =
                std::max(most, static_cast<double>(*std::ranges::max_element(steepest[s])) * steps[s].inverse_length);
    return most;
}

}  // namespace

Voxmap make_voxmap(volume::Grid distance, const RunJobs& run) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (distance.size[axis] < 2) throw Error("a voxmap needs at least two samples along each axis");
        const double spacing = distance.spacing[static_cast<int>(axis)];
        if (!(spacing > 0.0) || !std::isfinite(spacing)) throw Error("a voxmap's spacing must be positive");
    }
    if (!is_finite(distance.origin)) throw Error("a voxmap's origin must be finite");
    if (distance.count() > max_samples || distance.values.size() != distance.count())
        throw Error(fmt::format("a voxmap of {} x {} x {} samples is too large (2^30 at most) or incomplete",
                                distance.size[0], distance.size[1], distance.size[2]));
    double most = 0.0;
    for (const float d : distance.values) {
        if (!std::isfinite(d)) throw Error("a voxmap's distances must be finite; is the body empty or the grid full?");
        most = std::max(most, static_cast<double>(d));
    }
    Voxmap map;
    const Vec3 extent = Vec3(distance.size[0] - 1, distance.size[1] - 1, distance.size[2] - 1) * distance.spacing;
    map.far = most > 0.0 ? most : glm::length(extent);
    map.steepness = std::max(1.0, lattice_factor * steepness_of(distance, run));
    std::vector<float> values;
    values.reserve(distance.values.size());
    prefer_large_pages(values.data(), values.capacity() * sizeof(float));
    values.assign(distance.values.begin(), distance.values.end());
    distance.values.swap(values);
    map.grid = std::move(distance);
    return map;
}

Voxmap make_voxmap(const volume::BoneSnapshot& bone) {
    volume::Grid grid = volume::to_grid(bone);
    // Bricks extend beyond the band; the field is clamped there, so that it does not jump where none is stored.
    const auto far = static_cast<float>(bone.layout().far);
    for (float& d : grid.values) d = std::min(d, far);
    Voxmap map = make_voxmap(std::move(grid));
    map.far = bone.layout().far;
    return map;
}

volume::Sample sample_field(const volume::Grid& distance, const Vec3& position) noexcept {
    const volume::GridCell cell = volume::find_grid_cell(distance.origin, distance.spacing, distance.size, position);
    if (!cell.inside) return {0.0, Vec3(0.0), false};
    const auto row = static_cast<std::size_t>(distance.size[0]),
               plane = row * static_cast<std::size_t>(distance.size[1]);
    const volume::Interpolated at =
        volume::Trilinear(&distance.values[distance.index(cell.i, cell.j, cell.k)], row, plane)(cell);
    return {at.value, at.slope / distance.spacing, true};
}

volume::Sample smooth_sample_field(const volume::Grid& distance, const Vec3& position) noexcept {
    if (!volume::find_grid_cell(distance.origin, distance.spacing, distance.size, position).inside)
        return {0.0, Vec3(0.0), false};
    const volume::QuadraticSpline spline(distance.origin, distance.spacing, distance.size, position);
    const volume::Interpolated at = spline([&](int i, int j, int k) {
        return static_cast<double>(distance.at(spline.index[0][i], spline.index[1][j], spline.index[2][k]));
    });
    return {at.value, at.slope / distance.spacing, true};
}

volume::Sample Voxmap::sample(const Vec3& position) const noexcept {
    const volume::Sample found = sample_field(grid, position);
    return found.inside ? found : volume::Sample{far, Vec3(0.0), false};
}

volume::Sample Voxmap::smooth_sample(const Vec3& position) const noexcept {
    const volume::Sample found = smooth_sample_field(grid, position);
    return found.inside ? found : volume::Sample{far, Vec3(0.0), false};
}

double Voxmap::min_within(const Vec3& position, double radius) const noexcept {
    if (grid.values.empty()) return far;
    const Vec3 last = grid.origin + Vec3(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1) * grid.spacing;
    const Vec3 nearest = glm::clamp(position, grid.origin, last), away = position - nearest;
    const double outside2 = glm::dot(away, away);
    double radius2 = radius * radius;
    if (outside2 != 0.0) {
        // The comparison treats NaN as far away.
        if (!(outside2 < radius2)) return far;
        // The part of the grid inside a ball about an outside point lies in a smaller ball about the nearest point of
        // the grid.
        radius2 -= outside2;
    }
    // An interpolant is a weighted mean of samples; this is their root mean square distance from the evaluated
    // position.
    const double spread2 = 0.25 * glm::dot(grid.spacing, grid.spacing);
    const double fall = steepness * (std::sqrt(radius2 + spread2) + std::sqrt(spread2));
    // The nearest sample is at most half a cell diagonal away, which is the spread.
    const Vec3 cell = (nearest - grid.origin) / grid.spacing;
    const auto index = [](double x, int size) { return std::min(static_cast<int>(x + 0.5), size - 1); };
    const float value = grid.at(index(cell.x, grid.size[0]), index(cell.y, grid.size[1]), index(cell.z, grid.size[2]));
    return std::min(far, static_cast<double>(value) - fall);
}

volume::Grid chamfer_distance(const volume::Grid& distance) {
    const Vec3& h = distance.spacing;
    const double size = h.x;
    if (!(size > 0.0) || std::abs(h.y - size) > 1e-3 * size || std::abs(h.z - size) > 1e-3 * size)
        throw Error("the 3-4-5 distance needs cubic cells; resample the body first");
    if (distance.values.size() != distance.count()) throw Error("a distance grid is incomplete");
    const auto [nx, ny, nz] = distance.size;
    // Distance in steps to the nearest sample of the other side, for both sides at once.
    std::vector<std::int32_t> steps(distance.count(), 1 << 28);
    const auto inside = [&](std::size_t n) { return distance.values[n] < 0.0f; };
    const auto pass = [&](int direction) {
        for (int c = 0; c < nz; ++c)
            for (int b = 0; b < ny; ++b)
                for (int a = 0; a < nx; ++a) {
                    const int i = direction > 0 ? a : nx - 1 - a, j = direction > 0 ? b : ny - 1 - b,
                              k = direction > 0 ? c : nz - 1 - c;
                    const std::size_t here = distance.index(i, j, k);
                    std::int32_t least = steps[here];
                    for (int dz = -1; dz <= 0; ++dz)
                        for (int dy = -1; dy <= (dz ? 1 : 0); ++dy)
                            for (int dx = -1; dx <= (dz || dy ? 1 : -1); ++dx) {
                                const int x = i + direction * dx, y = j + direction * dy, z = k + direction * dz;
                                if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
                                const std::size_t there = distance.index(x, y, z);
                                const int cost = 2 + std::abs(dx) + std::abs(dy) + std::abs(dz);
                                least = std::min(least, inside(there) != inside(here) ? cost : steps[there] + cost);
                            }
                    steps[here] = least;
                }
    };
    pass(1);
    pass(-1);
    volume::Grid result = distance;
    // The surface lies half a cell from the samples next to it.
    for (std::size_t n = 0; n < steps.size(); ++n) {
        const double d = (static_cast<double>(steps[n]) / 3.0 - 0.5) * size;
        result.values[n] = static_cast<float>(inside(n) ? -d : d);
    }
    return result;
}

}  // namespace tactus::contact
