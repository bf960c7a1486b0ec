// SPDX-License-Identifier: Apache-2.0
// The grammar of one wire: "from.port -> to.port as linear".
#pragma once

#include "graph/patch/patch.hpp"

#include <string_view>

namespace tactus::patch {

/// `where` is the place of the text's first character. Throws Error at the word that is wrong, or at `where` when the
/// text does not stand in the file `as_written`.
PatchWire parse_wire(std::string_view text, const SourceLocation& where, bool as_written = true);

/// Letters, digits, '_' and '-', not empty.
bool is_name(std::string_view text);

}  // namespace tactus::patch
