// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::nodes {

struct Mix {
    static constexpr auto about = "Weighted sum of up to eight values of one type.";
    static constexpr UnitRule units = UnitRule::same;
    static constexpr bool shapes_values = true;

    AnyIn in1{optional, "a value", kinds::addable}, in2{optional, "a value", kinds::addable};
    AnyIn in3{optional, "a value", kinds::addable}, in4{optional, "a value", kinds::addable};
    AnyIn in5{optional, "a value", kinds::addable}, in6{optional, "a value", kinds::addable};
    AnyIn in7{optional, "a value", kinds::addable}, in8{optional, "a value", kinds::addable};
    AnyOut out{"gain1 × in1 + … + gain8 × in8"};
    Param gain1{"1", "-1000", "1000", "factor of in1"}, gain2{"1", "-1000", "1000", "factor of in2"};
    Param gain3{"1", "-1000", "1000", "factor of in3"}, gain4{"1", "-1000", "1000", "factor of in4"};
    Param gain5{"1", "-1000", "1000", "factor of in5"}, gain6{"1", "-1000", "1000", "factor of in6"};
    Param gain7{"1", "-1000", "1000", "factor of in7"}, gain8{"1", "-1000", "1000", "factor of in8"};

    std::vector<PortSlope> slopes() const {
        return {{"in1", std::abs(gain1)}, {"in2", std::abs(gain2)}, {"in3", std::abs(gain3)}, {"in4", std::abs(gain4)},
                {"in5", std::abs(gain5)}, {"in6", std::abs(gain6)}, {"in7", std::abs(gain7)}, {"in8", std::abs(gain8)}};
    }

    void prepare(const Setup& setup) {
        if (out.type == &value::undecided) setup.fail("a mix needs a wire to one of its inputs");
        is_signal_ = out.type == &value::signal;
        count_ = out.type->columns.size();
    }

    void process(const Tick& tick) noexcept {
        if (is_signal_) std::fill_n(out.as<float>(), tick.frames, 0.0f);
        else std::fill_n(out.as<double>(), count_, 0.0);
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
    void add(const Tick& tick, const AnyIn& in, double gain) noexcept {
        if (!in.connected) return;
        if (!is_signal_) {
            for (std::size_t k = 0; k < count_; ++k) out.as<double>()[k] += gain * in.as<double>()[k];
            return;
        }
        const auto factor = static_cast<float>(gain);
        for (int i = 0; i < tick.frames; ++i) out.as<float>()[i] += factor * in.as<float>()[i];
    }

    bool is_signal_ = true;
    std::size_t count_ = 1;
};

TACTUS_NODE(Mix, in1, in2, in3, in4, in5, in6, in7, in8, out, gain1, gain2, gain3, gain4, gain5, gain6, gain7, gain8)

}  // namespace tactus::nodes
