// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

namespace tactus::nodes {

struct Cross {
    static constexpr auto about = "Vector product of two vectors.";
    static constexpr UnitRule units = UnitRule::product;

    In<Vec3> a{"the first vector"};
    In<Vec3> b{"the second vector"};
    Out<Vec3> out{"a × b"};

    void process(const Tick&) noexcept { out = glm::cross(a.get(), b.get()); }
};

TACTUS_NODE(Cross, a, b, out)

}  // namespace tactus::nodes
