// SPDX-License-Identifier: Apache-2.0
#include "tools/session/limit_stiffness.hpp"

#include "graph/analyse/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::session {

void limit_stiffness(const compile::Plan& plan, const io::EngineHost& host) {
    for (const analyse::FeltSpring& spring : analyse::felt_springs(plan)) {
        const DeviceInfo* info = nullptr;
        for (const auto& slot : host.devices)
            if (!info && (spring.device.empty() || slot->name == spring.device)) info = &slot->port.info;
        if (!info || !(info->max_stiffness > 0.0)) continue;
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

}  // namespace tactus::session
