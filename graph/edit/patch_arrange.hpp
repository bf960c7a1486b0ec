// SPDX-License-Identifier: Apache-2.0
// Text edits of a patch's window layout, of its assets and devices, and of several nodes in one step. As in
// graph/edit/patch_edit.hpp, bytes that an edit does not name stay unchanged.
#pragma once

#include "graph/edit/patch_edit.hpp"
#include "graph/patch/patch.hpp"
#include "graph/patch/patch_window.hpp"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::edit {

/// Sets the positions of nodes within their lanes, rounded to whole units.
std::string with_places(std::string_view text, const std::map<std::string, patch::PatchPlace>& places);
/// Returns nodes to their automatic positions; nodes without a position are ignored.
std::string without_places(std::string_view text, std::span<const std::string> nodes);
/// Sets the colour of nodes; an empty colour removes it.
std::string with_colours(std::string_view text, std::span<const std::string> nodes, std::string_view colour);
/// Adds a comment, or replaces the comment of the same name.
std::string with_comment(std::string_view text, const patch::PatchComment& comment);
std::string without_comment(std::string_view text, std::string_view name);
std::string with_layout(std::string_view text, std::string_view layout);
std::string with_open_parts(std::string_view text, std::span<const std::string> nodes);

/// Adds a file to [assets], or changes the file of an existing name.
std::string with_asset(std::string_view text, std::string_view name, std::string_view path);
std::string with_device(std::string_view text, std::string_view name, std::string_view driver);
std::string with_device_setting(std::string_view text, std::string_view device, std::string_view name,
                                std::string_view value);

/// The delivery mode of a wire as written after "as"; empty if none is written.
std::string mode_text(const patch::PatchWire& wire);

std::string without_nodes(std::string_view text, std::span<const std::string> names);

/// Returns the text of a patch with only these nodes, the wires between them, their groups, assets and positions, for a
/// clipboard. Relative paths of assets start at `folder`.
std::string copied(std::string_view text, std::span<const std::string> names, const std::filesystem::path& folder);
/// Inserts the result of `copied`, or the nodes of any patch. `names` maps each node to its new name. Positions are
/// offset by `by`. A group that differs in rate, latency or backlog from the group of the same name in this patch is
/// renamed, and so is an asset of another file. Relative paths of this patch start at `folder` (empty: assets of the
/// same name count as the same file).
std::string with_pasted(std::string_view text, std::string_view copy, const std::map<std::string, std::string>& names,
                        patch::PatchPlace by, const std::filesystem::path& folder = {});

/// Nodes moved into a new sub-patch.
struct SubPatch {
    std::string outer, inner;  ///< patch texts
};
/// Replaces nodes by one node of type `patch:FILE`, `file` relative to the patch. Ports whose wires cross the border
/// become the ports of the sub-patch. Throws Error if the name is in use or no node is given.
SubPatch with_sub_patch(std::string_view text, std::span<const std::string> nodes, std::string_view name,
                        std::string_view file, const std::filesystem::path& folder);

}  // namespace tactus::edit
