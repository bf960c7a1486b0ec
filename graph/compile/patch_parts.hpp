// SPDX-License-Identifier: Apache-2.0
// Finds signals of a patch by name, and reduces a patch to some of its nodes, for verbs that run only a part.
#pragma once

#include "graph/compile/schedule.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::compile {

/// A signal port of a node.
struct SignalEnd {
    const patch::PatchNode* node = nullptr;  ///< points into the patch
    std::string port, unit;
    bool is_input = false;
};

/// Returns the port named by text such as "actuator.signal". `option` is the command-line option, for messages. Throws
/// Error if the port does not exist or carries no signal.
SignalEnd find_signal(const patch::Patch& patch, const std::string& text, std::string_view option, Catalogue catalogue);

/// Removes all nodes except those of `names` and the nodes upstream of them. Keeps the order.
void keep_what_leads_to(std::vector<std::string> names, patch::Patch& patch);

}  // namespace tactus::compile
