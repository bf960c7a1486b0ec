// SPDX-License-Identifier: Apache-2.0
// The extension of a file's name. Cameras, scanners and programs of Windows write it in capitals.
#pragma once

#include "dsp/core/lower.hpp"

#include <filesystem>
#include <string>

namespace tactus::file {

/// With its dot, in small letters: ".stl" of "Femur.STL"; "" if there is none.
inline std::string extension_of(const std::filesystem::path& path) { return lower(path.extension().string()); }

}  // namespace tactus::file
