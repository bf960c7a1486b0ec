// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/logic/values.hpp"

namespace tactus::nodes {

struct SampleAndHold {
    static constexpr auto about = "Keeps the value that was there when the trigger last became true.";
    static constexpr UnitRule units = UnitRule::same;

    In<bool> trigger{"takes the value when it becomes true"};
    AnyIn in{"the value", kinds::plain & ~kinds::signal};
    AnyOut out{"the kept value; before the first trigger zero, the identity or false"};

    void prepare(const Setup&) {
        out.type->make_default(out.data);
        was_ = false;
    }
    void process(const Tick& tick) noexcept {
        if (trigger && !was_) copy_value(in.data, out, tick);
        was_ = trigger;
    }

private:
    bool was_ = false;
};

TACTUS_NODE(SampleAndHold, trigger, in, out)

}  // namespace tactus::nodes
