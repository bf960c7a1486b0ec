// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

namespace tactus::nodes {

struct WrenchSum {
    static constexpr auto about =
        "Sum of up to eight wrenches along world axes. A wrench carries no point: where an 'about' is wired, its "
        "torque is "
        "transported from there to the point of the output, torque + (about - point) × force.";

    In<Wrench> in1{optional, "a wrench", "N, N m"};
    In<Pose> about1{optional, "where the torque of in1 refers to; open: the point of the output", "m"};
    In<Wrench> in2{optional, "a wrench", "N, N m"};
    In<Pose> about2{optional, "where the torque of in2 refers to; open: the point of the output", "m"};
    In<Wrench> in3{optional, "a wrench", "N, N m"};
    In<Pose> about3{optional, "where the torque of in3 refers to; open: the point of the output", "m"};
    In<Wrench> in4{optional, "a wrench", "N, N m"};
    In<Pose> about4{optional, "where the torque of in4 refers to; open: the point of the output", "m"};
    In<Wrench> in5{optional, "a wrench", "N, N m"};
    In<Pose> about5{optional, "where the torque of in5 refers to; open: the point of the output", "m"};
    In<Wrench> in6{optional, "a wrench", "N, N m"};
    In<Pose> about6{optional, "where the torque of in6 refers to; open: the point of the output", "m"};
    In<Wrench> in7{optional, "a wrench", "N, N m"};
    In<Pose> about7{optional, "where the torque of in7 refers to; open: the point of the output", "m"};
    In<Wrench> in8{optional, "a wrench", "N, N m"};
    In<Pose> about8{optional, "where the torque of in8 refers to; open: the point of the output", "m"};
    In<Pose> point{optional, "where the torque of the output refers to; open: the origin of the world", "m"};
    Out<Wrench> out{"the sum", "N, N m"};

    void process(const Tick&) noexcept {
        Wrench sum;
        add(sum, in1, about1);
        add(sum, in2, about2);
        add(sum, in3, about3);
        add(sum, in4, about4);
        add(sum, in5, about5);
        add(sum, in6, about6);
        add(sum, in7, about7);
        add(sum, in8, about8);
        out = sum;
    }

private:
    void add(Wrench& sum, const In<Wrench>& in, const In<Pose>& at) const noexcept {
        if (!in.connected) return;
        Wrench moved = in;
        if (at.connected) moved.torque += glm::cross(at->position - point->position, moved.force);
        sum = sum + moved;
    }
};

TACTUS_NODE(WrenchSum, in1, about1, in2, about2, in3, about3, in4, about4, in5, about5, in6, about6, in7, about7, in8,
            about8, point, out)

}  // namespace tactus::nodes
