// SPDX-License-Identifier: Apache-2.0
// The inner loops of five objects of Pure Data, written from what its manual and M. Puckette, "The Theory and Technique of
// Electronic Music" (2007), say they compute: floats in blocks of 64, one call per object.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tactus::bench {

struct PureDataTwin {
    std::string object;  ///< "osc~"
    std::string type;  ///< of the node beside it
    std::vector<const char*> inputs;  ///< of the node that get a signal
    std::string settings;  ///< of the node, lines of a patch
    /// ns of one object in one call of 64 samples, among so many; processor time.
    std::function<double(int count)> ns_per_block;
};

std::vector<PureDataTwin> pure_data_twins();

}  // namespace tactus::bench
