// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/patch/device_processes.hpp"

#include "devices/hosted/placement.hpp"
#include "graph/node/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace tactus::analysis {

namespace {

bool uses_device(const compile::ScheduleNode& node) {
    constexpr std::array<std::string_view, 4> users{"device_input", "device_output", "gripper_input", "gripper_output"};
    return std::ranges::find(users, node.type->name) != users.end();
}

std::string named_by(const compile::Schedule& plan, std::size_t node) {
    for (const OptionText& given : plan.patch.nodes[node].settings)
        if (given.name == "device") return given.text;
    return {};
}

/// The device that a node uses, or "" when it uses none. One that names none means the only one of the patch, or the only
/// one that others name.
std::string device_of(const compile::Schedule& plan, std::size_t node) {
    if (!uses_device(plan.nodes[node])) return {};
    if (std::string named = named_by(plan, node); !named.empty()) return named;
    if (plan.patch.devices.size() == 1) return plan.patch.devices.front().name;
    for (std::size_t other = 0; other < plan.nodes.size(); ++other)
        if (uses_device(plan.nodes[other]))
            if (std::string named = named_by(plan, other); !named.empty()) return named;
    return {};
}

std::optional<DeviceProcess> process_of(const compile::Schedule& plan, std::size_t node) {
    const std::string name = device_of(plan, node);
    const auto declared = std::ranges::find(plan.patch.devices, name, &patch::PatchDevice::name);
    if (declared == plan.patch.devices.end()) return std::nullopt;
    Options options(fmt::format("device '{}'", name), declared->settings, declared->where);
    const hosted::Placement placement = hosted::read_placement(options, declared->driver);
    if (!placement.own_process) return std::nullopt;
    const double period = seconds(plan.groups[static_cast<std::size_t>(plan.nodes[node].group)].period);
    return DeviceProcess{name, 1.0 / placement.round_s(period), placement.added_latency_s(period)};
}

}  // namespace

std::vector<DeviceProcess> device_processes(const compile::Schedule& plan) {
    std::vector<DeviceProcess> all;
    for (std::size_t node = 0; node < plan.nodes.size(); ++node)
        if (auto process = process_of(plan, node);
            process && std::ranges::find(all, process->device, &DeviceProcess::device) == all.end())
            all.push_back(std::move(*process));
    return all;
}

}  // namespace tactus::analysis
