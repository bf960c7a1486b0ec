// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

namespace tactus::nodes {

struct ThresholdEvents {
    static constexpr auto about =
        "An event when a number rises above a threshold (begin) and when it has come back (end), with the number. SI "
        "units. NaN changes nothing.";

    In<double> in{"the number"};
    Out<Event> events{"begins and ends"};
    Param threshold{"0", "-1e12", "1e12", "a begin comes above it"};
    Param hysteresis{"0", "0", "1e12", "an end comes when the number is this far below the threshold, or at it for 0"};

    void prepare(const Setup& setup) {
        emit_.prepare(setup);
        is_above_ = false;
    }
    void process(const Tick& tick) noexcept {
        const double above = in - threshold;
        if (!is_above_ && above > 0.0) {
            is_above_ = true;
            emit_(events, tick, 0, EventKind::begin, {in});
        } else if (is_above_ && above <= -hysteresis) {
            is_above_ = false;
            emit_(events, tick, 0, EventKind::end, {in});
        }
    }

private:
    Emitter emit_;
    bool is_above_ = false;
};

TACTUS_NODE(ThresholdEvents, in, events, threshold, hysteresis)

}  // namespace tactus::nodes
