// SPDX-License-Identifier: Apache-2.0
// What a trainee reads after an attempt. No user interface.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::window {

/// Of the run in a folder; where there is no score, why. Does not throw.
std::string score_of(const std::filesystem::path& folder);

}  // namespace tactus::window
