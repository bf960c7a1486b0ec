// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/patch_measure.hpp"

#include "graph/compile/patch_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

namespace {

const std::string sweep_name = "measure_sweep", record_name = "measure_record";

}  // namespace

MeasuredPatch measured_patch(const patch::Patch& patch, const MeasuredPath& path, compile::Catalogue catalogue) {
    const compile::SignalEnd in = compile::find_signal(patch, path.in, "--in", catalogue),
                             out = compile::find_signal(patch, path.out, "--out", catalogue);
    const SourceLocation where{fmt::format("--in {} --out {}", path.in, path.out), 0, 0};
    if (out.is_input) throw Error(where, fmt::format("'{}' is an input; --out must be an output", path.out));
    if (in.node->group != out.node->group ||
        (in.node->group.empty() && patch::parse_rate(in.node->rate) != patch::parse_rate(out.node->rate)))
        throw Error(where, "both ends must run at one rate, in one group");

    MeasuredPatch made{patch, in.node->rate, in.unit, out.unit, record_name + ".wav"};
    patch::Patch& measured = made.patch;
    if (!in.node->group.empty()) {
        const auto group = std::ranges::find(patch.groups, in.node->group, &patch::PatchGroup::name);
        if (group != patch.groups.end()) made.rate = group->rate;
    }
    patch::PatchNode sweep{sweep_name, "sweep", in.node->rate, in.node->group, where, where, where, path.sweep};
    patch::PatchNode record{record_name, "record", in.node->rate, in.node->group, where, where, where, {}};
    if (in.is_input) {
        std::erase_if(measured.wires,
                      [&](const patch::PatchWire& w) { return w.to_node == in.node->name && w.to_port == in.port; });
        measured.wires.push_back(
            {sweep_name, "signal", in.node->name, in.port, patch::WireMode::hold, false, 0, where});
    } else {
        for (patch::PatchWire& wire : measured.wires)
            if (wire.from_node == in.node->name && wire.from_port == in.port)
                wire.from_node = sweep_name, wire.from_port = "signal";
    }
    measured.wires.push_back({out.node->name, out.port, record_name, "in", patch::WireMode::hold, false, 0, where});
    measured.nodes.push_back(std::move(sweep));
    measured.nodes.push_back(std::move(record));
    compile::keep_what_leads_to({record_name}, measured);
    if (std::ranges::find(measured.nodes, sweep_name, &patch::PatchNode::name) == measured.nodes.end())
        throw Error(where, fmt::format("no wires lead from '{}' to '{}'", path.in, path.out));
    return made;
}

}  // namespace tactus::analysis
