// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct SplitVector {
    static constexpr auto about = "The three components of a vector. SI units.";
    static constexpr UnitRule units = UnitRule::same;

    In<Vec3> in{"the vector"};
    Out<double> x{"first component"};
    Out<double> y{"second component"};
    Out<double> z{"third component"};

    void process(const Tick&) noexcept {
        x = in->x;
        y = in->y;
        z = in->z;
    }
};

TACTUS_NODE(SplitVector, in, x, y, z)

}  // namespace tactus::nodes
