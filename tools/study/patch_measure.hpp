// SPDX-License-Identifier: Apache-2.0
// A patch with a sweep in the place of one of its signals, and a recorder at another.
#pragma once

#include "graph/compile/plan.hpp"

#include <string>

namespace tactus::study {

/// What is measured, and the sweep: the settings of a node of type 'sweep'.
struct MeasuredPath {
    std::string in;   ///< "actuator.drive": the input that the sweep feeds, or the output that it replaces
    std::string out;  ///< "actuator.signal": the output that is recorded
    std::vector<OptionText> sweep;
};

/// What became of the patch.
struct MeasuredPatch {
    patch::Patch patch;
    std::string rate;            ///< of both ends, as the patch writes it
    std::string in_unit, out_unit;
    std::string file;            ///< the recording's name in the folder of the run
};

/// Replaces the signal at `path.in` by a sweep and records `path.out`; of the patch only the nodes remain that lead to
/// it. Throws Error when a port does not exist or is no signal, the ends run at different rates, or no wires lead from
/// one to the other.
MeasuredPatch measured_patch(const patch::Patch& patch, const MeasuredPath& path, compile::Catalogue catalogue);

}  // namespace tactus::study
