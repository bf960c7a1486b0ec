// SPDX-License-Identifier: Apache-2.0
// New nodes, several nodes at once, comments, files and devices.
#include "tools/window/document/workbench.hpp"

#include "assets/file/whole_file.hpp"
#include "graph/edit/patch_arrange.hpp"
#include "graph/edit/patch_paths.hpp"
#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/document/thing_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr const char *fast = "1 kHz", *audio = "48 kHz";

const NodeType* type_of(const std::string& name) {
    const auto all = nodes::catalogue();
    const auto found = std::ranges::find(all, name, [](const NodeType* t) { return t->name; });
    return found == all.end() ? nullptr : *found;
}

bool carries_signal(const std::string& type) {
    const TypePorts* ports = ports_of_type(type);
    const auto is_signal = [](const PicturePort& port) { return port.type == &value::signal; };
    return ports && (std::ranges::any_of(ports->inputs, is_signal) || std::ranges::any_of(ports->outputs, is_signal));
}

fs::path folder_of(const fs::path& patch) { return fs::absolute(patch).parent_path(); }

std::string asset_name_of(const fs::path& file, const patch::Patch& patch) {
    std::string name = file.stem().stem().string();
    // A letter of several bytes becomes one mark.
    std::erase_if(name, [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; });
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    if (name.empty()) name = "file";
    const std::string stem = name;
    for (int i = 2; std::ranges::find(patch.assets, name, &patch::PatchAsset::name) != patch.assets.end(); ++i)
        name = fmt::format("{}_{}", stem, i);
    return name;
}

/// A file as an entry of a patch's [assets].
struct NamedAsset {
    std::string name, path, written;  ///< written: as the patch names it, relative where it lies below the patch
    bool is_new = false;  ///< the patch does not name the file yet
};

NamedAsset asset_for(const fs::path& file, const patch::Patch& patch, const fs::path& folder) {
    const fs::path path = fs::absolute(file).lexically_normal();
    const auto known = std::ranges::find_if(patch.assets, [&](const patch::PatchAsset& asset) {
        return fs::absolute(asset.path).lexically_normal() == path;
    });
    if (known != patch.assets.end()) return {known->name, path.string(), {}, false};
    return {asset_name_of(path, patch), path.string(), edit::path_from(folder, path), true};
}

}  // namespace

std::string Workbench::free_name(const std::string& type) const {
    const auto is_taken = [&](const std::string& name) {
        return std::ranges::find(written_.nodes, name, &patch::PatchNode::name) != written_.nodes.end();
    };
    std::string name = type;
    for (int i = 2; is_taken(name); ++i) name = fmt::format("{}_{}", type, i);
    return name;
}

std::string Workbench::lane_for(const std::string& type) const {
    const bool is_audio = carries_signal(type);
    std::string best;
    for (const PictureLane& lane : picture_.lanes) {
        const auto l = static_cast<int>(&lane - picture_.lanes.data());
        const bool has_audio = std::ranges::any_of(
            picture_.nodes, [&](const PictureNode& node) { return node.group == l && carries_signal(node.type); });
        if (has_audio == is_audio && best.empty()) best = lane.name;
        if (!is_audio && lane.name == fast) best = lane.name;
    }
    return best.empty() ? is_audio ? audio : fast : best;
}

std::string Workbench::lane_for(const std::string& type, const std::string& wanted) const {
    // Groups within a sub-patch are those of its own file.
    if (wanted.empty() || wanted.find(patch::within_node) != std::string::npos) return lane_for(type);
    if (!carries_signal(type)) return wanted;
    const auto group = std::ranges::find(written_.groups, wanted, &patch::PatchGroup::name);
    try {
        const Flicks period = patch::parse_rate(group == written_.groups.end() ? wanted : group->rate);
        constexpr Flicks slowest_sound = flicks_per_second / 8000;
        return period <= slowest_sound ? wanted : lane_for(type);
    } catch (const Error&) {
        return wanted;
    }
}

