// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/patch_change.hpp"

#include "dsp/core/units.hpp"

#include <algorithm>
#include <map>

namespace tactus::window {

namespace {

bool same(const std::vector<OptionText>& a, const std::vector<OptionText>& b) {
    return std::ranges::is_permutation(
        a, b, [](const OptionText& x, const OptionText& y) { return x.name == y.name && x.text == y.text; });
}

bool same_wire(const patch::PatchWire& a, const patch::PatchWire& b) {
    return a.from_node == b.from_node && a.from_port == b.from_port && a.to_node == b.to_node &&
           a.to_port == b.to_port && a.mode == b.mode && a.mode_given == b.mode_given && a.delay == b.delay;
}

/// All content outside of the nodes.
bool same_around(const patch::Patch& a, const patch::Patch& b) {
    return a.quantum == b.quantum && a.seed == b.seed && a.title == b.title &&
           std::ranges::equal(a.wires, b.wires, same_wire) &&
           std::ranges::equal(a.assets, b.assets,
                              [](const auto& x, const auto& y) { return x.name == y.name && x.path == y.path; }) &&
           std::ranges::equal(a.groups, b.groups,
                              [](const auto& x, const auto& y) {
                                  return x.name == y.name && x.rate == y.rate && x.latency == y.latency &&
                                         x.backlog == y.backlog;
                              }) &&
           std::ranges::equal(a.devices, b.devices,
                              [](const auto& x, const auto& y) {
                                  return x.name == y.name && x.driver == y.driver && same(x.settings, y.settings);
                              }) &&
           std::ranges::equal(a.actuators, b.actuators, [](const auto& x, const auto& y) {
               return x.name == y.name && same(x.settings, y.settings);
           });
}

/// The settings of a node that cannot be changed live.
std::vector<OptionText> fixed_settings(const patch::PatchNode& patched, const compile::ScheduleNode& node) {
    std::vector<OptionText> fixed;
    for (const OptionText& setting : patched.settings) {
        const auto param = node.params.find(setting.name);
        if (param == node.params.end() || param->second->is_structural) fixed.push_back(setting);
    }
    return fixed;
}

}  // namespace

PatchChange change_between(const compile::Schedule& before, const compile::Schedule& after) {
    PatchChange change;
    change.needs_edit = !same_around(before.patch, after.patch) || before.nodes.size() != after.nodes.size();
    std::map<std::string_view, std::size_t> earlier;
    for (std::size_t n = 0; n < before.nodes.size(); ++n) earlier[before.nodes[n].name] = n;
    for (std::size_t n = 0; n < after.nodes.size(); ++n) {
        const compile::ScheduleNode& node = after.nodes[n];
        const auto found = earlier.find(node.name);
        if (found == earlier.end() || before.nodes[found->second].type != node.type) {
            change.needs_edit = true;
            continue;
        }
        const compile::ScheduleNode& old = before.nodes[found->second];
        const patch::PatchNode &a = before.patch.nodes[found->second], &b = after.patch.nodes[n];
        change.needs_edit = change.needs_edit || a.rate != b.rate || a.group != b.group ||
                            !same(fixed_settings(a, old), fixed_settings(b, node));
        for (const auto& [name, param] : node.params)
            if (!param->is_structural && param->value != old.params.at(name)->value)
                change.settings.push_back({node.name, name, format_quantity(param->value, param->unit)});
    }
    return change;
}

}  // namespace tactus::window
