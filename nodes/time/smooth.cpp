// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tactus::nodes {

struct Smooth {
    static constexpr auto about =
        "First-order lag of any value that has values in between; a pose turns along the shortest rotation. It starts "
        "with the first value; a number, sample or pose that is not finite is not followed. A vector, twist or wrench "
        "that "
        "is not finite is passed on: the fault of a force must be seen.";
    static constexpr UnitRule units = UnitRule::same;

    AnyIn in{"the value to follow", kinds::addable | kinds::pose};
    AnyOut out{"the smoothed value"};
    Param time{"10 ms", "0 s", "1 h", "time constant: after a step, the time to 63 % of it"};

    void prepare(const Setup& setup) {
        period_s_ = seconds(setup.period);
        has_begun_ = is_passed_on_ = false;
        sample_ = 0.0;
        if (in.type != &value::signal) in.type->make_default(out.data);
    }
    void process(const Tick& tick) noexcept {
        if (in.type == &value::signal) return follow_signal(tick);
        double columns[7];
        in.type->to_columns(in.data, columns);
        const std::size_t count = in.type->columns.size();
        const bool is_addable = count > 1 && in.type != &value::pose;
        double* const y = out.as<double>();
        if (std::any_of(columns, columns + count, [](double x) { return !(std::abs(x) <= largest); })) {
            if (!is_addable) return;
            if (!std::exchange(is_passed_on_, true)) std::copy_n(y, count, state_.begin());
            std::copy_n(columns, count, y);
            return;
        }
        if (std::exchange(is_passed_on_, false)) std::copy_n(state_.begin(), count, y);
        const double share = has_begun_ ? signal::lag_share(time, tick.elapsed_seconds()) : 1.0;
        has_begun_ = true;
        in.type->interpolate(out.data, in.data, share, out.data);
    }

private:
    void follow_signal(const Tick& tick) noexcept {
        const double share = signal::lag_share(time, period_s_);
        for (int i = 0; i < tick.frames; ++i) {
            const auto x = static_cast<double>(in.as<float>()[i]);
            if (std::isfinite(x)) {
                sample_ += (has_begun_ ? share : 1.0) * (x - sample_);
                has_begun_ = true;
            }
            out.as<float>()[i] = signal::to_sample(sample_);
        }
    }

    // Differences of what is followed must not overflow.
    static constexpr double largest = 1e150;

    double period_s_ = 0.0, sample_ = 0.0;
    bool has_begun_ = false, is_passed_on_ = false;
    std::array<double, 6> state_{};  // while a value that is not finite is passed on
};

TACTUS_NODE(Smooth, in, out, time)

}  // namespace tactus::nodes
