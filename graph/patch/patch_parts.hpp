// SPDX-License-Identifier: Apache-2.0
// Finds signals of a patch by name and cuts a patch down to some of its nodes, for verbs that run only a part.
#pragma once

#include "graph/compile/plan.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::patch {

/// A signal port of a node.
struct SignalEnd {
    const PatchNode* node = nullptr;  ///< points into the patch
    std::string port, unit;
    bool is_input = false;
};

/// The port that text such as "actuator.signal" names. `option` is the command line's option, for messages. Throws
/// Error when there is no such port or it carries no signal.
SignalEnd find_signal(const Patch& patch, const std::string& text, std::string_view option,
                      compile::Catalogue catalogue);

/// Removes all nodes but those of `names` and the nodes upstream of them. The order stays.
void keep_what_leads_to(std::vector<std::string> names, Patch& patch);

}  // namespace tactus::patch
