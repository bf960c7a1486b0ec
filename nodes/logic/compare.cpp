// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

namespace tactus::nodes {

struct Compare {
    static constexpr auto about =
        "Whether a number is above a threshold. With a hysteresis the answer changes back only when the number has "
        "come "
        "back by as much. SI units.";

    In<double> in{"the number; NaN leaves the answer as it is"};
    Out<bool> out{"true above the threshold, or below it"};
    Param threshold{"0", "-1e12", "1e12", "the answer becomes true beyond it"};
    Param hysteresis{"0", "0", "1e12", "the answer becomes false this far on the other side of the threshold"};
    Choice is{{"above", "below"}, "side on which the answer is true"};

    void prepare(const Setup&) {
        sign_ = is.is("below") ? -1.0 : 1.0;
        out = false;
    }
    void process(const Tick&) noexcept {
        const double beyond = sign_ * (in - threshold);
        if (beyond > 0.0) out = true;
        // Without hysteresis, a number at the threshold is not above it.
        else if (beyond <= -hysteresis) out = false;
    }

private:
    double sign_ = 1.0;
};

TACTUS_NODE(Compare, in, out, threshold, hysteresis, is)

}  // namespace tactus::nodes
