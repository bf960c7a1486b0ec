// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tactus::window {

/// Words beside the pointer, in several lines where they are long: a single one would be cut in a small window.
void show_tooltip(const std::string& text);

}  // namespace tactus::window
