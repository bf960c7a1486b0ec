// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct JoinVector {
    static constexpr auto about = "A vector of three numbers. SI units.";
    static constexpr UnitRule units = UnitRule::same;

    In<double> x{optional, "first component"};
    In<double> y{optional, "second component"};
    In<double> z{optional, "third component"};
    Out<Vec3> out{"the vector"};

    void process(const Tick&) noexcept { out = Vec3(x, y, z); }
};

TACTUS_NODE(JoinVector, x, y, z, out)

}  // namespace tactus::nodes
