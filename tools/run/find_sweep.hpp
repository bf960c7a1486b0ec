// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace tactus::run {

/// The sweep file with this path, or with this name in the library. Throws Error listing the names in the library.
std::filesystem::path find_sweep(const std::string& name);

}  // namespace tactus::run
