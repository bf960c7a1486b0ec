// SPDX-License-Identifier: Apache-2.0
// Parser of one wire: "from.port -> to.port as linear".
#pragma once

#include "graph/patch/patch.hpp"

#include <string_view>

namespace tactus::patch {

/// `where` is the place of the first character. Throws Error at the wrong word when the file holds the text
/// `as_written`, otherwise (escapes, several lines) at `where`.
PatchWire parse_wire(std::string_view text, const SourceLocation& where, bool as_written = true);

/// True for a name of letters, digits, '_' and '-' that is not empty.
bool is_name(std::string_view text);

}  // namespace tactus::patch
