// SPDX-License-Identifier: Apache-2.0
#include "graph/node.hpp"

#include <cmath>
#include <cstdint>

namespace tactus::nodes {

struct Button {
    static constexpr auto about =
        "A button for what the device has none for: pressed for a moment whenever its parameter changes, as by 'tactus "
        "set undo.press=1' and next time 'tactus set undo.press=2'.";

    Out<bool> pressed{"true for 20 ms after each change"};
    Param press{"0", "-1e9", "1e9", "any other number than before is a press"};

    void prepare(const Setup& setup) {
        ticks_ = static_cast<std::int64_t>(std::ceil(0.02 * setup.rate()));
        left_ = 0;
        last_ = press;
        pressed = false;
    }
    void process(const Tick&) noexcept {
        if (press != last_) left_ = ticks_;
        last_ = press;
        pressed = left_ > 0;
        left_ -= left_ > 0;
    }

private:
    std::int64_t ticks_ = 1, left_ = 0;
    double last_ = 0.0;
};

TACTUS_NODE(Button, pressed, press)

}  // namespace tactus::nodes
