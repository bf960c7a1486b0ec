// SPDX-License-Identifier: Apache-2.0
// The verbs of the tactus command.
#pragma once

#include "tools/command/options.hpp"

namespace tactus::command {

/// In the order of the help text.
const Verbs& all_verbs();
/// The command itself.
Program tactus_program();
/// Those of 'plan'.
const Verbs& plan_verbs();
/// Those of 'experiment'.
const Verbs& experiment_verbs();
/// Those of 'sweep'.
const Verbs& sweep_verbs();

}  // namespace tactus::command
