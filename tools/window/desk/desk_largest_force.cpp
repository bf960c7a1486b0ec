// SPDX-License-Identifier: Apache-2.0
// The instant of a take in which its force is largest.
#include "tools/window/desk/desk.hpp"

#include <fmt/format.h>

#include <optional>

namespace tactus::window {

void Desk::go_to_largest_force() {
    std::optional<TakeFeed::Peak> best;
    const auto look_at = [&](const std::string& port) {
        if (const auto peak = take_->feed().largest(port); peak && (!best || peak->value > best->value)) best = peak;
    };
    try {
        if (bench_.plan())
            for (const compile::ScheduleNode& node : bench_.plan()->nodes)
                if (node.type->role == NodeRole::hand_sink)
                    for (const compile::ScheduleOutput& output : node.outputs)
                        if (output.name == "applied") look_at(node.name + ".applied");
        // A patch without a hand has forces, too.
        if (!best)
            for (const Feed::Port& port : take_->feed().ports())
                if (port.type == &value::wrench) look_at(port.name);
    } catch (const Error& error) {
        return bench_.tell(error.what(), true);
    }
    if (!best) return bench_.tell("this take has no forces", true);
    take_->play(false);
    take_->go_to(best->when);
    patch_.selected = best->port.substr(0, best->port.find('.'));
    patch_.wants_scope = best->port;
    bench_.tell(fmt::format("largest force: {:.3f} N at {:.3f} s, {}", best->value, best->when, best->port));
}

}  // namespace tactus::window
