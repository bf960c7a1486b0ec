// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace tactus::nodes {

struct Angle {
    static constexpr auto about = "Angle between two vectors.";

    In<Vec3> a{"a vector"};
    In<Vec3> b{"a vector"};
    Out<double> out{"between 0 and 180 deg; 0 where a vector has no length", "rad"};

    void process(const Tick&) noexcept {
        // The arc cosine loses small angles.
        const Vec3 normal = glm::cross(a.get(), b.get());
        out = std::atan2(std::hypot(normal.x, normal.y, normal.z), glm::dot(a.get(), b.get()));
    }
};

TACTUS_NODE(Angle, a, b, out)

}  // namespace tactus::nodes
