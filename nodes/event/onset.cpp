// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

#include <cmath>
#include <cstdint>

namespace tactus::nodes {

struct Onset {
    static constexpr auto about =
        "An event at the sample at which a signal becomes loud: above a threshold, and several times its own level so "
        "far. Number of each: the absolute value of that sample. A sample that is not finite counts as 0.";

    In<Signal> in{"the signal"};
    Out<Event> events{"the onsets"};
    Param threshold{"0.1", "0", "1e12", "a quieter sample is no onset; in the unit of the signal"};
    Param ratio{"3", "1", "1000", "an onset is so many times the mean level before"};
    Param memory{"50 ms", "1 ms", "10 s", "time constant of that mean"};
    Param gap{"50 ms", "0 ms", "10 s", "no other onset comes sooner"};

    void prepare(const Setup& setup) {
        emit_.prepare(setup);
        level_ = 0.0;
        has_had_one_ = false;
    }
    void process(const Tick& tick) noexcept {
        const double forget = 1.0 - std::exp(-1.0 / (memory * tick.rate()));
        const auto apart = static_cast<std::int64_t>(std::ceil(gap * tick.rate() - 1e-9));
        for (int i = 0; i < tick.frames; ++i) {
            const double given = std::abs(static_cast<double>(in[i])), loud = std::isfinite(given) ? given : 0.0;
            const std::int64_t now = tick.index + i;
            if (loud > threshold && loud > ratio * level_ && (!has_had_one_ || now - last_ >= apart)) {
                emit_(events, tick, i, EventKind::instant, {loud});
                has_had_one_ = true;
                last_ = now;
            }
            level_ += forget * (loud - level_);
        }
    }

private:
    Emitter emit_;
    double level_ = 0.0;
    std::int64_t last_ = 0;
    bool has_had_one_ = false;
};

TACTUS_NODE(Onset, in, events, threshold, ratio, memory, gap)

}  // namespace tactus::nodes
