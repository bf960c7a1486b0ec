// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct Magnitude {
    static constexpr auto about =
        "Length of a vector, force, velocity or position (or of a torque or angular velocity); absolute value of a "
        "number.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"what has a length", kinds::wrench | kinds::twist | kinds::pose | kinds::vector | kinds::number};
    Out<double> out{"the length, in SI units"};
    Choice part{{"linear", "angular"}, "linear: force, velocity, position; angular: torque, angular velocity"};

    void prepare(const Setup& setup) {
        if (!in.type) setup.fail("magnitude needs a wire to 'in'");
        const bool has_angular = in.type == &value::wrench || in.type == &value::twist;
        if (!has_angular && part.is("angular"))
            setup.fail("a " + std::string(in.type->name) + " has no angular part to take the magnitude of");
        first_ = part.is("angular") ? 3 : 0;
        length_ = in.type == &value::number ? 1 : 3;
    }

    void process(const Tick&) noexcept {
        double columns[7] = {};
        in.type->to_columns(in.data, columns);
        const double* v = columns + first_;
        out = length_ == 1 ? std::abs(v[0]) : std::hypot(v[0], v[1], v[2]);
    }

private:
    int first_ = 0, length_ = 3;
};

TACTUS_NODE(Magnitude, in, out, part)

}  // namespace tactus::nodes
