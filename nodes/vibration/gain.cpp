// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/measure.hpp"
#include "graph/node/node.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::nodes {

struct Gain {
    static constexpr auto about = "Multiplies a signal, number, vector, twist or wrench by a factor.";
    static constexpr UnitRule units = UnitRule::same;
    static constexpr bool shapes_values = true;

    AnyIn in{"the value", kinds::addable};
    AnyOut out{"factor × in"};
    Param factor{"1", "-1000", "1000", "gain, in SI units"};

    std::string unit_of(std::string_view port) const { return port == "out" ? unit.value : ""; }
    std::vector<PortSlope> slopes() const { return {{"in", std::abs(factor)}}; }

    void prepare(const Setup& setup) {
        try {
            static_cast<void>(formula::parse_measured_unit(unit.value));
        } catch (const Error& error) {
            throw Error(unit.where.line > 0 ? unit.where : setup.where, error.message());
        }
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

public:
    // Last, since no call uses it.
    Text unit{"", "unit of the output when the factor has one itself: \"N\" for a drag that makes a force of a speed"};
};

TACTUS_NODE(Gain, in, out, factor, unit)

}  // namespace tactus::nodes
