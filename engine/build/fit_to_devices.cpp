// SPDX-License-Identifier: Apache-2.0
// A patch on the devices that are there: no force larger and no contact stiffer than they can be.
#include "devices/haptic/catalogue.hpp"
#include "engine/build/generation_builder.hpp"
#include "graph/analyse/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tactus::build {

namespace {

/// Of the devices that a node drives and a hand feels, the one with the least of what `stated` returns; 0 counts as none.
/// Null: it drives none.
template <class Stated>
const io::DeviceSlot* min_driven(const LiveNode& node, Stated&& stated) {
    const auto value = [&](const io::DeviceSlot& slot) {
        const double least = stated(slot.port.info);
        return least > 0.0 ? least : HUGE_VAL;
    };
    const io::DeviceSlot* found = nullptr;
    for (const auto& [slot, use] : node.uses.devices)
        if (use == DeviceUse::drive && !slot->port.info.without_motors && (!found || value(*slot) < value(*found)))
            found = slot;
    return found;
}

const io::DeviceSlot* softest_driven(const LiveNode& node) {
    return min_driven(node, [](const DeviceInfo& info) { return info.max_stiffness; });
}

/// Of the largest stable stiffness: measured limits are up to 20 % below the formula's.
constexpr double stable_share = 0.8;

}  // namespace

/// True if the patch declares the device; false for one that only the command line names
/// (`--set hand.device=touch`).
bool GenerationBuilder::is_declared(const io::DeviceSlot& slot) {
    return std::ranges::find(plan().patch.devices, slot.name, &patch::PatchDevice::name) != plan().patch.devices.end();
}

/// Hardware that the patch does not declare.
bool GenerationBuilder::is_unknown(const io::DeviceSlot& slot) {
    return !is_declared(slot) && haptic::is_real_driver(slot.name);
}

void GenerationBuilder::fit_to_devices() {
    if (std::ranges::none_of(made_->nodes, [](const auto& node) { return softest_driven(*node) != nullptr; })) return;
    scale_forces();
    limit_stiffness();
}

/// A tool with a `device_scale` that nobody has set uses the full range of hardware that the patch does not declare:
/// the patch's largest force is then the device's.
void GenerationBuilder::scale_forces() {
    for (const analyse::FeltSpring& spring : analyse::felt_springs(plan())) {
        const auto n = static_cast<std::size_t>(spring.node);
        const compile::ScheduleNode& tool = plan().nodes[n];
        const auto scale = tool.params.find("device_scale");
        if (scale == tool.params.end() || std::ranges::find(plan().patch.nodes[n].settings, "device_scale",
                                                            &OptionText::name) != plan().patch.nodes[n].settings.end())
            continue;
        const LiveNode& sink = *made_->nodes[static_cast<std::size_t>(spring.sink)];
        const io::DeviceSlot* const slot = min_driven(sink, [](const DeviceInfo& info) { return info.max_force; });
        const auto most = plan().nodes[static_cast<std::size_t>(spring.sink)].params.find("max_force");
        if (!slot || !is_unknown(*slot) || most == plan().nodes[static_cast<std::size_t>(spring.sink)].params.end())
            continue;
        const double wanted = most->second->value, stated = slot->port.info.max_force;
        if (!(stated > 0.0 && stated < wanted)) continue;
        Param& param = *scale->second;
        param.value = std::max(param.min, stated / wanted);
        context_.host.notify(
            fmt::format("{}.device_scale = {:.3g}: device '{}' gives at most {:.3g} N, the patch up to {:.3g} N; the "
                        "tool cuts as with all of its force (--device-scale chooses another scale)",
                        tool.name, param.value, slot->port.info.name, stated, wanted));
    }
}

/// The range of each stiffness ends at what its device states, so that wires are clamped and `set` is refused. A value that
/// is larger already is an error if the patch declares the device; otherwise it is lowered, on hardware also to what stays
/// stable. After the devices are open, and before other nodes are prepared.
void GenerationBuilder::limit_stiffness() {
    const auto device_of = [this](const std::string& name) {
        // A node that names no device means the only one.
        const io::DeviceSlot* found = nullptr;
        for (const auto& node : made_->nodes)
            for (const auto& [slot, use] : node->uses.devices)
                if (name.empty() || slot->name == name) found = slot;
        return found ? found->port.info : DeviceInfo{};
    };
    const std::vector<analyse::ForceLoop> loops = analyse::force_loops(plan(), device_of);
    for (const analyse::FeltSpring& spring : analyse::felt_springs(plan())) {
        const LiveNode& sink = *made_->nodes[static_cast<std::size_t>(spring.sink)];
        const io::DeviceSlot* const slot = softest_driven(sink);
        // 'check' shows a patch on its own devices as it is.
        if (!slot || (context_.only_checked && is_declared(*slot))) continue;
        const DeviceInfo& info = slot->port.info;
        const double stated = info.max_stiffness > 0.0 ? info.max_stiffness : HUGE_VAL;
        double felt = stated;
        if (is_unknown(*slot))
            for (const analyse::ForceLoop& loop : loops)
                if (loop.to == sink.name) felt = std::min(felt, stable_share * loop.limit);
        if (felt == HUGE_VAL) continue;
        Param& param = *spring.param;
        const double max_stiffness = felt / spring.scale;
        if (!spring.is_driven && param.value > max_stiffness * (1.0 + 1e-9)) {
            const std::string text =
                fmt::format("{} = {:.4g} N/mm is felt as {:.4g} N/mm, but device '{}' {} {:.4g} N/mm{}; ", spring.name,
                            param.value * 1e-3, param.value * spring.scale * 1e-3, info.name,
                            felt < stated ? "is stable up to" : "states that it can be", felt * 1e-3,
                            felt < stated ? "" : " stiff");
            if (is_declared(*slot))
                throw Error(spring.where, text + fmt::format("lower it to {:.4g} N/mm", max_stiffness * 1e-3));
            context_.host.notify(text + fmt::format("it is lowered to {:.4g} N/mm", max_stiffness * 1e-3));
        }
        param.max = std::max(param.min, std::min(param.max, max_stiffness));
        param.value = std::min(param.value, param.max);
    }
}

}  // namespace tactus::build
