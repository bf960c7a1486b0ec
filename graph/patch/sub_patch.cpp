// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/sub_patch.hpp"

#include "graph/patch/flat_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace tactus::patch {

namespace fs = std::filesystem;

namespace {

// A chain of sixteen files, each of which uses the next twice, would give 65,536 nodes.
constexpr std::size_t max_nodes = 100'000, max_deep = 16;

template <class Item>
std::unordered_set<std::string_view> name_set(const std::vector<Item>& items) {
    std::unordered_set<std::string_view> names;
    for (const Item& item : items) names.insert(item.name);
    return names;
}

std::vector<std::string> names_of(const std::vector<PatchEnd>& ends) {
    std::vector<std::string> names;
    for (const PatchEnd& end : ends) names.push_back(end.name);
    return names;
}

class Flattener {
public:
    Flattener(const Patch& outermost, Problems& problems) : outermost_(outermost), problems_(problems) {
        for (const PatchPart& part : outermost.parts) texts_.emplace(part.path, &part.text);
    }

    /// `path` is that of the sub-patch `patch`, empty for the outermost patch.
    void flatten(Patch& patch, const std::string& path) {
        deep_.push_back(path);
        std::vector<PatchNode> nodes = std::exchange(patch.nodes, {});
        OuterWires wires(std::exchange(patch.wires, {}), nodes);
        std::unordered_set<std::string> devices, actuators;
        for (const PatchDevice& device : patch.devices) devices.insert(device.name);
        for (const PatchActuator& actuator : patch.actuators) actuators.insert(actuator.name);
        for (PatchNode& node : nodes) {
            if (!is_sub_patch(node)) patch.nodes.push_back(std::move(node));
            else if (const FlatPart* within = part(node, path)) {
                splice(patch, node, *within, wires);
                for (const PatchDevice& device : within->patch.devices)
                    if (devices.insert(device.name).second) patch.devices.push_back(device);
                for (const PatchActuator& actuator : within->patch.actuators)
                    if (actuators.insert(actuator.name).second) patch.actuators.push_back(actuator);
            }
            if (patch.nodes.size() > max_nodes && !has_stopped_) {
                has_stopped_ = true;
                problems_.add(nodes.front().where, fmt::format("more than {} nodes within each other", max_nodes));
            }
            if (has_stopped_) break;
        }
        std::vector<PatchWire> joined = wires.joined();
        std::ranges::move(patch.wires, std::back_inserter(joined));
        patch.wires = std::move(joined);
        deep_.pop_back();
    }

private:
    /// The sub-patch that `node` is, flattened; null after an error.
    const FlatPart* part(const PatchNode& node, const std::string& from) {
        if (node.type.size() == sub_patch_prefix.size()) {
            problems_.add(node.type_where, "name the file: type = \"patch:voice.toml\"");
            return nullptr;
        }
        const std::string path = part_path(from, node.type);
        if (std::ranges::find(deep_, path) != deep_.end() ||
            file_of_part(outermost_, path).lexically_normal() == outermost_.file.lexically_normal()) {
            std::string chain;
            for (const std::string& name : deep_)
                chain += (name.empty() ? outermost_.file.filename().string() : name) + " -> ";
            problems_.add(node.type_where, fmt::format("a patch within itself: {}{}", chain, path));
            return nullptr;
        }
        if (deep_.size() > max_deep) {
            problems_.add(node.type_where, fmt::format("more than {} patches within each other", max_deep));
            return nullptr;
        }
        if (const auto known = flat_.find(path); known != flat_.end()) return known->second.get();
        std::unique_ptr<FlatPart>& flat = flat_[path];
        const auto text = texts_.find(path);
        if (text == texts_.end()) {
            problems_.add(node.type_where, fmt::format("there is no patch {} that can be read",
                                                       file_of_part(outermost_, path).string()));
            return nullptr;
        }
        const std::size_t earlier = problems_.list.size();
        Patch read = read_patch(*text->second, file_of_part(outermost_, path), problems_);
        if (problems_.list.size() == earlier) check_offers(read);
        if (problems_.list.size() == earlier) flatten(read, path);
        if (problems_.list.size() > earlier) return nullptr;
        flat = std::make_unique<FlatPart>(std::move(read));
        return flat.get();
    }

