// SPDX-License-Identifier: Apache-2.0
// Which node of the patch a file is for.
#include "dsp/core/lower.hpp"
#include "tools/window/document/workbench.hpp"

#include "tools/window/document/start_list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

/// A parameter of a node that takes the file, and the asset that it names now.
struct Taker {
    std::string node, param, asset;
    bool is_required;
};

std::vector<Taker> takers_of(const patch::Patch& patch, const std::string& file) {
    const std::string name = lower(file);
    std::vector<Taker> all;
    for (const patch::PatchNode& node : patch.nodes) {
        const TypePorts* ports = ports_of_type(node.type);
        if (!ports) continue;
        for (const TypePorts::File& file_of : ports->files) {
            const std::vector<std::string> endings = endings_of_asset(file_of.type);
            if (std::ranges::none_of(endings, [&](const std::string& ending) { return name.ends_with(ending); }))
                continue;
            const auto setting = std::ranges::find(node.settings, file_of.name, &OptionText::name);
            all.push_back({node.name, file_of.name, setting == node.settings.end() ? "" : setting->text,
                           std::ranges::find(ports->assets, file_of.name) != ports->assets.end()});
        }
    }
    return all;
}

}  // namespace

std::string Workbench::take_file(const fs::path& file, const std::string& node, std::optional<Point> at) {
    const std::string name = file.filename().string();
    const std::vector<Taker> takers = takers_of(written_, name);
    for (const Taker& taker : takers)
        if (taker.node == node) return use_file(node, taker.param, file) ? node : "";
    for (const Taker& taker : takers)
        if (taker.is_required && taker.asset.empty()) return use_file(taker.node, taker.param, file) ? taker.node : "";
    std::set<std::string> assets, nodes;
    for (const Taker& taker : takers)
        if (!taker.asset.empty()) {
            assets.insert(taker.asset);
            nodes.insert(taker.node);
        }
    if (assets.size() == 1) return replace_asset(*assets.begin(), file) ? *nodes.begin() : "";
    if (assets.size() > 1) {
        tell(fmt::format("{}: drop it on the node that takes it: {}", name, fmt::join(nodes, ", ")), true);
        return {};
    }
    const FileKind kind = kind_of_file(file);
    const auto add = [&](const char* type, const char* param) {
        const std::string lane = lane_for(type);
        std::optional<patch::PatchPlace> place;
        if (at) place = place_for(picture_, lane, *at);
        return add_node(type, lane, place, {}, {}, NodeFile{param, file});
    };
    if (kind == FileKind::sound) return add("player", "sound");
    if (kind == FileKind::bone) return add("body", "bone");
    tell(fmt::format("{}: no node of this patch takes such a file", file.string()), true);
    return {};
}

}  // namespace tactus::window
