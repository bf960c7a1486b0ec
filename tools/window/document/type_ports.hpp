// SPDX-License-Identifier: Apache-2.0
// The ports and parameters of a node type. No user interface.
#pragma once

#include "tools/window/document/patch_picture.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::window {

/// The ports of a node type, by a node with default parameters.
struct TypePorts {
    struct File {
        std::string name, type;  ///< of the parameter; "bone"
    };
    std::vector<File> files;  ///< parameters that take one
    std::vector<PicturePort> inputs, outputs;
    std::vector<std::pair<std::string, std::string>> params;  ///< that wires may drive: name, unit
    std::vector<std::string> assets;  ///< required
};
/// Null: there is no such type. Only on the window's thread.
const TypePorts* ports_of_type(std::string_view type);

}  // namespace tactus::window