std::string Workbench::add_node(const std::string& type, const std::string& lane,
                                std::optional<patch::PatchPlace> place, const std::string& from,
                                const std::string& input, const std::optional<NodeFile>& file) {
    const NodeType* known = type_of(type);
    if (!known) {
        tell(fmt::format("no node type '{}'", type), true);
        return {};
    }
    const std::string name = free_name(type);
    const bool is_group = std::ranges::find(written_.groups, lane, &patch::PatchGroup::name) != written_.groups.end();
    edit::NewNode node{name, type, is_group ? "" : lane, is_group ? lane : "", {}, {}};
    const NamedAsset asset = file ? asset_for(file->path, written_, folder_of(editor_->file())) : NamedAsset{};
    if (file) node.settings.emplace_back(file->param, asset.name);
    if (!from.empty() && !input.empty()) node.wires.push_back({from, name + "." + input, {}});
    const bool is_of_hand = known->role == NodeRole::hand_source || known->role == NodeRole::hand_sink;
    const bool needs_device = is_of_hand && written_.devices.empty();
    const auto add = [&] {
        return edit(
            [&](std::string_view text) {
                std::string changed(text);
                if (asset.is_new) changed = edit::with_asset(changed, asset.name, asset.written);
                changed = edit::with_node(changed, node);
                if (needs_device) changed = edit::with_device(changed, "simulated", "simulated");
                if (place) changed = edit::with_places(changed, {{name, *place}});
                return changed;
            },
            fmt::format("added {} of type {}", name, type));
    };
    bool made = add();
    if (!made && !node.wires.empty()) {
        node.wires.clear();
        made = add();
    }
    if (!made) return {};
    last_added_ = name;
    return name;
}

std::string Workbench::add_part(const fs::path& file, const std::string& lane, std::optional<patch::PatchPlace> place) {
    const fs::path path = fs::absolute(file).lexically_normal();
    // A file beside the patch moves with it.
    const fs::path beside = path.lexically_relative(fs::absolute(editor_->file()).parent_path());
    const bool is_beside = !is_untitled() && !beside.empty() && *beside.begin() != "..";
    patch::Patch alone;
    alone.file = editor_->file();
    patch::PatchNode& written = alone.nodes.emplace_back();
    written.type = std::string(patch::sub_patch_prefix) + (is_beside ? beside : path).generic_string();
    const auto parts = part_ports_of(alone);
    if (parts.empty()) {
        tell(fmt::format("{} is no patch that can be read", path.string()), true);
        return {};
    }
    std::string stem = path.stem().string();
    for (char& c : stem)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    edit::NewNode node{free_name(stem), written.type, {}, {}, {}, {}};
    if (parts.begin()->second.takes_rate) {
        const bool is_group =
            std::ranges::find(written_.groups, lane, &patch::PatchGroup::name) != written_.groups.end();
        (is_group ? node.group : node.rate) = lane.empty() ? fast : lane;
    }
    const bool made = edit(
        [&](std::string_view text) {
            const std::string changed = edit::with_node(text, node);
            return place ? edit::with_places(changed, {{node.name, *place}}) : changed;
        },
        fmt::format("added {}, which is {}", node.name, path.string()));
    if (!made) return {};
    last_added_ = node.name;
    return node.name;
}

bool Workbench::has_lane(const std::string& node) const {
    const auto written = std::ranges::find(written_.nodes, node, &patch::PatchNode::name);
    return written != written_.nodes.end() && !(written->rate.empty() && written->group.empty());
}

bool Workbench::move_to_lane(const std::vector<std::string>& nodes, const std::string& lane,
                             const std::map<std::string, patch::PatchPlace>& places) {
    const bool is_group = std::ranges::find(written_.groups, lane, &patch::PatchGroup::name) != written_.groups.end();
    return edit(
        [&](std::string_view text) {
            std::string changed(text);
            for (const std::string& node : nodes) changed = edit::with_lane(changed, node, lane, is_group);
            return places.empty() ? changed : edit::with_places(changed, places);
        },
        fmt::format("{} in {}", nodes.size() == 1 ? nodes.front() : count_of(nodes.size()), lane));
}

bool Workbench::remove(const std::vector<std::string>& nodes, const std::vector<std::string>& comments) {
    if (nodes.empty() && comments.empty()) return false;
    if (nodes.size() == 1 && comments.empty()) return remove(nodes.front());
    return edit(
        [&](std::string_view text) {
            std::string changed = edit::without_nodes(text, nodes);
            for (const std::string& name : comments) changed = edit::without_comment(changed, name);
            return changed;
        },
        "removed " + count_of(nodes.size(), comments.size()));
}

bool Workbench::place(const std::map<std::string, patch::PatchPlace>& places,
                      const std::vector<patch::PatchComment>& comments) {
    return edit(
        [&](std::string_view text) {
            std::string changed = edit::with_places(text, places);
            for (const patch::PatchComment& comment : comments) changed = edit::with_comment(changed, comment);
            return changed;
        },
        "moved " + count_of(places.size(), comments.size()));
}

