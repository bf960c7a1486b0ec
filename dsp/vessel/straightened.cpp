// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/straightened.hpp"
#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::vessel {

Straightened straightened(const volume::Grid& grid, const Branch& branch, double half_width) {
    if (branch.nodes.size() < 2) throw Error("a vessel of one node cannot be pulled straight");
    const Scan scan(grid);
    Straightened out;
    out.spacing = 0.5 * std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
    const int half = std::max(1, static_cast<int>(std::ceil(half_width / out.spacing)));
    out.rows = 2 * half + 1;
    out.columns = std::max(2, static_cast<int>(branch.length() / out.spacing));
    const std::size_t count = static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows);
    out.first.resize(count), out.second.resize(count);

    Vec3 side = across(branch.nodes.front().direction).first;
    std::size_t node = 0;
    for (int column = 0; column < out.columns; ++column) {
        const double along = branch.length() * column / (out.columns - 1);
        while (node + 2 < branch.nodes.size() && branch.nodes[node + 1].along < along) ++node;
        const Node &a = branch.nodes[node], &b = branch.nodes[node + 1];
        const double u = std::clamp((along - a.along) / std::max(1e-12, b.along - a.along), 0.0, 1.0);
        const Vec3 centre = a.position + u * (b.position - a.position);
        const Vec3 direction = glm::normalize(a.direction + u * (b.direction - a.direction));
        side -= glm::dot(side, direction) * direction;
        side = glm::length(side) > 1e-6 ? glm::normalize(side) : across(direction).first;
        const Vec3 other = glm::cross(direction, side);
        out.radius.push_back(a.radius + u * (b.radius - a.radius));
        out.is_lost.push_back(u < 0.5 ? a.is_lost : b.is_lost);
        for (int row = 0; row < out.rows; ++row) {
            const double off = (row - half) * out.spacing;
            const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(out.columns) +
                                   static_cast<std::size_t>(column);
            out.first[at] = static_cast<float>(scan.any_value(centre + off * side));
            out.second[at] = static_cast<float>(scan.any_value(centre + off * other));
        }
    }
    return out;
}

}  // namespace tactus::vessel
