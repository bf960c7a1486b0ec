// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

namespace tactus::nodes {

struct Dot {
    static constexpr auto about = "Scalar product of two vectors.";
    static constexpr UnitRule units = UnitRule::product;

    In<Vec3> a{"a vector"};
    In<Vec3> b{"a vector"};
    Out<double> out{"a · b"};

    void process(const Tick&) noexcept { out = glm::dot(a.get(), b.get()); }
};

TACTUS_NODE(Dot, a, b, out)

}  // namespace tactus::nodes
