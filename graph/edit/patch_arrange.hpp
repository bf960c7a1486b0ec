// SPDX-License-Identifier: Apache-2.0
// Edits of what a window shows of a patch, of its assets and devices, and of several nodes at once. Like those of
// graph/edit/patch_edit.hpp: bytes that an edit does not name stay.
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

/// Places of nodes within their lanes, rounded to whole units.
std::string with_places(std::string_view text, const std::map<std::string, patch::PatchPlace>& places);
/// Back to the places of the automatic arrangement; nodes without a place are ignored.
std::string without_places(std::string_view text, std::span<const std::string> nodes);
/// An empty colour removes it.
std::string with_colours(std::string_view text, std::span<const std::string> nodes, std::string_view colour);
/// Adds a comment or replaces the one of its name.
std::string with_comment(std::string_view text, const patch::PatchComment& comment);
std::string without_comment(std::string_view text, std::string_view name);
std::string with_layout(std::string_view text, std::string_view layout);
std::string with_open_parts(std::string_view text, std::span<const std::string> nodes);

/// Names a file in [assets], or another file for a name that is there.
std::string with_asset(std::string_view text, std::string_view name, std::string_view path);
std::string with_device(std::string_view text, std::string_view name, std::string_view driver);
std::string with_device_setting(std::string_view text, std::string_view device, std::string_view name,
                                std::string_view value);

/// How a wire is delivered, as it is written behind "as"; empty: nothing is written.
std::string mode_text(const patch::PatchWire& wire);

std::string without_nodes(std::string_view text, std::span<const std::string> names);

/// A patch's text with those nodes, the wires between them, their groups, assets and places: for a clipboard. Relative
/// paths of assets start at `folder`.
std::string copied(std::string_view text, std::span<const std::string> names, const std::filesystem::path& folder);
/// Adds what `copied` gave, or any patch's nodes. `names`: what each is called here. Places move by `by`. A group of
/// another rate, latency or backlog, or an asset of another file, with a name of this patch gets a new name; relative
/// paths of this patch start at `folder` (empty: an asset with a name of this patch is taken for the same).
std::string with_pasted(std::string_view text, std::string_view copy, const std::map<std::string, std::string>& names,
                        patch::PatchPlace by, const std::filesystem::path& folder = {});

/// Nodes moved into a patch of their own.
struct SubPatch {
    std::string outer, inner;  ///< texts
};
/// Replaces nodes by one of type `patch:FILE`, `file` relative to the patch. Ports that wires cross become its ends.
/// Throws Error when a name is taken or nothing is chosen.
SubPatch with_sub_patch(std::string_view text, std::span<const std::string> nodes, std::string_view name,
                        std::string_view file, const std::filesystem::path& folder);

}  // namespace tactus::edit
