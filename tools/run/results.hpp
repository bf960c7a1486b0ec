// SPDX-License-Identifier: Apache-2.0
// Files of `render` and `run` besides the recordings.
#pragma once

#include "engine/run/engine.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::run {

struct WrittenFiles {
    std::vector<std::string> names;
    std::vector<std::string> losses;  ///< reasons why files could not be written, with their names
};

/// Writes the cut bones of the report, one bone file each, and, `with_pictures`, an image of each cut. Errors in
/// drawing are reported on standard error.
WrittenFiles write_results(const Report& report, const std::filesystem::path& folder, bool with_pictures = true);

}  // namespace tactus::run
