// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Rotate {
    static constexpr auto about = "Turns a vector, twist or wrench from the axes of a pose to world axes, or back.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"what is turned", kinds::vector | kinds::twist | kinds::wrench};
    In<Pose> by{"the pose; only its orientation counts", "m"};
    AnyOut out{"the same, along the other axes"};
    Choice to{{"world", "local"}, "axes of the output: those of the world, or those of the pose"};

    void prepare(const Setup&) { is_back_ = to.is("local"); }
    void process(const Tick&) noexcept {
        const Quat turn = is_back_ ? glm::conjugate(by->orientation) : by->orientation;
        const std::size_t count = in.type->columns.size() / 3;
        for (std::size_t k = 0; k < count; ++k) out.as<Vec3>()[k] = turn * in.as<Vec3>()[k];
    }

private:
    bool is_back_ = false;
};

TACTUS_NODE(Rotate, in, by, out, to)

}  // namespace tactus::nodes