    void check_offers(const Patch& read) {
        const auto nodes = name_set(read.nodes), parameters = name_set(read.parameters);
        for (const auto* ends : {&read.inputs, &read.outputs, &read.parameters})
            for (const PatchEnd& end : *ends)
                if (!nodes.contains(end.node)) {
                    std::vector<std::string> names;
                    if (problems_.wants_hint())
                        for (const PatchNode& node : read.nodes) names.push_back(node.name);
                    problems_.add(end.where, fmt::format("no node '{}'{}", end.node, did_you_mean(end.node, names)));
                }
        for (const PatchEnd& input : read.inputs)
            if (parameters.contains(input.name))
                problems_.add(input.where, fmt::format("'{}' is an input and a parameter; a wire could not tell them "
                                                       "apart",
                                                       input.name));
    }

    void splice(Patch& patch, const PatchNode& node, const FlatPart& part, OuterWires& wires) {
        const Patch& within = part.patch;
        const std::string prefix = node.name + within_node;
        const auto named = [&prefix](std::string& name) { name.insert(0, prefix); };
        const std::size_t first = patch.nodes.size();
        bool takes_rate = false;
        for (const PatchNode& inner : within.nodes) {
            PatchNode& made = patch.nodes.emplace_back(inner);
            named(made.name);
            if (!made.group.empty()) named(made.group);
            if (made.rate == outer_rate) {
                takes_rate = true;
                made.rate = node.rate;
                made.group = node.group;
                made.rate_where = node.rate_where;
                if (made.rate.empty() && made.group.empty())
                    return problems_.add(node.where,
                                         fmt::format("node '{}' needs a 'rate' or a 'group', for '{}' of {}", node.name,
                                                     inner.name, within.file.filename().string()));
            }
            for (OptionText& setting : made.settings) named(setting.scope);
        }
        if (!takes_rate && !(node.rate.empty() && node.group.empty()))
            problems_.add(node.rate_where, fmt::format("all nodes of {} have a rate of their own; leave this one out",
                                                       within.file.filename().string()));
        for (const OptionText& setting : node.settings) set(patch, first, part, setting);
        for (PatchGroup group : within.groups) named((patch.groups.emplace_back(std::move(group))).name);
        for (PatchAsset asset : within.assets) named((patch.assets.emplace_back(std::move(asset))).name);
        connect(wires, node, part);
        for (PatchWire wire : within.wires) {
            named(wire.from_node);
            named(wire.to_node);
            patch.wires.push_back(std::move(wire));
        }
        for (PatchEnd end : within.offered) {
            named(end.name);
            named(end.node);
            patch.offered.push_back(std::move(end));
        }
        for (const auto* ends : {&within.inputs, &within.outputs, &within.parameters})
            for (const PatchEnd& end : *ends)
                for (const NamedEnd& inner : all_within(part, end))
                    patch.offered.push_back({node.name + '.' + end.name, prefix + inner.node, inner.name, end.where});
    }

    /// Sets the inner parameters that a parameter of a sub-patch controls. Its nodes begin at `first` in `patch`.
    void set(Patch& patch, std::size_t first, const FlatPart& part, const OptionText& given) {
        const FlatPart::Ends& parameters = FlatPart::find(part.parameters, given.name);
        for (const PatchEnd* parameter : parameters)
            for (const NamedEnd& inner : all_within(part, *parameter)) {
                const auto at = part.nodes.find(inner.node);
                if (at == part.nodes.end()) continue;
                auto& settings = patch.nodes[first + at->second].settings;
                std::erase_if(settings, [&](const OptionText& old) { return old.name == inner.name; });
                settings.push_back({inner.name, given.text, given.where, given.scope});
            }
        if (parameters.empty())
            problems_.add(given.where, fmt::format("{} offers no parameter '{}'{}", part.file(), given.name,
                                                   hint(given.name, {&part.patch.parameters})));
    }

    std::string hint(const std::string& name, std::initializer_list<const std::vector<PatchEnd>*> ends) const {
        std::vector<std::string> names;
        if (problems_.wants_hint())
            for (const auto* some : ends) std::ranges::copy(names_of(*some), std::back_inserter(names));
        return did_you_mean(name, names);
    }

    /// The end itself, or all ends that it means when its node is a sub-patch; `ends_within` by the index of the part.
    static std::vector<NamedEnd> all_within(const FlatPart& part, const PatchEnd& end) {
        std::vector<NamedEnd> all;
        for (const PatchEnd* deeper : FlatPart::find(part.offered, end.node + '.' + end.port))
            all.push_back({deeper->node, deeper->port});
        if (all.empty()) all.push_back({end.node, end.port});
        return all;
    }

