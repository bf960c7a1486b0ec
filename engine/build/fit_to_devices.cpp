// SPDX-License-Identifier: Apache-2.0
// No patch feels stiffer than its devices state they can be.
#include "engine/build/generation_builder.hpp"
#include "graph/analyse/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tactus::build {

namespace {

/// Of the devices that a node drives, the least stiff that states a stiffness; null: none does.
const DeviceSlot* softest_driven(const LiveNode& node) {
    const DeviceSlot* softest = nullptr;
    for (const auto& [slot, use] : node.uses.devices) {
        const double stated = slot->port.info.max_stiffness;
        if (use != DeviceUse::drive || !(stated > 0.0)) continue;
        if (!softest || stated < softest->port.info.max_stiffness) softest = slot;
    }
    return softest;
}

}  // namespace

/// The range of each stiffness that is felt through such a device ends at what the device states, so that wires are
/// clamped and `set` is refused. A value that is larger already is an error, if the patch declares the device; for a
/// device that only the command line names (`--set hand.device=touch`) it is lowered, since the patch knows nothing of
/// it. After `prepare`, which opens the devices.
void GenerationBuilder::limit_stiffness() {
    if (std::ranges::none_of(made_->nodes, [](const auto& node) { return softest_driven(*node) != nullptr; })) return;
    for (const analyse::FeltSpring& spring : analyse::felt_springs(plan())) {
        const DeviceSlot* const slot = softest_driven(*made_->nodes[static_cast<std::size_t>(spring.sink)]);
        if (!slot) continue;
        const DeviceInfo& info = slot->port.info;
        Param& param = *spring.param;
        const double most = info.max_stiffness / spring.scale;
        if (!spring.is_driven && param.value > most * (1.0 + 1e-9)) {
            const bool is_declared = std::ranges::find(plan().patch.devices, slot->name, &patch::PatchDevice::name) !=
                                     plan().patch.devices.end();
            const std::string told = fmt::format(
                "{} = {:.4g} N/mm is felt as {:.4g} N/mm, but device '{}' states that it can be {:.4g} "
                "N/mm stiff; ",
                spring.name, param.value * 1e-3, param.value * spring.scale * 1e-3, info.name,
                info.max_stiffness * 1e-3);
            if (is_declared) throw Error(spring.where, told + fmt::format("lower it to {:.4g} N/mm", most * 1e-3));
            std::vector<std::string>& notices = context_.host.notices;
            const std::string notice = told + fmt::format("it is lowered to {:.4g} N/mm", most * 1e-3);
            if (std::ranges::find(notices, notice) == notices.end()) notices.push_back(notice);
        }
        param.max = std::max(param.min, std::min(param.max, most));
        param.value = std::min(param.value, param.max);
    }
}

}  // namespace tactus::build
