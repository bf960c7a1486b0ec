// SPDX-License-Identifier: Apache-2.0
// The frame and the unit that a JSON file states for its positions.
#pragma once

#include "assets/file/json.hpp"

#include <string>
#include <string_view>

namespace tactus::file {

/// Checks the members 'frame', a text that begins with "LPS", and `unit_key`, "mm". Both may be absent. Positions in
/// another frame or unit would be mirrored or scaled. Throws Error naming `file`.
void require_lps_mm(const Json& json, std::string_view unit_key, const std::string& file);

}  // namespace tactus::file
