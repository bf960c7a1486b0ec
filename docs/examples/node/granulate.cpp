// SPDX-License-Identifier: Apache-2.0
// A node outside of the tree: pulses while a hand moves over a surface, one for each grain that it passes. It has what most nodes
// need: inputs at two rates, parameters with units, memory from `prepare`, random numbers that repeat, and results.
#include <tactus/dsp/core/random.hpp>
#include <tactus/graph/node/plugin.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace tactus;

struct Granulate {
    static constexpr auto about = "Pulses of an actuator while a hand moves, one for each grain that it passes.";

    In<Twist> motion{"of the hand"};
    Out<Signal> out{"pulses"};
    Param spacing{"0.5 mm", "0.05 mm", "20 mm", "mean distance from grain to grain"};
    Param height{"1", "0", "10", "of the tallest pulse"};
    Param length{"2 ms", "0.2 ms", "20 ms", "of a pulse"};

    void prepare(const Setup& setup) {
        random_ = Random{setup.seed};
        // Half a sine; `process` allocates nothing.
        shape_.resize(points);
        for (std::size_t i = 0; i < points; ++i)
            shape_[i] = static_cast<float>(std::sin(M_PI * static_cast<double>(i) / static_cast<double>(points)));
    }

    void process(const Tick& tick) noexcept {
        const double speed = glm::length(motion->linear);
        // Bad values come in, too, and must not stay.
        const double step = std::isfinite(speed) ? std::min(speed, 10.0) / tick.rate() : 0.0;
        const double phase_step = static_cast<double>(points) / (length * tick.rate());
        for (int i = 0; i < tick.frames; ++i) {
            way_ += step;
            if (way_ >= next_) {
                way_ = phase_ = 0.0;
                level_ = static_cast<float>(height * random_.uniform(2 * grains_));
                next_ = spacing * (0.5 + random_.uniform(2 * grains_ + 1));
                ++grains_;
            }
            out[i] = phase_ < static_cast<double>(points) ? level_ * shape_[static_cast<std::size_t>(phase_)] : 0.0f;
            phase_ += phase_step;
        }
    }

    /// In summary.json, and printed after the run.
    void report(Report& report) const { report.set("granulate", "grains", static_cast<double>(grains_)); }

private:
    static constexpr std::size_t points = 256;
    Random random_{0};
    std::vector<float> shape_;
    double way_ = 0.0, next_ = 0.0, phase_ = static_cast<double>(points);
    float level_ = 0.0f;
    std::uint64_t grains_ = 0;
};
TACTUS_NODE(Granulate, motion, out, spacing, height, length)

TACTUS_PLUGIN("granulate", "1.0", Granulate)
