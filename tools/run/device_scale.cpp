// SPDX-License-Identifier: Apache-2.0
#include "tools/run/device_scale.hpp"

#include "graph/patch/sub_patch.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

namespace tactus::run {

void choose_device_scale(PatchChoice& choice, std::optional<double> scale) {
    if (!scale) return;
    patch::Problems problems;
    patch::Patch patch = read_choice(choice, problems);
    patch::read_parts(patch);
    bool any = false;
    for (const patch::PatchNode& node : patch.nodes) {
        if (node.type != "saw_blade" && node.type != "burr") continue;
        choice.overrides.settings.push_back(fmt::format("{}.device_scale={}", node.name, *scale));
        any = true;
    }
    if (!any && problems.empty())
        throw Error(
            fmt::format("{}: --device-scale needs a saw_blade or a burr, which this patch has not", choice.patch));
}

}  // namespace tactus::run
