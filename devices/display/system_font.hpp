// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tactus::display {

/// Path of a scalable font that the system has, empty when none of the usual ones is installed.
std::string system_font(bool bold);

}  // namespace tactus::display
