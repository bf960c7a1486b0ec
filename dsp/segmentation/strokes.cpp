// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/strokes.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::segmentation {

namespace {

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - (a + t * along));
}

/// Calls visit(node) for the nodes that a stroke covers, those of several pieces of its line several times, until it
/// returns false.
template <class Visit>
void visit_nodes(const volume::Grid& layout, std::span<const std::int32_t> node_of_voxel, const Stroke& stroke,
                 const Visit& visit) {
    const auto goes_on = [&](int i, int j, int k) {
        const std::int32_t n = node_of_voxel[layout.index(i, j, k)];
        return n < 0 || visit(n);
    };
    for (std::size_t n = 0; n < stroke.points.size(); ++n) {
        const Vec3 &a = stroke.points[n], &b = stroke.points[std::min(n + 1, stroke.points.size() - 1)];
        std::array<int, 3> low{}, high{}, at{};
        bool is_outside = false;
        for (int axis = 0; axis < 3; ++axis) {
            const auto s = static_cast<std::size_t>(axis);
            const double o = layout.origin[axis], h = layout.spacing[axis], last = layout.size[s] - 1;
            // Clamped as numbers: a far point would not fit an int.
            low[s] = static_cast<int>(
                std::clamp(std::ceil((std::min(a[axis], b[axis]) - stroke.radius - o) / h), 0.0, last + 1.0));
            high[s] = static_cast<int>(
                std::clamp(std::floor((std::max(a[axis], b[axis]) + stroke.radius - o) / h), -1.0, last));
            const double here = std::round((a[axis] - o) / h);
            is_outside = is_outside || !(here >= 0.0 && here <= last);
            at[s] = is_outside ? 0 : static_cast<int>(here);
        }
        if (!is_outside && !goes_on(at[0], at[1], at[2])) return;
        for (int k = low[2]; k <= high[2]; ++k)
            for (int j = low[1]; j <= high[1]; ++j)
                for (int i = low[0]; i <= high[0]; ++i)
                    if (distance_to_line(layout.position(i, j, k), a, b) <= stroke.radius && !goes_on(i, j, k)) return;
    }
}

}  // namespace

std::size_t paint(const volume::Grid& layout, std::span<const std::int32_t> node_of_voxel, const Stroke& stroke,
                  std::uint8_t label, std::span<std::uint8_t> seed) {
    std::vector<std::int32_t> covered;
    visit_nodes(layout, node_of_voxel, stroke, [&](std::int32_t n) {
        covered.push_back(n);
        return true;
    });
    std::sort(covered.begin(), covered.end());
    covered.erase(std::unique(covered.begin(), covered.end()), covered.end());
    for (const std::int32_t n : covered) seed[static_cast<std::size_t>(n)] = label;
    return covered.size();
}

bool touches(const volume::Grid& layout, std::span<const std::int32_t> node_of_voxel, const Stroke& stroke) {
    bool is_any = false;
    visit_nodes(layout, node_of_voxel, stroke, [&](std::int32_t) {
        is_any = true;
        return false;
    });
    return is_any;
}

}  // namespace tactus::segmentation
