// SPDX-License-Identifier: Apache-2.0
// Parts of a patch found by name, for verbs that run only some of it.
#pragma once

#include "graph/compile/plan.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::patch {

/// One end of a signal's wires.
struct SignalEnd {
    const PatchNode* node = nullptr;  ///< in the patch
    std::string port, unit;
    bool is_input = false;
};

/// "actuator.signal" → that port of that node. `option` is what the command line calls it, for messages. Throws Error
/// when there is none, or it carries no signal.
SignalEnd find_signal(const Patch& patch, const std::string& text, std::string_view option,
                      compile::Catalogue catalogue);

/// Leaves only the nodes of those names and what leads to them, in the order of the patch.
void keep_what_leads_to(std::vector<std::string> names, Patch& patch);

}  // namespace tactus::patch
