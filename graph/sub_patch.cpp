// SPDX-License-Identifier: Apache-2.0
#include "graph/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace tactus {

namespace fs = std::filesystem;

namespace {

// A patch that names itself twice, sixteen deep, would have 65,536 nodes.
constexpr std::size_t most_nodes = 100'000, most_deep = 16;

template <class Item>
bool has(const std::vector<Item>& items, const std::string& name) {
    return std::ranges::find(items, name, &Item::name) != items.end();
}

std::vector<std::string> names_of(const std::vector<PatchEnd>& ends) {
    std::vector<std::string> names;
    for (const PatchEnd& end : ends) names.push_back(end.name);
    return names;
}

class Flattener {
public:
    Flattener(const Patch& outermost, Problems& problems) : outermost_(outermost), problems_(problems) {}

    /// `path`: the part that `patch` was read from, empty for the outermost.
    void flatten(Patch& patch, const std::string& path) {
        deep_.push_back(path);
        std::vector<PatchNode> nodes = std::exchange(patch.nodes, {});
        for (PatchNode& node : nodes) {
            if (!is_sub_patch(node)) patch.nodes.push_back(std::move(node));
            else if (const Patch* within = part(node, path)) splice(patch, node, *within);
            if (patch.nodes.size() > most_nodes && !has_stopped_) {
                has_stopped_ = true;
                problems_.add(nodes.front().where, fmt::format("more than {} nodes within each other", most_nodes));
            }
            if (has_stopped_) break;
        }
        deep_.pop_back();
    }

private:
    /// What `node` is, flattened; null after saying what is wrong.
    const Patch* part(const PatchNode& node, const std::string& from) {
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
        if (deep_.size() > most_deep) {
            problems_.add(node.type_where, fmt::format("more than {} patches within each other", most_deep));
            return nullptr;
        }
        if (const auto known = flat_.find(path); known != flat_.end()) return known->second ? &*known->second : nullptr;
        std::optional<Patch>& flat = flat_[path];
        const auto text = std::ranges::find(outermost_.parts, path, &PatchPart::path);
        if (text == outermost_.parts.end()) {
            problems_.add(node.type_where, fmt::format("there is no patch {} that can be read",
                                                       file_of_part(outermost_, path).string()));
            return nullptr;
        }
        const std::size_t earlier = problems_.list.size();
        Patch read = read_patch(text->text, file_of_part(outermost_, path), problems_);
        if (problems_.list.size() == earlier) check_offers(read);
        if (problems_.list.size() == earlier) flatten(read, path);
        if (problems_.list.size() > earlier) return nullptr;
        flat = std::move(read);
        return &*flat;
    }

    void check_offers(const Patch& read) {
        for (const auto* ends : {&read.inputs, &read.outputs, &read.parameters})
            for (const PatchEnd& end : *ends)
                if (!has(read.nodes, end.node)) {
                    std::vector<std::string> names;
                    for (const PatchNode& node : read.nodes) names.push_back(node.name);
                    problems_.add(end.where, fmt::format("no node '{}'{}", end.node, did_you_mean(end.node, names)));
                }
        for (const PatchEnd& input : read.inputs)
            if (has(read.parameters, input.name))
                problems_.add(input.where, fmt::format("'{}' is an input and a parameter; a wire could not tell them "
                                                       "apart",
                                                       input.name));
    }

    void splice(Patch& patch, const PatchNode& node, const Patch& within) {
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
        for (const OptionText& setting : node.settings) set(patch, first, node, within, setting);
        for (PatchGroup group : within.groups) named((patch.groups.emplace_back(std::move(group))).name);
        for (PatchAsset asset : within.assets) named((patch.assets.emplace_back(std::move(asset))).name);
        for (const PatchDevice& device : within.devices)
            if (!has(patch.devices, device.name)) patch.devices.push_back(device);
        connect(patch, node, within);
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
            for (const PatchEnd& end : *ends) {
                const auto inner = resolved(within, end);
                patch.offered.push_back({node.name + '.' + end.name, prefix + inner.node, inner.name, end.where});
            }
    }

