// SPDX-License-Identifier: Apache-2.0
// Node types from outside of the tree: shared objects that end in a TACTUS_PLUGIN line (graph/node/plugin.hpp).
//
// They are native code of another author, so only the user and the administrator choose them: $TACTUS_NODES, which the
// option --nodes extends, and the folder `nodes` beside the installed modules. No path in a patch, a take or a plan loads code.
#pragma once

#include "graph/node/node.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::plugin {

struct Plugin {
    std::string name, version;
    std::filesystem::path file;  ///< absolute
    std::uint64_t hash = 0;  ///< of the file's bytes
    std::vector<const NodeType*> types;
};

/// Loads one shared object and makes a node of each type once, to check its declaration. It stays loaded until the program ends:
/// nodes, descriptors and texts of it may be in use anywhere. Throws Error, one that says what to rebuild when it was built for
/// another ABI.
Plugin load(const std::filesystem::path& file);

/// Adds a file, or a folder whose *.so are all loaded, in front of $TACTUS_NODES; so programs that this one starts have it,
/// too. Before the first call of `all`. Throws Error for a path that does not exist.
void use(const std::string& path);

/// Whether $TACTUS_NODES names any.
bool are_given();

/// The plug-ins of $TACTUS_NODES ("FILE:FOLDER:…") and of the installed folder, in that order, each file once; loaded at the
/// first call. Throws Error; the next call then tries again.
const std::vector<Plugin>& all();

/// Null: the type is built in.
const Plugin* plugin_of(const NodeType& type);

}  // namespace tactus::plugin
