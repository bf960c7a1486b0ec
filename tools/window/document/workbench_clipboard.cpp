// SPDX-License-Identifier: Apache-2.0
// Copies of nodes and comments, within a patch and from one to another.
#include "graph/edit/patch_arrange.hpp"
#include "tools/window/document/clipboard_lane.hpp"
#include "tools/window/document/thing_count.hpp"
#include "tools/window/document/workbench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

/// A free name like one of another patch: "gain_2" becomes "gain_3".
std::string free_name_like(const std::string& name, std::set<std::string>& taken) {
    std::string stem = name;
    if (const std::size_t bar = stem.rfind('_'); bar != std::string::npos && bar > 0 && bar + 1 < stem.size() &&
                                                 stem.find_first_not_of("0123456789", bar + 1) == std::string::npos)
        stem.resize(bar);
    std::string made = name;
    for (int i = 2; !taken.insert(made).second; ++i) made = fmt::format("{}_{}", stem, i);
    return made;
}

}  // namespace

std::string Workbench::copy(const std::vector<std::string>& nodes,
                            const std::map<std::string, patch::PatchPlace>& places,
                            const std::vector<std::string>& comments) const {
    try {
        std::string text;
        if (!nodes.empty()) {
            std::map<std::string, patch::PatchPlace> unplaced = places;
            for (const auto& [node, place] : window_.places) unplaced.erase(node);
            text = edit::with_places(edit::copied(editor_->text(), nodes, fs::absolute(editor_->file()).parent_path()),
                                     unplaced);
        }
        patch::Problems ignored;
        const double top = lane_top(picture_, lane_of_comments(patch::read_patch(text, "clipboard", ignored)));
        for (const patch::PatchComment& comment : window_.comments) {
            if (std::ranges::find(comments, comment.name) == comments.end()) continue;
            patch::PatchComment copied = comment;
            copied.place.y -= top;
            text = edit::with_comment(text, copied);
        }
        return text;
    } catch (const Error&) {
        return {};
    }
}

Workbench::Pasted Workbench::paste(const std::string& copied, patch::PatchPlace by) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(copied, "clipboard", problems);
    std::vector<patch::PatchComment> comments = patch::window_of(copied).comments;
    // A patch of comments alone is none.
    if (patch.nodes.empty() ? comments.empty() : !problems.empty()) {
        tell("the clipboard holds no nodes or comments of a patch", true);
        return {};
    }
    // Each is an edit of the whole text.
    constexpr std::size_t max_comments = 500;
    if (comments.size() > max_comments) {
        tell(fmt::format("the clipboard holds {} comments; paste {} at most", comments.size(), max_comments), true);
        return {};
    }
    std::map<std::string, std::string> names;
    std::set<std::string> taken;
    for (const patch::PatchNode& node : written_.nodes) taken.insert(node.name);
    for (const patch::PatchNode& node : patch.nodes) names[node.name] = free_name_like(node.name, taken);
    Pasted made;
    for (const auto& [from, to] : names) made.nodes.push_back(to);
    taken.clear();
    for (const patch::PatchComment& comment : window_.comments) taken.insert(comment.name);
    const double top = lane_top(picture_, lane_of_comments(patch));
    for (patch::PatchComment& comment : comments) {
        comment.name = free_name_like(comment.name, taken);
        comment.place = {comment.place.x + by.x, comment.place.y + by.y + top};
        made.comments.push_back(comment.name);
    }
    const fs::path folder = fs::absolute(editor_->file()).parent_path();
    const bool is_made = edit(
        [&](std::string_view text) {
            std::string changed =
                patch.nodes.empty() ? std::string(text) : edit::with_pasted(text, copied, names, by, folder);
            for (const patch::PatchComment& comment : comments) changed = edit::with_comment(changed, comment);
            return changed;
        },
        "added " + count_of(made.nodes.size(), made.comments.size()));
    return is_made ? made : Pasted{};
}

}  // namespace tactus::window
