// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/path_alignment.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <vector>

namespace tactus::simulate {

namespace {

constexpr double work_radius = 0.015;  // m around the median position: the hand is at work there

double quantile(std::vector<double> values, double q) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

Vec3 median_position(std::span<const TrajectorySample> samples) {
    Vec3 median(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const TrajectorySample& sample : samples) values.push_back(sample.pose.position[axis]);
        median[axis] = quantile(std::move(values), 0.5);
    }
    return median;
}

}  // namespace

void align_to_rest(std::span<TrajectorySample> samples, const Vec3& feed, double reach) {
    if (samples.empty()) return;
    const Vec3 median = median_position(samples);
    double deep = glm::dot(samples.front().pose.position - median, feed);
    Quat rotation(0.0, 0.0, 0.0, 0.0), first = samples.front().pose.orientation;
    for (const TrajectorySample& sample : samples) {
        const Vec3 off = sample.pose.position - median;
        const double depth = glm::dot(off, feed);
        deep = std::max(deep, depth);
        if (glm::length(off - feed * depth) > work_radius) continue;
        const Quat& q = sample.pose.orientation;
        // q and −q are the same rotation: add them with equal sign.
        rotation = rotation + q * (glm::dot(q, first) < 0.0 ? -1.0 : 1.0);
    }
    const double length = glm::length(rotation);
    const Quat back = length > 1e-9 ? glm::conjugate(rotation / length) : Quat(1.0, 0.0, 0.0, 0.0);
    for (TrajectorySample& sample : samples) {
        sample.pose.position += feed * (reach - deep) - median;
        sample.pose.orientation = sample.pose.orientation * back;
    }
}

}  // namespace tactus::simulate
