// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::nodes {

struct Slew {
    static constexpr auto about =
        "Follows a value no faster than a limit: each component of a number, vector, twist or wrench, each sample of a "
        "signal. It starts at 0; a number or sample that is not finite is not followed. A vector, twist or wrench that "
        "is "
        "not finite is passed on: the fault of a force must be seen.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the value to follow", kinds::addable};
    AnyOut out{"the value with limited rate of change"};
    Param rise{"1 1/s", "0 1/s", "1e12 1/s", "most that it grows per second, in the unit of the input"};
    Param fall{"1 1/s", "0 1/s", "1e12 1/s", "most that it falls per second, in the unit of the input"};

    void prepare(const Setup& setup) {
        period_s_ = seconds(setup.period);
        sample_ = 0.0;
        state_ = {};
        if (in.type != &value::signal) in.type->make_default(out.data);
    }
    void process(const Tick& tick) noexcept {
        if (in.type == &value::signal) {
            const double up = rise * period_s_, down = fall * period_s_;
            for (int i = 0; i < tick.frames; ++i) {
                sample_ = step(sample_, static_cast<double>(in.as<float>()[i]), up, down);
                out.as<float>()[i] = signal::to_sample(sample_);
            }
            return;
        }
        const double dt = tick.elapsed_seconds();
        const std::size_t count = in.type->columns.size();
        for (std::size_t k = 0; k < count; ++k) {
            const double x = in.as<double>()[k];
            state_[k] = step(state_[k], x, rise * dt, fall * dt);
            out.as<double>()[k] = count == 1 || std::isfinite(x) ? state_[k] : x;
        }
    }

private:
    static double step(double y, double x, double up, double down) noexcept {
        return std::isfinite(x) ? y + std::clamp(x - y, -down, up) : y;
    }

    double period_s_ = 0.0, sample_ = 0.0;
    std::array<double, 6> state_{};  // of the columns
};

TACTUS_NODE(Slew, in, out, rise, fall)

}  // namespace tactus::nodes
