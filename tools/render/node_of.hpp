// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tactus::render {

/// The node of "node.port".
inline std::string node_of(const std::string& port) { return port.substr(0, port.find('.')); }

}  // namespace tactus::render
