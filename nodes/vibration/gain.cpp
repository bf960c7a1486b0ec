// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::nodes {

struct Gain {
    static constexpr auto about = "Multiplies a signal, number, vector, twist or wrench by a factor.";
    static constexpr UnitRule units = UnitRule::same;
    static constexpr bool shapes_values = true;

    AnyIn in{"the value", kinds::addable};
    AnyOut out{"factor × in"};
    Param factor{"1", "-1000", "1000", "gain"};

    std::vector<PortSlope> slopes() const { return {{"in", std::abs(factor)}}; }

    void prepare(const Setup&) {
        is_signal_ = in.type == &value::signal;
        count_ = in.type->columns.size();
    }

    void process(const Tick& tick) noexcept {
        if (!is_signal_) {
            for (std::size_t k = 0; k < count_; ++k) out.as<double>()[k] = factor * in.as<double>()[k];
            return;
        }
        const auto f = static_cast<float>(factor);
        for (int i = 0; i < tick.frames; ++i) out.as<float>()[i] = f * in.as<float>()[i];
    }

private:
    bool is_signal_ = true;
    std::size_t count_ = 1;
};

TACTUS_NODE(Gain, in, out, factor)

}  // namespace tactus::nodes