    /// What a part offers may itself be offered by a patch within it.
    static NamedEnd resolved(const Patch& within, const PatchEnd& end) {
        return end_within(within, end.node, end.port);
    }

    void set(Patch& patch, std::size_t first, const PatchNode& node, const Patch& within, const OptionText& given) {
        bool is_known = false;
        for (const PatchEnd& parameter : within.parameters) {
            if (parameter.name != given.name) continue;
            is_known = true;
            for (const NamedEnd& inner : all_within(within, parameter)) {
                const std::string name = node.name + within_node + inner.node;
                for (std::size_t n = first; n < patch.nodes.size(); ++n) {
                    if (patch.nodes[n].name != name) continue;
                    auto& settings = patch.nodes[n].settings;
                    std::erase_if(settings, [&](const OptionText& old) { return old.name == inner.name; });
                    settings.push_back({inner.name, given.text, given.where, given.scope});
                }
            }
        }
        if (is_known) return;
        const auto names = names_of(within.parameters);
        problems_.add(given.where, fmt::format("{} offers no parameter '{}'{}", within.file.filename().string(),
                                               given.name, did_you_mean(given.name, names)));
    }

    /// One end, or all that a patch within puts behind it.
    static std::vector<NamedEnd> all_within(const Patch& within, const PatchEnd& end) {
        std::vector<NamedEnd> all;
        for (const PatchEnd& deeper : within.offered)
            if (deeper.name == end.node + '.' + end.port) all.push_back({deeper.node, deeper.port});
        if (all.empty()) all.push_back({end.node, end.port});
        return all;
    }

    /// Leads the wires of `patch` that begin or end at `node` to what is behind its ports.
    void connect(Patch& patch, const PatchNode& node, const Patch& within) {
        const std::string prefix = node.name + within_node, file = within.file.filename().string();
        std::vector<PatchWire> wires;
        for (PatchWire& wire : patch.wires) {
            if (wire.from_node == node.name && !wire.from_port.empty()) {
                const auto end = std::ranges::find(within.outputs, wire.from_port, &PatchEnd::name);
                if (end == within.outputs.end()) {
                    problems_.add(wire.where, fmt::format("{} offers no output '{}'{}", file, wire.from_port,
                                                          did_you_mean(wire.from_port, names_of(within.outputs))));
                    continue;
                }
                const NamedEnd inner = resolved(within, *end);
                wire.from_node = prefix + inner.node;
                wire.from_port = inner.name;
            }
            if (wire.to_node != node.name) {
                wires.push_back(std::move(wire));
                continue;
            }
            bool is_known = false;
            for (const auto* ends : {&within.inputs, &within.parameters})
                for (const PatchEnd& end : *ends) {
                    if (end.name != wire.to_port) continue;
                    is_known = true;
                    for (const NamedEnd& inner : all_within(within, end)) {
                        PatchWire& made = wires.emplace_back(wire);
                        made.to_node = prefix + inner.node;
                        made.to_port = inner.name;
                    }
                }
            if (is_known) continue;
            std::vector<std::string> names = names_of(within.inputs);
            std::ranges::copy(names_of(within.parameters), std::back_inserter(names));
            problems_.add(wire.where, fmt::format("{} offers no input '{}'{}", file, wire.to_port,
                                                  did_you_mean(wire.to_port, names)));
        }
        patch.wires = std::move(wires);
    }

    const Patch& outermost_;
    Problems& problems_;
    std::vector<std::string> deep_;  ///< parts that are being flattened, outermost first
    std::map<std::string, std::optional<Patch>> flat_;
    bool has_stopped_ = false;
};

/// A TOML text that reads back to the same bytes, on as many lines.
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

NamedEnd end_within(const Patch& patch, std::string_view node, std::string_view name) {
    const std::string wanted = fmt::format("{}.{}", node, name);
    const auto found = std::ranges::find(patch.offered, wanted, &PatchEnd::name);
    if (found != patch.offered.end()) return {found->node, found->port};
    return {std::string(node), std::string(name)};
}

}  // namespace tactus
