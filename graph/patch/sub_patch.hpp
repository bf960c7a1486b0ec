// SPDX-License-Identifier: Apache-2.0
// Sub-patches: a patch used as a node of another. The file lists the ports and parameters that it exposes:
//
//     [inputs]
//     load = "saw.load"                              # a port of a node, or a list of ports
//     [outputs]
//     signal = "equaliser.signal"
//     [parameters]
//     level = "saw.level"
//
// Another patch uses it and wires these ports:
//
//     [nodes.voice]
//     type = "patch:saw-voice.toml"                  # relative to the file of this patch
//     rate = "48 kHz"                                # only when its nodes have rate = "outer"
//     level = 0.5
//
// A sub-patch is flattened: its node 'saw' becomes the node 'voice:saw', at no cost in time or latency. Its groups and
// assets are renamed in the same way. A device of the outer patch replaces the device of the same name. `quantum` and
// `seed` are those of the outermost patch.
#pragma once

#include "graph/patch/patch.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::patch {

inline constexpr std::string_view sub_patch_prefix = "patch:";
inline constexpr char within_node = ':';        ///< as in "voice:saw"
inline constexpr std::string_view outer_rate = "outer";

/// Returns true if the node's type names a patch file.
bool is_sub_patch(const PatchNode& node);

/// Returns the path, as in PatchPart, of the sub-patch `type` used in the sub-patch at `from` (empty: the outermost
/// patch).
std::string part_path(const std::string& from, const std::string& type);

/// Returns the file for a path of PatchPart.
std::filesystem::path file_of_part(const Patch& patch, const std::string& path);

/// Reads the files of all sub-patches, to any depth, that `patch.parts` does not contain yet. Skips a file that cannot
/// be read; flatten() reports it.
void read_parts(Patch& patch);

/// Returns the files of `patch.parts`, for a file watcher.
std::vector<std::filesystem::path> part_files(const Patch& patch);

/// Replaces each sub-patch by its nodes and wires. Adds errors to `problems`. Reads no file; a patch without
/// sub-patches does not change.
void flatten(Patch& patch, Problems& problems);

/// Returns one text with the patch and all its sub-patches as entries [[parts]] at the end.
std::string bundle_text(const Patch& patch);

/// A node and its port or parameter.
struct NamedEnd {
    std::string node, name;
};
/// Returns all inner ports or parameters of `node`.`name` in a flattened patch, at any depth, in the order of the
/// files: an input or a parameter of a sub-patch may set several. A name that no sub-patch exposed is returned
/// unchanged. Never empty.
std::vector<NamedEnd> ends_within(const Patch& patch, std::string_view node, std::string_view name);

}  // namespace tactus::patch
