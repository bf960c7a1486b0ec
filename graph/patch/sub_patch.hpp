// SPDX-License-Identifier: Apache-2.0
// A patch as a node of another. The file says what it offers:
//
//     [inputs]
//     load = "saw.load"                              # a port within, or a list of them
//     [outputs]
//     signal = "equaliser.signal"
//     [parameters]
//     level = "saw.level"
//
// and another patch uses it, with wires to what is offered:
//
//     [nodes.voice]
//     type = "patch:saw-voice.toml"                  # beside the file that says so
//     rate = "48 kHz"                                # only when nodes within say rate = "outer"
//     level = 0.5
//
// It flattens: 'saw' within becomes the node 'voice:saw', and nothing is slower or later for it. Groups and assets
// within are named so as well; a device is the outer patch's of that name, if it has one. `quantum` and `seed` are
// those of the outermost patch.
#pragma once

#include "graph/patch/patch.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::patch {

inline constexpr std::string_view sub_patch_prefix = "patch:";
inline constexpr char within_node = ':';        ///< between the name of a node and of one within it
inline constexpr std::string_view outer_rate = "outer";

/// The type names a patch file.
bool is_sub_patch(const PatchNode& node);

/// Path of the part that `type` names in the part at `from` (empty: the outermost patch).
std::string part_path(const std::string& from, const std::string& type);

std::filesystem::path file_of_part(const Patch& patch, const std::string& path);

/// Reads the files of all patches within, to any depth, that `patch.parts` does not hold yet. What cannot be read is
/// left out; flatten() says so.
void read_parts(Patch& patch);

/// Files of `patch.parts`, for who watches them.
std::vector<std::filesystem::path> part_files(const Patch& patch);

/// Replaces every node that is a patch by what is within it. Reads no file. A patch without such nodes stays as it is.
void flatten(Patch& patch, Problems& problems);

/// One text that holds the patch and all within it, as entries [[parts]] at its end; without any: its text.
std::string bundle_text(const Patch& patch);

/// The node and port (or parameter) that "node.name" of a flattened patch stands for. Names that no patch within offers
/// come back as they are.
struct NamedEnd {
    std::string node, name;
};
NamedEnd end_within(const Patch& patch, std::string_view node, std::string_view name);

}  // namespace tactus::patch
