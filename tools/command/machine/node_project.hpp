// SPDX-License-Identifier: Apache-2.0
// The project of a node outside of the tree, for `tactus nodes --new`.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::command {

/// Makes the folder `name` in the current one, with a source, a test and a CMakeLists.txt that builds both against an installed
/// Tactus. `name`: of the node type, as "soft_clip". Throws Error for a name that a node type cannot have or one has already, and
/// for a folder that exists; then nothing is written.
std::filesystem::path write_node_project(const std::string& name);

}  // namespace tactus::command
