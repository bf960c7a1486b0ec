// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Mix {
    static constexpr auto about = "Weighted sum of up to eight signals.";

    In<Signal> in1{optional, "a signal"}, in2{optional, "a signal"}, in3{optional, "a signal"};
    In<Signal> in4{optional, "a signal"}, in5{optional, "a signal"}, in6{optional, "a signal"};
    In<Signal> in7{optional, "a signal"}, in8{optional, "a signal"};
    Out<Signal> out{"gain1 × in1 + … + gain8 × in8"};
    Param gain1{"1", "-1000", "1000", "factor of in1"}, gain2{"1", "-1000", "1000", "factor of in2"};
    Param gain3{"1", "-1000", "1000", "factor of in3"}, gain4{"1", "-1000", "1000", "factor of in4"};
    Param gain5{"1", "-1000", "1000", "factor of in5"}, gain6{"1", "-1000", "1000", "factor of in6"};
    Param gain7{"1", "-1000", "1000", "factor of in7"}, gain8{"1", "-1000", "1000", "factor of in8"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) out[i] = 0.0f;
        add(tick, in1, gain1);
        add(tick, in2, gain2);
        add(tick, in3, gain3);
        add(tick, in4, gain4);
        add(tick, in5, gain5);
        add(tick, in6, gain6);
        add(tick, in7, gain7);
        add(tick, in8, gain8);
    }

private:
    void add(const Tick& tick, const In<Signal>& in, double gain) noexcept {
        if (!in.connected) return;
        const auto factor = static_cast<float>(gain);
        for (int i = 0; i < tick.frames; ++i) out[i] += factor * in[i];
    }
};

TACTUS_NODE(Mix, in1, in2, in3, in4, in5, in6, in7, in8, out, gain1, gain2, gain3, gain4, gain5, gain6, gain7, gain8)

}  // namespace tactus::nodes
