// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tactus::display {

/// Path of a scalable system font; empty if none of the usual fonts is installed.
std::string system_font(bool bold);

}  // namespace tactus::display
