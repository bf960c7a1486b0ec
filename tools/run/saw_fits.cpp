// SPDX-License-Identifier: Apache-2.0
#include "tools/run/saw_fits.hpp"

#include "assets/bone/bone.hpp"
#include "assets/training/task_file.hpp"
#include "dsp/carve/kerf_voxels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tactus::run {

namespace {

constexpr double slack = 1e-3;  // as a share: a size that was rounded

double value(const compile::ScheduleNode& node, const char* name) {
    const auto found = node.params.find(name);
    return found != node.params.end() ? found->second->value : 0.0;
}

bool is(const compile::ScheduleNode& node, std::string_view type) { return node.type && node.type->name == type; }

template <class T>
const T* asset(const compile::ScheduleNode& node, std::string_view type) {
    for (const AssetParam* param : node.assets)
        if (param->type_name == type && param->loaded) return static_cast<const T*>(param->loaded.get());
    return nullptr;
}

bool differ(double a, double b) { return std::abs(a - b) > slack * std::max(a, b); }

void check_task(const compile::ScheduleNode& task, const compile::ScheduleNode& blade, patch::Problems& problems) {
    const auto* const said = asset<training::Task>(task, "task");
    if (!said) return;
    const std::pair<const char*, double> sizes[] = {{"length", said->blade.length},
                                                    {"height", said->blade.height},
                                                    {"kerf", said->blade.kerf},
                                                    {"stroke", said->blade.stroke}};
    for (const auto& [name, wanted] : sizes) {
        const double has = value(blade, name);
        if (differ(has, wanted))
            problems.add(blade.where,
                         fmt::format("the blade '{}' has a {} of {:.4g} mm, but the task '{}' is for one of "
                                     "{:.4g} mm; set {}.{}, or [blade] in {}",
                                     blade.name, name, has * 1e3, said->title, wanted * 1e3, blade.name, name,
                                     said->file.string()));
    }
}

void check_bone(const compile::ScheduleNode& carve, patch::Problems& problems) {
    const auto* const cut = asset<bone::Bone>(carve, "bone");
    if (!cut) return;
    const Vec3& h = cut->distance.spacing;
    const double kerf = value(carve, "kerf"), voxels = kerf / std::max({h.x, h.y, h.z});
    if (voxels < 3.0)
        problems.add(carve.where,
                     fmt::format("the kerf of {:.3g} mm is only {:.2g} voxels wide in the bone of the task, "
                                 "which a score compares voxel by voxel; import the bone with --spacing "
                                 "{:.2g} or finer",
                                 kerf * 1e3, voxels, carve::coarsest_voxel(kerf) * 1e3));
}

}  // namespace

void check_saw(const compile::Schedule& plan, patch::Problems& problems) {
    for (const compile::ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.to_node < 0) continue;
        const compile::ScheduleNode &from = plan.nodes[static_cast<std::size_t>(wire.from_node)],
                                    &to = plan.nodes[static_cast<std::size_t>(wire.to_node)];
        const bool saw = is(from, "saw_blade"), burr = is(from, "burr");
        if ((saw || burr) && is(to, "carve")) {
            const char* const name = saw ? "kerf" : "diameter";
            const double width = value(from, name), widest = value(to, "kerf");
            if (width > widest * (1.0 + slack))
                problems.add(to.where, fmt::format("'{}' removes a kerf of {:.4g} mm, but '{}' cuts {:.4g} mm; set "
                                                   "{}.kerf to {:.4g} mm, or {}.{} to less",
                                                   to.name, widest * 1e3, from.name, width * 1e3, to.name, width * 1e3,
                                                   from.name, name));
        }
        if (saw && is(to, "kerf_heat") && differ(value(from, "stroke"), value(to, "stroke")))
            problems.add(to.where,
                         fmt::format("'{}' has a stroke of {:.4g} mm, but '{}' one of {:.4g} mm; make them "
                                     "equal",
                                     to.name, value(to, "stroke") * 1e3, from.name, value(from, "stroke") * 1e3));
    }
    const auto task = std::ranges::find_if(plan.nodes, [](const auto& node) { return is(node, "task"); });
    if (task == plan.nodes.end()) return;
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (is(node, "saw_blade")) check_task(*task, node, problems);
        if (is(node, "carve")) check_bone(node, problems);
    }
}

}  // namespace tactus::run
