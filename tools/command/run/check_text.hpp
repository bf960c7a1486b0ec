// SPDX-License-Identifier: Apache-2.0
// What `check` found, as text for people.
#pragma once

#include "assets/file/json.hpp"

namespace tactus::command {

/// Prints all but the errors, which go to standard error.
void print_check(const file::Json& found);

}  // namespace tactus::command
