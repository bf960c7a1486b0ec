// SPDX-License-Identifier: Apache-2.0
// What a sub-patch offers as one node. No user interface.
#pragma once

#include "graph/patch/patch.hpp"
#include "tools/window/document/parameters.hpp"
#include "tools/window/document/type_ports.hpp"

#include <map>
#include <string>
#include <vector>

namespace tactus::window {

struct PartPorts {
    TypePorts ports;          ///< an input is optional unless a node within needs it and nothing within feeds it
    bool takes_rate = false;  ///< a node within has the rate of the sub-patch
    std::string lane;         ///< where its first node runs; empty: at the rate of the sub-patch
};

/// Of each type of sub-patch in a patch. What cannot be read is left out; the compiler says so.
std::map<std::string, PartPorts> part_ports_of(const patch::Patch& patch);

/// The parameters that a sub-patch offers.
std::vector<ParameterField> parameters_of_part(const patch::Patch& patch, const patch::PatchNode& node);

}  // namespace tactus::window
