// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct Normalise {
    static constexpr auto about = "Direction and length of a vector.";
    static constexpr UnitRule units = UnitRule::same;

    In<Vec3> in{"the vector"};
    Out<Vec3> direction{"the vector divided by its length; the last direction where the length is 0", "1"};
    Out<double> length{"its length"};

    void prepare(const Setup&) { direction = Vec3(1.0, 0.0, 0.0); }
    void process(const Tick&) noexcept {
        // Hypot neither overflows nor loses small vectors.
        const double l = std::hypot(in->x, in->y, in->z);
        length = l;
        if (l > 0.0 && std::isfinite(l)) direction = in.get() / l;
    }
};

TACTUS_NODE(Normalise, in, direction, length)

}  // namespace tactus::nodes