    /// Joins the wires at the sub-patch `node` to the ports inside.
    void connect(OuterWires& wires, const PatchNode& node, const FlatPart& part) {
        wires.at(node.name, [&](std::vector<PatchWire>& pieces) {
            std::vector<PatchWire> led;
            for (PatchWire& wire : pieces)
                if (lead_source(wire, node, part)) lead_target(std::move(wire), node, part, led);
            pieces = std::move(led);
        });
    }

    /// False after an error.
    bool lead_source(PatchWire& wire, const PatchNode& node, const FlatPart& part) {
        if (wire.from_node != node.name || wire.from_port.empty()) return true;
        const FlatPart::Ends& ends = FlatPart::find(part.outputs, wire.from_port);
        if (ends.empty()) {
            problems_.add(wire.where, fmt::format("{} offers no output '{}'{}", part.file(), wire.from_port,
                                                  hint(wire.from_port, {&part.patch.outputs})));
            return false;
        }
        const NamedEnd inner = all_within(part, *ends.front()).front();  // an output is one port
        wire.from_node = node.name + within_node + inner.node;
        wire.from_port = inner.name;
        return true;
    }

    void lead_target(PatchWire wire, const PatchNode& node, const FlatPart& part, std::vector<PatchWire>& led) {
        if (wire.to_node != node.name) return led.push_back(std::move(wire));
        const FlatPart::Ends& ends = FlatPart::find(part.targets, wire.to_port);
        for (const PatchEnd* end : ends)
            for (const NamedEnd& inner : all_within(part, *end)) {
                PatchWire& made = led.emplace_back(wire);
                made.to_node = node.name + within_node + inner.node;
                made.to_port = inner.name;
            }
        if (ends.empty())
            problems_.add(wire.where, fmt::format("{} offers no input '{}'{}", part.file(), wire.to_port,
                                                  hint(wire.to_port, {&part.patch.inputs, &part.patch.parameters})));
    }

    const Patch& outermost_;
    Problems& problems_;
    std::vector<std::string> deep_;  ///< sub-patches that are being flattened, outermost first
    std::unordered_map<std::string_view, const std::string*> texts_;  ///< of sub-patches, by path
    std::unordered_map<std::string, std::unique_ptr<FlatPart>> flat_;
    bool has_stopped_ = false;
};

/// A TOML string that reads back to the same bytes and has as many lines.
std::string toml_text(std::string_view text) {
    std::string out = "\"\"\"\n";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\\' || c == '"') (out += '\\') += c;
        else if (c == '\n' || c == '\t') out += c;
        else if (byte < 0x20 || byte == 0x7f) out += fmt::format("\\u{:04X}", byte);
        else out += c;
    }
    return out + "\"\"\"\n";
}

}  // namespace

std::string part_path(const std::string& from, const std::string& type) {
    const fs::path named = type.substr(sub_patch_prefix.size());
    return (fs::path(from).parent_path() / named).lexically_normal().generic_string();
}

fs::path file_of_part(const Patch& patch, const std::string& path) { return patch.file.parent_path() / path; }

bool is_sub_patch(const PatchNode& node) { return node.type.starts_with(sub_patch_prefix); }

std::vector<fs::path> part_files(const Patch& patch) {
    std::vector<fs::path> files;
    for (const PatchPart& part : patch.parts) files.push_back(file_of_part(patch, part.path));
    return files;
}

void flatten(Patch& patch, Problems& problems) {
    if (std::ranges::any_of(patch.nodes, is_sub_patch)) {
        const Patch outermost = patch;
        Flattener(outermost, problems).flatten(patch, "");
    }
    for (const PatchNode& node : patch.nodes)
        if (node.rate == outer_rate)
            problems.add(node.rate_where,
                         "rate = \"outer\" is that of a node which is this patch; on its own it has none");
}

std::string bundle_text(const Patch& patch) {
    std::string text = patch.text;
    for (const PatchPart& part : patch.parts)
        text += fmt::format("\n[[parts]]\npath = {}text = {}", toml_text(part.path), toml_text(part.text));
    return text;
}

std::vector<NamedEnd> ends_within(const Patch& patch, std::string_view node, std::string_view name) {
    const std::string wanted = fmt::format("{}.{}", node, name);
    std::vector<NamedEnd> all;
    for (const PatchEnd& end : patch.offered)
        if (end.name == wanted) all.push_back({end.node, end.port});
    if (all.empty()) all.push_back({std::string(node), std::string(name)});
    return all;
}

}  // namespace tactus::patch
