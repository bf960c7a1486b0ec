// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct TransformPoint {
    static constexpr auto about = "A point that is given in the frame of a pose, in the world, or back.";

    In<Vec3> in{"the point", "m"};
    In<Pose> frame{"the pose", "m"};
    Out<Vec3> out{"the same point in the other frame", "m"};
    Choice to{{"world", "local"}, "frame of the output: the world, or that of the pose"};

    void prepare(const Setup&) { is_back_ = to.is("local"); }
    void process(const Tick&) noexcept { out = is_back_ ? frame->inverse().apply(in) : frame->apply(in); }

private:
    bool is_back_ = false;
};

TACTUS_NODE(TransformPoint, in, frame, out, to)

}  // namespace tactus::nodes
