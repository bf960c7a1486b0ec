// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/line_branch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::vessel {

Branch branch_of_line(std::span<const Vec3> points, double radius) {
    Branch branch;
    branch.start = branch.end = End::length;
    std::vector<Node>& nodes = branch.nodes;
    for (const Vec3& p : points) {
        const double way = nodes.empty() ? 0.0 : glm::length(p - nodes.back().position);
        if (!nodes.empty() && way < 1e-7) continue;
        Node node;
        node.position = p;
        node.radius = radius;
        node.along = nodes.empty() ? 0.0 : nodes.back().along + way;
        nodes.push_back(node);
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Vec3 way = nodes[std::min(n + 1, nodes.size() - 1)].position - nodes[n > 0 ? n - 1 : 0].position;
        nodes[n].direction = glm::length(way) > 0.0 ? glm::normalize(way) : Vec3(0.0, 0.0, 1.0);
    }
    return branch;
}

}  // namespace tactus::vessel
