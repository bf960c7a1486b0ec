// SPDX-License-Identifier: Apache-2.0
// A bone that no seed is: a plan takes each bone once.
#pragma once

#include "assets/file/whole_file.hpp"

#include <filesystem>

namespace tactus::campaign {

/// Writes a tetrahedron in mm, as OBJ.
inline void write_other_bone(const std::filesystem::path& file) {
    file::write_whole_file(file, "v 60 0 0\nv 90 0 0\nv 60 25 0\nv 60 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
}

}  // namespace tactus::campaign
