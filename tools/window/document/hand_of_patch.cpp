// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/hand_of_patch.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <algorithm>

namespace tactus::window {

namespace {

std::string device_named_by(const compile::ScheduleNode& node) {
    const auto found = node.texts.find("device");
    return found == node.texts.end() ? std::string() : found->second->value;
}

}  // namespace

bool HandOfPatch::moves_by_itself() const {
    return driver == "simulated" || driver == "scripted" || driver == "replay";
}

std::string device_of(const compile::Schedule& plan, const compile::ScheduleNode& node) {
    const std::string named = device_named_by(node);
    return named.empty() && plan.patch.devices.size() == 1 ? plan.patch.devices.front().name : named;
}

std::string driver_of(const compile::Schedule& plan, const std::string& device) {
    const auto& devices = plan.patch.devices;
    const auto declared = std::ranges::find(devices, device, &patch::PatchDevice::name);
    return declared == devices.end() ? device : declared->driver;
}

std::optional<HandOfPatch> hand_of(const compile::Schedule& plan) {
    const auto source = std::ranges::find_if(
        plan.nodes, [](const compile::ScheduleNode& node) { return node.type->role == NodeRole::hand_source; });
    if (source == plan.nodes.end()) return std::nullopt;
    HandOfPatch hand{source->name, device_of(plan, *source), {}, {}};
    hand.driver = driver_of(plan, hand.device);
    for (const compile::ScheduleNode& node : plan.nodes) {
        const bool is_of_hand = node.type->role == NodeRole::hand_source || node.type->role == NodeRole::hand_sink;
        const std::string named = device_named_by(node);
        // A node without a device means the only one, which must not be opened beside the window's hand.
        if (&node == &*source || (is_of_hand && (named.empty() || named == hand.device)))
            hand.nodes.push_back(node.name);
    }
    return hand;
}

double largest_force(const compile::Schedule& plan, const std::string& device) {
    double most = max_of_device_N;
    for (const patch::PatchDevice& declared : plan.patch.devices)
        for (const OptionText& setting : declared.settings)
            if (declared.name == device && setting.name == "max_force") try {
                    most = parse_quantity(setting.text).value;
                } catch (const Error&) {
                    continue;  // the run says what is wrong
                }
    for (const compile::ScheduleNode& node : plan.nodes) {
        // Other nodes have a parameter of that name, too: guides and vessels.
        if (node.type->role != NodeRole::hand_sink) continue;
        const std::string named = device_named_by(node);
        const auto limit = node.params.find("max_force");
        if (limit != node.params.end() && (device.empty() || named.empty() || named == device))
            most = std::min(most, limit->second->value);
    }
    return most;
}

double largest_force(const compile::Schedule& plan) {
    const std::optional<HandOfPatch> hand = hand_of(plan);
    return largest_force(plan, hand ? hand->device : std::string());
}

}  // namespace tactus::window