bool Workbench::place_automatically(const std::vector<std::string>& nodes) {
    return edit([&](std::string_view text) { return edit::without_places(text, nodes); },
                fmt::format("{} stand where they would by themselves", count_of(nodes.size())));
}

bool Workbench::colour(const std::vector<std::string>& nodes, const std::string& name) {
    return edit([&](std::string_view text) { return edit::with_colours(text, nodes, name); },
                fmt::format("coloured {}", count_of(nodes.size())));
}

bool Workbench::make_sub_patch(const std::vector<std::string>& nodes, const std::string& name) {
    if (is_untitled() || run::is_of_library(editor_->file())) {
        tell("save the patch first: its sub-patch is a file beside it", true);
        return false;
    }
    const fs::path folder = fs::absolute(editor_->file()).parent_path();
    std::string file = name + ".toml";
    std::error_code ignored;
    for (int i = 2; fs::exists(folder / file, ignored); ++i) file = fmt::format("{}-{}.toml", name, i);
    bool is_written = false;
    const bool made = edit(
        [&](std::string_view text) {
            edit::SubPatch parts = edit::with_sub_patch(text, nodes, name, file, folder);
            file::write_durable_file(folder / file, parts.inner);
            is_written = true;
            return parts.outer;
        },
        fmt::format("{} are now the sub-patch {}, in {}", count_of(nodes.size()), name, (folder / file).string()));
    // Undo keeps the file: redo needs it.
    if (!made && is_written) fs::remove(folder / file, ignored);
    return made;
}

bool Workbench::open_sub_patch(const std::string& node, bool wanted) {
    std::vector<std::string> open = window_.open;
    std::erase(open, node);
    if (wanted) open.push_back(node);
    return edit([&](std::string_view text) { return edit::with_open_parts(text, open); },
                fmt::format("{} is {}", node, wanted ? "open" : "closed"));
}

bool Workbench::comment(const patch::PatchComment& comment) {
    return edit([&](std::string_view text) { return edit::with_comment(text, comment); }, "changed a comment");
}

bool Workbench::remove_comment(const std::string& name) {
    return edit([&](std::string_view text) { return edit::without_comment(text, name); }, "removed a comment");
}

std::string Workbench::add_comment(patch::PatchPlace place, const std::string& words) {
    std::string name = "note";
    for (int i = 2; std::ranges::find(window_.comments, name, &patch::PatchComment::name) != window_.comments.end();
         ++i)
        name = fmt::format("note_{}", i);
    return comment({name, words, "", place, {220.0, 80.0}}) ? name : std::string();
}

bool Workbench::use_file(const std::string& node, const std::string& param, const fs::path& file) {
    const NamedAsset asset = asset_for(file, written_, folder_of(editor_->file()));
    return edit(
        [&](std::string_view text) {
            std::string changed(text);
            if (asset.is_new) changed = edit::with_asset(changed, asset.name, asset.written);
            return edit::with_setting(changed, node, param, asset.name);
        },
        fmt::format("{}.{} = {}, which is {}", node, param, asset.name, asset.path));
}

bool Workbench::replace_asset(const std::string& asset, const fs::path& file) {
    const std::string path = fs::absolute(file).lexically_normal().string();
    // What the command line said of it does not hold any more.
    const std::vector<std::string> before = choice_.overrides.assets;
    std::erase_if(choice_.overrides.assets, [&](const std::string& given) { return given.starts_with(asset + "="); });
    const bool is_made = edit(
        [&](std::string_view text) {
            return edit::with_asset(text, asset, edit::path_from(folder_of(editor_->file()), path));
        },
        fmt::format("{} is now {}", asset, path));
    if (!is_made) choice_.overrides.assets = before;
    // The text may have named the file already, and the override hid it.
    else if (before.size() != choice_.overrides.assets.size()) adopt_text();
    return is_made;
}

bool Workbench::set_driver(const std::string& device, const std::string& driver) {
    return edit([&](std::string_view text) { return edit::with_device(text, device, driver); },
                fmt::format("device {} has the driver {}", device, driver));
}

bool Workbench::set_device(const std::string& device, const std::string& name, const std::string& value) {
    return edit([&](std::string_view text) { return edit::with_device_setting(text, device, name, value); },
                fmt::format("device {}: {} = {}", device, name, value.empty() ? "its default" : value));
}

bool Workbench::keep_layout(const std::string& layout) {
    return edit([&](std::string_view text) { return edit::with_layout(text, layout); },
                fmt::format("the patch opens in the layout {}", layout));
}

}  // namespace tactus::window
