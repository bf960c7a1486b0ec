// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/vessel/ridge_tracker.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::bench {

namespace {

volume::Grid smoothed(volume::Grid grid, double scale) {
    const std::size_t strides[3] = {1, static_cast<std::size_t>(grid.size[0]),
                                    static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double sigma = scale / grid.spacing[static_cast<int>(axis)];
        const int reach = static_cast<int>(std::ceil(3.0 * sigma)), n = grid.size[axis];
        std::vector<double> kernel;
        double sum = 0.0;
        for (int k = -reach; k <= reach; ++k)
            kernel.push_back(std::exp(-0.5 * k * k / (sigma * sigma))), sum += kernel.back();
        std::vector<float> line(static_cast<std::size_t>(n));
        for (std::size_t start = 0; start < grid.count(); ++start) {
            if (start / strides[axis] % static_cast<std::size_t>(n) != 0) continue;
            for (int i = 0; i < n; ++i)
                line[static_cast<std::size_t>(i)] = grid.values[start + static_cast<std::size_t>(i) * strides[axis]];
            for (int i = 0; i < n; ++i) {
                double value = 0.0;
                for (int k = -reach; k <= reach; ++k)
                    value += kernel[static_cast<std::size_t>(k + reach)] *
                             double(line[static_cast<std::size_t>(std::clamp(i + k, 0, n - 1))]);
                grid.values[start + static_cast<std::size_t>(i) * strides[axis]] = static_cast<float>(value / sum);
            }
        }
    }
    return grid;
}

class Ridge {
public:
    Ridge(const volume::Grid& grid, double scale)
        : grid_(smoothed(grid, scale)), step_(std::cbrt(grid.spacing.x * grid.spacing.y * grid.spacing.z)) {}

    struct Place {
        Vec3 across_1, across_2, along, slope;
        double first, second;  // curvatures across, the more negative one first
    };

    bool contains(const Vec3& p) const {
        const Vec3 at = (p - grid_.origin) / grid_.spacing;
        for (int a = 0; a < 3; ++a)
            if (!(at[a] >= 2.0 && at[a] <= grid_.size[static_cast<std::size_t>(a)] - 3.0)) return false;
        return true;
    }

    Place at(const Vec3& p) const {
        const double h = step_, centre = value(p);
        Place place;
        std::array<double, 9> hessian;
        Vec3 units[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
        for (int a = 0; a < 3; ++a) {
            const double high = value(p + units[a]), low = value(p - units[a]);
            place.slope[a] = (high - low) / (2.0 * h);
            hessian[static_cast<std::size_t>(4 * a)] = (high - 2.0 * centre + low) / (h * h);
            for (int b = 0; b < a; ++b) {
                const double mixed = (value(p + units[a] + units[b]) - value(p + units[a] - units[b]) -
                                      value(p - units[a] + units[b]) + value(p - units[a] - units[b])) /
                                     (4.0 * h * h);
                hessian[static_cast<std::size_t>(3 * a + b)] = hessian[static_cast<std::size_t>(3 * b + a)] = mixed;
            }
        }
        const auto eigen = geometry::symmetric_eigen<3>(hessian);
        const auto vector = [&](std::size_t n) {
            return Vec3(eigen.vector[n][0], eigen.vector[n][1], eigen.vector[n][2]);
        };
        place.across_1 = vector(0), place.across_2 = vector(1), place.along = vector(2);
        place.first = eigen.value[0], place.second = eigen.value[1];
        return place;
    }

    /// Newton steps across the ridge.
    Vec3 onto_ridge(Vec3 p, double most) const {
        for (int n = 0; n < 10; ++n) {
            const Place place = at(p);
            Vec3 move(0.0);
            if (place.first < 0.0) move -= place.across_1 * (glm::dot(place.slope, place.across_1) / place.first);
            if (place.second < 0.0) move -= place.across_2 * (glm::dot(place.slope, place.across_2) / place.second);
            const double length = glm::length(move);
            if (length > most) move *= most / length;
            p += move;
            if (!contains(p) || length < 0.01 * step_) break;
        }
        return p;
    }

    double step() const { return step_; }

private:
    double value(const Vec3& p) const {
        Vec3 at = (p - grid_.origin) / grid_.spacing;
        int index[3];
        for (int a = 0; a < 3; ++a) {
            at[a] = std::clamp(at[a], 0.0, double(grid_.size[static_cast<std::size_t>(a)]) - 1.001);
            index[a] = static_cast<int>(at[a]);
            at[a] -= index[a];
        }
        double sum = 0.0;
        for (int n = 0; n < 8; ++n)
            sum += double(grid_.at(index[0] + (n & 1), index[1] + (n >> 1 & 1), index[2] + (n >> 2))) *
                   ((n & 1) ? at.x : 1.0 - at.x) * ((n >> 1 & 1) ? at.y : 1.0 - at.y) * ((n >> 2) ? at.z : 1.0 - at.z);
        return sum;
    }

    volume::Grid grid_;
    double step_;
};

}  // namespace

std::vector<Vec3> follow_ridge(const volume::Grid& grid, const Vec3& seed, double scale) {
    const Ridge ridge(grid, scale);
    if (!ridge.contains(seed)) return {};
    const Vec3 start = ridge.onto_ridge(seed, ridge.step());
    if (!ridge.contains(start)) return {};
    const Ridge::Place first = ridge.at(start);
    if (!(first.second < 0.0)) return {};
    std::vector<Vec3> both[2];
    for (int way = 0; way < 2; ++way) {
        Vec3 p = start, direction = way == 0 ? first.along : -first.along;
        for (int n = 0; n < 20000; ++n) {
            p += 0.2 * ridge.step() * direction;
            if (!ridge.contains(p)) break;
            p = ridge.onto_ridge(p, 0.2 * ridge.step());
            if (!ridge.contains(p)) break;
            const Ridge::Place place = ridge.at(p);
            const double curve = std::hypot(place.first, place.second);
            if (!(place.second < 0.0) || place.second / place.first < 0.15 ||
                curve < 0.3 * std::hypot(first.first, first.second))
                break;
            const Vec3 next = glm::dot(place.along, direction) < 0.0 ? -place.along : place.along;
            if (glm::dot(next, direction) < 0.5) break;
            direction = next;
            both[way].push_back(p);
        }
    }
    std::vector<Vec3> line(both[1].rbegin(), both[1].rend());
    line.push_back(start);
    line.insert(line.end(), both[0].begin(), both[0].end());
    return line;
}

}  // namespace tactus::bench
