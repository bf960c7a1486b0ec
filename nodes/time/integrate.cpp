// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactus::nodes {

struct Integrate {
    static constexpr auto about =
        "Integral over time of a number or vector, by trapezia. A leak lets it forget; the limit keeps each component "
        "in "
        "bounds. A value that is not finite counts as 0.";
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
        const double dt = tick.elapsed_seconds(), keep = leak > 0.0 ? std::exp(-dt / leak) : 1.0;
        for (std::size_t k = 0; k < count_; ++k) {
            const double given = in.as<double>()[k];
            const double now = std::clamp(std::isfinite(given) ? given : 0.0, -1e15, 1e15);
            double& sum = out.as<double>()[k];
            sum = reset ? 0.0 : std::clamp(keep * sum + 0.5 * dt * (keep * before_[k] + now), -limit, +limit);
            before_[k] = now;
        }
    }

private:
    double before_[3] = {};
    std::size_t count_ = 1;
};

TACTUS_NODE(Integrate, in, reset, out, leak, limit)

}  // namespace tactus::nodes
