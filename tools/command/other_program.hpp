// SPDX-License-Identifier: Apache-2.0
// Programs that stand beside this one.
#pragma once

#include <string>
#include <vector>

namespace tactus::command {

/// Replaces the process by the program `name` beside this one, with `arguments`. `holds` says what it has, for the error
/// when it does not exist. Throws Error.
[[noreturn]] void run_beside(const std::string& name, const std::string& holds, std::vector<std::string> arguments);

}  // namespace tactus::command
