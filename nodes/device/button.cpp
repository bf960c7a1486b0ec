// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>
#include <cstdint>

namespace tactus::nodes {

struct Button {
    static constexpr auto about =
        "A button that is not on the device: pressed for 20 ms whenever 'press' changes, as 'tactus trigger undo' "
        "changes it, and for as long as 'hold' is 1.";

    Out<bool> pressed{"true for 20 ms after each change of 'press', and while 'hold' is above 0.5"};
    Param press{as_trigger, "0", "-1e9", "1e9", "change the number to press once"};
    Param hold{as_trigger, "0", "0", "1", "above 0.5: pressed"};

    void prepare(const Setup& setup) {
        ticks_ = static_cast<std::int64_t>(std::ceil(0.02 * setup.rate()));
        left_ = 0;
        last_ = press;
        pressed = hold > 0.5;
    }
    void process(const Tick&) noexcept {
        if (press != last_) left_ = ticks_;
        last_ = press;
        pressed = left_ > 0 || hold > 0.5;
        left_ -= left_ > 0;
    }

private:
    std::int64_t ticks_ = 1, left_ = 0;
    double last_ = 0.0;
};

TACTUS_NODE(Button, pressed, press, hold)

}  // namespace tactus::nodes
