// SPDX-License-Identifier: Apache-2.0
// No patch feels stiffer than its devices state they can be.
#include "engine/build/generation_builder.hpp"
#include "graph/analyse/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::build {

namespace {

/// Of the devices that a node drives, the least stiff that states a stiffness; null: none does.
const DeviceInfo* softest_driven(const LiveNode& node) {
    const DeviceInfo* softest = nullptr;
    for (const auto& [slot, use] : node.uses.devices) {
        const DeviceInfo& info = slot->port.info;
        if (use != DeviceUse::drive || !(info.max_stiffness > 0.0)) continue;
        if (!softest || info.max_stiffness < softest->max_stiffness) softest = &info;
    }
    return softest;
}

}  // namespace

/// The range of each stiffness that is felt through such a device ends at what the device states, so that wires are
/// clamped and `set` is refused. A value that is larger already is an error. After `prepare`, which opens the devices.
void GenerationBuilder::limit_stiffness() {
    if (std::ranges::none_of(made_->nodes, [](const auto& node) { return softest_driven(*node) != nullptr; })) return;
    for (const analyse::FeltSpring& spring : analyse::felt_springs(plan())) {
        const DeviceInfo* const info = softest_driven(*made_->nodes[static_cast<std::size_t>(spring.sink)]);
        if (!info) continue;
        Param& param = *spring.param;
        const double most = info->max_stiffness / spring.scale;
        if (!spring.is_driven && param.value > most * (1.0 + 1e-9))
            throw Error(
                spring.where,
                fmt::format("{} = {:.4g} N/mm is felt as {:.4g} N/mm, but device '{}' states that it can be {:.4g} "
                            "N/mm stiff; lower it to {:.4g} N/mm",
                            spring.name, param.value * 1e-3, param.value * spring.scale * 1e-3, info->name,
                            info->max_stiffness * 1e-3, most * 1e-3));
        param.max = std::max(param.min, std::min(param.max, most));
        param.value = std::min(param.value, param.max);
    }
}

}  // namespace tactus::build
