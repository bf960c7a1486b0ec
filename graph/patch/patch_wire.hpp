// SPDX-License-Identifier: Apache-2.0
// Parser of one wire: "from.port -> to.port as linear".
#pragma once

#include "graph/patch/patch.hpp"

#include <string_view>

namespace tactus::patch {

/// `where` is the location of the first character. Errors are thrown at the wrong word if the file contains the text
/// verbatim (`as_written`), otherwise (escapes, several lines) at `where`.
PatchWire parse_wire(std::string_view text, const SourceLocation& where, bool as_written = true);

/// Returns true for a non-empty name of letters, digits, '_' and '-'.
bool is_name(std::string_view text);

}  // namespace tactus::patch
