// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::nodes {

struct Comb {
    static constexpr auto about =
        "Comb filter: y(t) = x(t) + forward × x(t - time) + back × y(t - time). 'forward' notches, 'back' rings at "
        "multiples of 1/time. A non-finite sample counts as 0.";

    In<Signal> in{"the signal"};
    Out<Signal> out{"the filtered signal"};
    Param time{structural, "5 ms", "0 s", "2 s", "delay, to whole samples, one at least"};
    Param forward{"0", "-1", "1", "share of the delayed input"};
    Param back{"0.5", "-0.999", "0.999", "share of the delayed output"};

    void prepare(const Setup& setup) {
        const auto samples = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(time * setup.rate())));
        if (samples > max_samples) setup.fail("a comb holds at most 4 million samples; make 'time' shorter");
        past_.assign(samples, {});
        at_ = 0;
    }
    void process(const Tick& tick) noexcept {
        const double f = forward, b = back;
        for (int i = 0; i < tick.frames; ++i) {
            Past& past = past_[at_];
            const double x = std::clamp(signal::finite_or_zero(in[i]), -largest, largest);
            const double y = x + f * past.x + b * past.y;
            past = {x, y};
            at_ = at_ + 1 == past_.size() ? 0 : at_ + 1;
            out[i] = signal::to_sample(y);
        }
    }

private:
    static constexpr std::size_t max_samples = 4'000'000;
    // What rings on for seconds must not overflow.
    static constexpr double largest = 1e30;
    struct Past {
        double x = 0.0, y = 0.0;
    };
    std::vector<Past> past_;
    std::size_t at_ = 0;
};

TACTUS_NODE(Comb, in, out, time, forward, back)

}  // namespace tactus::nodes
