// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/patch_steady.hpp"

#include "dsp/core/units.hpp"
#include "graph/compile/patch_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

namespace {

const std::string load_name = "steady_load", set_name = "steady_set", out_name = "steady_out",
                  drive_name = "steady_drive";

const patch::PatchNode* only_node(const patch::Patch& patch, std::string_view type) {
    const patch::PatchNode* found = nullptr;
    for (const patch::PatchNode& node : patch.nodes) {
        if (node.type != type) continue;
        if (found) return nullptr;
        found = &node;
    }
    return found;
}

const OptionText* setting(const patch::PatchNode& node, std::string_view name) {
    const auto found = std::ranges::find(node.settings, name, &OptionText::name);
    return found == node.settings.end() ? nullptr : &*found;
}

/// The output that is recorded to that file name; empty: none.
std::string recorded_as(const patch::Patch& patch, std::string_view file) {
    for (const patch::PatchNode& node : patch.nodes) {
        const OptionText* name = node.type == "record" ? setting(node, "file") : nullptr;
        if (!name || name->text != file) continue;
        for (const patch::PatchWire& wire : patch.wires)
            if (wire.to_node == node.name) return wire.from_node + "." + wire.from_port;
    }
    return {};
}

}  // namespace

SawPath find_saw_path(const patch::Patch& patch, const std::string& saw, const std::string& out,
                      compile::Catalogue catalogue) {
    const SourceLocation where{patch.file.string(), 0, 0};
    SawPath path{saw, out, {}};
    if (saw.empty()) {
        const patch::PatchNode* found = only_node(patch, "saw");
        if (!found)
            throw Error(where, "the patch does not have exactly one node of type 'saw'; choose one with --saw NODE");
        path.saw = found->name;
    } else if (const auto named = std::ranges::find(patch.nodes, saw, &patch::PatchNode::name);
               named == patch.nodes.end() || named->type != "saw") {
        throw Error(SourceLocation{"--saw " + saw, 0, 0}, "there is no node of type 'saw' with this name");
    }
    const patch::PatchNode* actuator = only_node(patch, "actuator");
    if (out.empty()) path.out = recorded_as(patch, "handle.wav");
    if (path.out.empty() && actuator) path.out = actuator->name + ".signal";
    if (path.out.empty())
        throw Error(where,
                    "no port is recorded as handle.wav and the number of actuators is not one; name the port of the "
                    "handle's vibration with --out NODE.PORT");
    if (compile::find_signal(patch, path.out, "--out", catalogue).is_input)
        throw Error(SourceLocation{"--out " + path.out, 0, 0}, "this is an input; name an output");
    if (actuator) path.drive = actuator->name + ".voltage";
    return path;
}

SteadyPatch steady_patch(const patch::Patch& patch, const SawPath& path, const SteadySaw& steady,
                         compile::Catalogue catalogue) {
    const SourceLocation where{patch.file.string(), 0, 0};
    SteadyPatch made{patch, out_name + ".wav", {}};
    patch::Patch& p = made.patch;
    patch::PatchNode& saw = *std::ranges::find(p.nodes, path.saw, &patch::PatchNode::name);
    std::erase_if(p.wires, [&](const patch::PatchWire& wire) {
        return wire.to_node == path.saw &&
               (wire.to_port == "load" || wire.to_port == "trigger" || wire.to_port == "blade_rate");
    });
    const OptionText* given = setting(saw, "gain");
    const double gain = steady.gain * (given ? parse_as(given->text, "") : 1.0);
    const auto put = [&](const std::string& name, std::string text) {
        std::erase_if(saw.settings, [&](const OptionText& option) { return option.name == name; });
        saw.settings.push_back({name, std::move(text), where});
    };
    put("blade_rate", fmt::format("{:.17g} Hz", steady.rate));
    put("gain", fmt::format("{:.17g}", gain));
    put("saw", set_name);
    p.assets.push_back({set_name, std::filesystem::absolute(steady.recordings), where});

    patch::PatchNode load{load_name, "constant", "1 kHz", "", where, where, where, {}};
    load.settings.push_back({"number", fmt::format("{:.17g}", steady.load), where});
    p.wires.push_back({load_name, "value", path.saw, "load", patch::WireMode::hold, false, 0, where});
    p.nodes.push_back(std::move(load));
    std::vector<std::string> recorders{out_name};
    const auto record = [&](const std::string& name, const std::string& from) {
        const compile::SignalEnd end = compile::find_signal(patch, from, "--out", catalogue);
        p.nodes.push_back({name, "record", end.node->rate, end.node->group, where, where, where, {}});
        p.wires.push_back({end.node->name, end.port, name, "in", patch::WireMode::hold, false, 0, where});
    };
    record(out_name, path.out);
    if (!path.drive.empty()) {
        record(drive_name, path.drive);
        recorders.push_back(drive_name);
        made.drive_file = drive_name + ".wav";
    }
    compile::keep_what_leads_to(recorders, p);
    if (std::ranges::find(p.nodes, path.saw, &patch::PatchNode::name) == p.nodes.end())
        throw Error(where, fmt::format("no wires lead from '{}' to '{}'", path.saw, path.out));
    return made;
}

}  // namespace tactus::analysis
