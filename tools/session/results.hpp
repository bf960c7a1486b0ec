// SPDX-License-Identifier: Apache-2.0
// What `render` and `run` leave in the folder besides the recordings.
#pragma once

#include "engine/run/engine.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::session {

struct WrittenFiles {
    std::vector<std::string> names;
    std::vector<std::string> losses;  ///< why a file could not be written, which it names
};

/// The bones of the report as they were cut, one bone file each, and pictures of them, seen from where they were cut.
/// A machine that cannot draw is told on standard error.
WrittenFiles write_results(const Report& report, const std::filesystem::path& folder);

}  // namespace tactus::session
