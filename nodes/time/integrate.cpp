// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactus::nodes {

struct Integrate {
    static constexpr auto about =
        "Integral over time of a number or vector, straight lines between the ticks. A leak lets it forget; the limit "
        "keeps each component in bounds. A value that is not finite counts as 0.";
    static constexpr UnitRule units = UnitRule::integral;
    static constexpr bool shapes_values = true;

    AnyIn in{"the value", kinds::number | kinds::vector};
    In<bool> reset{optional, "true: the integral is 0"};
    AnyOut out{"its integral, the value times seconds"};
    Param leak{"0 s", "0 s", "1 h", "time constant after which a contribution has fallen to 1/e; 0: never"};
    Param limit{"1e6", "0", "1e12", "largest absolute value of each component"};

    void prepare(const Setup&) {
        count_ = in.type->columns.size();
        for (std::size_t k = 0; k < count_; ++k) out.as<double>()[k] = before_[k] = 0.0;
    }
    void process(const Tick& tick) noexcept {
        const Weights w = weights(leak, tick.elapsed_seconds());
        for (std::size_t k = 0; k < count_; ++k) {
            const double given = in.as<double>()[k];
            const double now = std::clamp(std::isfinite(given) ? given : 0.0, -1e15, 1e15);
            double& sum = out.as<double>()[k];
            sum = reset ? 0.0 : std::clamp(w.keep * sum + w.before * before_[k] + w.now * now, -limit, +limit);
            before_[k] = now;
        }
    }

private:
    /// Exact for an input that is a straight line between two ticks, however short the time constant.
    struct Weights {
        double keep, before, now;
    };
    static Weights weights(double leak, double dt) noexcept {
        if (!(leak > 0.0)) return {1.0, 0.5 * dt, 0.5 * dt};
        const double a = dt / leak, keep = std::exp(-a);
        // Below, the differences cancel: series to the third order.
        if (a < 1e-3) return {keep, dt * (0.5 - a / 3.0 + a * a / 8.0), dt * (0.5 - a / 6.0 + a * a / 24.0)};
        const double mean = -std::expm1(-a) / a;
        return {keep, leak * (mean - keep), leak * (1.0 - mean)};
    }

    double before_[3] = {};
    std::size_t count_ = 1;
};

TACTUS_NODE(Integrate, in, reset, out, leak, limit)

}  // namespace tactus::nodes
