// SPDX-License-Identifier: Apache-2.0
// Finds entries of a list by words and their synonyms. No user interface.
#pragma once

#include <string>
#include <string_view>

namespace tactus::window {

/// How well an entry suits what was typed; 0: not. Each typed word, or a synonym of it, must stand in `name` or in
/// `about`, or the word itself in `details`; the name counts more, its beginning most, and details least. Upper and
/// lower case are the same. Nothing typed: 1.
double suits(std::string_view typed, std::string_view name, std::string_view about, std::string_view details = {});

}  // namespace tactus::window
