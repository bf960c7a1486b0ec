// SPDX-License-Identifier: Apache-2.0
// What `render` and `run` leave in the folder besides the recordings.
#pragma once

#include "engine/engine.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::session {

/// Pictures of the bones in the report, seen from where they were cut. Returns the names of the files written; a
/// machine that cannot draw is told on standard error.
std::vector<std::string> write_pictures(const Report& report, const std::filesystem::path& folder);

/// The bones of the report as they were cut, one bone file each. Returns the names of the files written.
std::vector<std::string> write_bones(const Report& report, const std::filesystem::path& folder);

}  // namespace tactus::session
