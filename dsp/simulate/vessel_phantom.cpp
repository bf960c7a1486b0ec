// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/vessel_phantom.hpp"
#include "dsp/core/random.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::simulate {

namespace {

/// A normal filter along each axis; borders repeat the last sample.
void blur(volume::Grid& grid, double sigma) {
    const int reach = static_cast<int>(std::ceil(4.0 * sigma));
    std::vector<float> kernel;
    double sum = 0.0;
    for (int n = -reach; n <= reach; ++n) {
        kernel.push_back(static_cast<float>(std::exp(-0.5 * n * n / (sigma * sigma))));
        sum += double(kernel.back());
    }
    for (float& k : kernel) k = static_cast<float>(double(k) / sum);
    const std::size_t strides[3] = {1, static_cast<std::size_t>(grid.size[0]),
                                    static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])};
    std::vector<float> line;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int n = grid.size[axis];
        line.resize(static_cast<std::size_t>(n));
        for (std::size_t start = 0; start < grid.count(); ++start) {
            if (start / strides[axis] % static_cast<std::size_t>(n) != 0) continue;
            for (int i = 0; i < n; ++i)
                line[static_cast<std::size_t>(i)] = grid.values[start + static_cast<std::size_t>(i) * strides[axis]];
            for (int i = 0; i < n; ++i) {
                float value = 0.0f;
                for (int k = -reach; k <= reach; ++k)
                    value += kernel[static_cast<std::size_t>(k + reach)] *
                             line[static_cast<std::size_t>(std::clamp(i + k, 0, n - 1))];
                grid.values[start + static_cast<std::size_t>(i) * strides[axis]] = value;
            }
        }
    }
}

}  // namespace

void add_noise(volume::Grid& grid, double sigma, double correlation, std::uint64_t seed) {
    if (sigma <= 0.0) return;
    const Random random{seed};
    volume::Grid noise = grid;
    for (std::size_t n = 0; n < noise.count(); ++n) noise.values[n] = static_cast<float>(random.normal(n));
    if (correlation > 0.0) {
        blur(noise, correlation);
        double sum = 0.0;
        for (const float value : noise.values) sum += double(value) * double(value);
        const double rms = std::sqrt(sum / double(noise.count()));
        for (float& value : noise.values) value = static_cast<float>(double(value) / rms);
    }
    for (std::size_t n = 0; n < grid.count(); ++n) grid.values[n] += static_cast<float>(sigma) * noise.values[n];
}

VesselPhantom::VesselPhantom(std::array<int, 3> size, double voxel) : layout_{size, Vec3(0.0), Vec3(voxel), {}} {
    fine_.assign(layout_.count() * finer * finer * finer, 0.0f);
}

void VesselPhantom::set(int i, int j, int k, double value) {
    const int w = layout_.size[0] * finer, h = layout_.size[1] * finer, d = layout_.size[2] * finer;
    if (i < 0 || j < 0 || k < 0 || i >= w || j >= h || k >= d) return;
    fine_[(static_cast<std::size_t>(k) * static_cast<std::size_t>(h) + static_cast<std::size_t>(j)) *
              static_cast<std::size_t>(w) +
          static_cast<std::size_t>(i)] = static_cast<float>(value);
}

Vec3 VesselPhantom::fine_position(int i, int j, int k) const {
    return layout_.spacing.x * ((Vec3(i, j, k) + 0.5) / double(finer) - 0.5);
}

void VesselPhantom::add_tube(const std::vector<Vec3>& line, const std::function<double(double)>& radius, double value) {
    const double fine = layout_.spacing.x / finer;
    const Vec3 at_start = glm::normalize(line[1] - line[0]);
    const Vec3 at_end = glm::normalize(line[line.size() - 1] - line[line.size() - 2]);
    for (std::size_t n = 0; n < line.size(); ++n) {
        const double r = radius(double(n) / double(line.size() - 1));
        if (!(r > 0.0)) continue;
        const Vec3 low = (line[n] - r) / fine + double(finer - 1) / 2.0,
                   high = (line[n] + r) / fine + double(finer - 1) / 2.0;
        for (int k = static_cast<int>(low.z); k <= static_cast<int>(high.z) + 1; ++k)
            for (int j = static_cast<int>(low.y); j <= static_cast<int>(high.y) + 1; ++j)
                for (int i = static_cast<int>(low.x); i <= static_cast<int>(high.x) + 1; ++i) {
                    const Vec3 p = fine_position(i, j, k), off = p - line[n];
                    if (glm::dot(off, off) > r * r) continue;
                    const bool near_start = glm::length(p - line.front()) < 2.0 * r;
                    const bool near_end = glm::length(p - line.back()) < 2.0 * r;
                    if (near_start && glm::dot(p - line.front(), at_start) < 0.0) continue;
                    if (near_end && glm::dot(p - line.back(), at_end) > 0.0) continue;
                    set(i, j, k, value);
                }
    }
}

