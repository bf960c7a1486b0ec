// SPDX-License-Identifier: Apache-2.0
// What `check` found, as text for people.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace tactus::command {

/// Prints all but the errors, which go to standard error.
void print_check(const nlohmann::ordered_json& found);

}  // namespace tactus::command
