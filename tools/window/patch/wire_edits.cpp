// SPDX-License-Identifier: Apache-2.0
// Edits of wires at the bench, and the ports that they lead to.
#include "graph/edit/patch_arrange.hpp"
#include "graph/patch/sub_patch.hpp"
#include "tools/window/document/workbench.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::window {

const TypePorts* Workbench::ports_of(const std::string& node) const {
    const auto written = std::ranges::find(written_.nodes, node, &patch::PatchNode::name);
    if (written != written_.nodes.end()) {
        if (!patch::is_sub_patch(*written)) return ports_of_type(written->type);
        const auto part = unfinished_.parts.find(written->type);
        return part == unfinished_.parts.end() ? nullptr : &part->second.ports;
    }
    const int index = picture_.find(node);
    return index < 0 ? nullptr : ports_of_type(picture_.nodes[static_cast<std::size_t>(index)].type);
}

std::string Workbench::offered_as(const std::string& node, const std::string& param) const {
    if (!plan_) return {};
    for (const patch::PatchEnd& end : plan_->patch.offered)
        if (end.node == node && end.port == param && end.name.find(patch::within_node) == std::string::npos)
            return end.name;
    return {};
}

edit::InputTakes Workbench::taken_by(const std::string& to) const {
    const std::size_t dot = to.rfind('.');
    const TypePorts* ports = dot == std::string::npos ? nullptr : ports_of(to.substr(0, dot));
    const bool takes_many = ports && std::ranges::any_of(ports->inputs, [&](const PicturePort& input) {
                                return input.takes_many && input.name == to.substr(dot + 1);
                            });
    return takes_many ? edit::InputTakes::many_wires : edit::InputTakes::one_wire;
}

bool Workbench::connect(const std::string& from, const std::string& to, const std::string& mode) {
    return edit([&](std::string_view text) { return edit::with_wire(text, {from, to, mode}, taken_by(to)); },
                fmt::format("{} -> {}{}{}", from, to, mode.empty() ? "" : " as ", mode));
}

bool Workbench::disconnect(const std::string& to, const std::string& from) {
    const std::string one = taken_by(to) == edit::InputTakes::many_wires ? from : "";
    return edit([&](std::string_view text) { return edit::without_wire(text, to, one); },
                one.empty() ? fmt::format("no wire to {}", to) : fmt::format("no wire from {} to {}", one, to));
}

bool Workbench::reconnect(const std::string& from, const std::string& old_to, const std::string& to) {
    return lead({from, old_to}, {from, to}, fmt::format("{} -> {} in place of {}", from, to, old_to));
}

bool Workbench::reconnect_source(const std::string& old_from, const std::string& from, const std::string& to) {
    return lead({old_from, to}, {from, to}, fmt::format("{} -> {} in place of {}", from, to, old_from));
}

bool Workbench::lead(const Ends& before, const Ends& now, const std::string& done) {
    const std::string one = taken_by(before.to) == edit::InputTakes::many_wires ? before.from : "";
    const auto led = [&](std::string_view text, const std::string& mode) {
        // One that stays at its input is changed where it stands.
        if (one.empty() && before.to == now.to) return edit::with_wire(text, {now.from, now.to, mode});
        return edit::with_wire(edit::without_wire(text, before.to, one), {now.from, now.to, mode}, taken_by(now.to));
    };
    // How it is delivered stays, where the new end takes that.
    std::string mode;
    for (const patch::PatchWire& wire : written_.wires)
        if (wire.mode_given && wire.from_node + "." + wire.from_port == before.from &&
            wire.to_node + "." + wire.to_port == before.to)
            mode = edit::mode_text(wire);
    try {
        if (!mode.empty() && refusal_of(faults_, judge(led(editor_->text(), mode)).faults)) mode.clear();
    } catch (const Error&) {
        // The edit says what is wrong.
    }
    return edit([&](std::string_view text) { return led(text, mode); }, done);
}

std::optional<std::string> Workbench::objection(const std::string& from, const std::string& to) const {
    try {
        return refusal_of(faults_, judge(edit::with_wire(editor_->text(), {from, to, {}}, taken_by(to))).faults);
    } catch (const Error& error) {
        return error.what();
    }
}

}  // namespace tactus::window
