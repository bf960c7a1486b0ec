// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/adaptive_window.hpp"
#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct Differentiate {
    static constexpr auto about =
        "Rate of change of a number or vector, per second. With 'noise' it looks back as far as a straight line fits "
        "the "
        "values within that (adaptive window, Janabi-Sharifi 2000): little noise while the change is steady, little "
        "lag "
        "while it is not. A value that is not finite is left out.";
    static constexpr UnitRule units = UnitRule::rate;
    static constexpr bool shapes_values = true;

    AnyIn in{"the value", kinds::number | kinds::vector};
    AnyOut out{"its rate of change per second"};
    Param noise{structural, "0", "0", "1e12", "most that a value is away from the truth; 0: the last two values count"};

    void prepare(const Setup&) {
        is_number_ = in.type == &value::number;
        window_.prepare(noise);
        since_s_ = 0.0;
        put(Vec3(0.0));
    }
    void process(const Tick& tick) noexcept {
        since_s_ += tick.elapsed_seconds();
        const Vec3 now = is_number_ ? Vec3(*in.as<double>(), 0.0, 0.0) : *in.as<Vec3>();
        if (!is_finite(now)) return;
        const Vec3 slope = window_(now, since_s_);
        since_s_ = 0.0;
        if (is_finite(slope)) put(slope);
    }

private:
    void put(const Vec3& slope) noexcept {
        if (is_number_) *out.as<double>() = slope.x;
        else *out.as<Vec3>() = slope;
    }

    control::AdaptiveWindow window_;
    double since_s_ = 0.0;
    bool is_number_ = true;
};

TACTUS_NODE(Differentiate, in, out, noise)

}  // namespace tactus::nodes