void VesselPhantom::add_lumen(const std::vector<Vec3>& line, const std::function<double(double)>& radius, double value,
                              const std::function<Vec3(double)>& aside) {
    const double fine = layout_.spacing.x / finer;
    std::vector<double> radii;
    std::vector<Vec3> moved;
    double most = 0.0;
    for (std::size_t n = 0; n < line.size(); ++n) {
        const double s = double(n) / double(line.size() - 1);
        radii.push_back(radius(s));
        moved.push_back(aside ? aside(s) : Vec3(0.0));
        most = std::max(most, radii[n] + glm::length(moved[n]));
    }
    struct Nearest {
        float distance = std::numeric_limits<float>::infinity();
        std::uint32_t point = 0;
    };
    std::vector<Nearest> nearest(fine_.size());
    const int w = layout_.size[0] * finer, h = layout_.size[1] * finer, d = layout_.size[2] * finer;
    const auto index = [&](int i, int j, int k) {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(h) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(w) +
               static_cast<std::size_t>(i);
    };
    for (std::size_t n = 0; n < line.size(); ++n) {
        const Vec3 low = (line[n] - most) / fine + double(finer - 1) / 2.0,
                   high = (line[n] + most) / fine + double(finer - 1) / 2.0;
        for (int k = std::max(0, static_cast<int>(low.z)); k <= std::min(d - 1, static_cast<int>(high.z) + 1); ++k)
            for (int j = std::max(0, static_cast<int>(low.y)); j <= std::min(h - 1, static_cast<int>(high.y) + 1); ++j)
                for (int i = std::max(0, static_cast<int>(low.x)); i <= std::min(w - 1, static_cast<int>(high.x) + 1);
                     ++i) {
                    const Vec3 off = fine_position(i, j, k) - line[n];
                    const float distance = static_cast<float>(glm::dot(off, off));
                    Nearest& so_far = nearest[index(i, j, k)];
                    if (distance < so_far.distance) so_far = {distance, static_cast<std::uint32_t>(n)};
                }
    }
    const Vec3 at_start = glm::normalize(line[1] - line[0]);
    const Vec3 at_end = glm::normalize(line[line.size() - 1] - line[line.size() - 2]);
    for (int k = 0; k < d; ++k)
        for (int j = 0; j < h; ++j)
            for (int i = 0; i < w; ++i) {
                const Nearest& found = nearest[index(i, j, k)];
                if (!std::isfinite(found.distance)) continue;
                const double r = radii[found.point];
                const Vec3 p = fine_position(i, j, k), off = p - line[found.point] - moved[found.point];
                if (!(glm::dot(off, off) < r * r)) continue;
                if (found.point == 0 && glm::dot(p - line.front(), at_start) < 0.0) continue;
                if (found.point + 1 == line.size() && glm::dot(p - line.back(), at_end) > 0.0) continue;
                set(i, j, k, value);
            }
}

void VesselPhantom::add_body(const std::function<bool(const Vec3&)>& inside, double value) {
    for (int k = 0; k < layout_.size[2] * finer; ++k)
        for (int j = 0; j < layout_.size[1] * finer; ++j)
            for (int i = 0; i < layout_.size[0] * finer; ++i)
                if (inside(fine_position(i, j, k))) set(i, j, k, value);
}

volume::Grid VesselPhantom::scan(double background, double noise, std::uint64_t seed) const {
    volume::Grid grid = layout_;
    grid.values.assign(grid.count(), 0.0f);
    const std::size_t w = static_cast<std::size_t>(layout_.size[0]) * finer;
    const std::size_t h = static_cast<std::size_t>(layout_.size[1]) * finer;
    for (std::size_t n = 0; n < fine_.size(); ++n)
        if (fine_[n] != 0.0f)
            grid.at(static_cast<int>(n % w / finer), static_cast<int>(n / w % h / finer),
                    static_cast<int>(n / (w * h) / finer)) += fine_[n] / (finer * finer * finer);
    // The mean over a sample blurs by itself, with a variance of 1/12.
    blur(grid, std::sqrt(0.36 - 1.0 / 12.0));
    for (float& value : grid.values) value += static_cast<float>(background);
    add_noise(grid, noise, 0.0, seed);
    return grid;
}

std::vector<Vec3> helix(const Vec3& centre, double radius, double pitch, double turns, double spacing) {
    const double per_turn = std::hypot(2.0 * std::numbers::pi * radius, pitch);
    const int count = static_cast<int>(std::ceil(turns * per_turn / spacing));
    std::vector<Vec3> line;
    for (int n = 0; n <= count; ++n) {
        const double turn = turns * n / count, angle = 2.0 * std::numbers::pi * turn;
        line.push_back(centre + Vec3(radius * std::cos(angle), radius * std::sin(angle), pitch * (turn - 0.5 * turns)));
    }
    return line;
}

std::vector<Vec3> straight(const Vec3& a, const Vec3& b, double spacing) {
    const int count = std::max(1, static_cast<int>(std::ceil(glm::length(b - a) / spacing)));
    std::vector<Vec3> line;
    for (int n = 0; n <= count; ++n) line.push_back(a + (b - a) * (double(n) / count));
    return line;
}

}  // namespace tactus::simulate
