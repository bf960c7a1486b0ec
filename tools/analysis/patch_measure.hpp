// SPDX-License-Identifier: Apache-2.0
// Replaces one signal of a patch by a sweep and records another one.
#pragma once

#include "graph/compile/schedule.hpp"

#include <string>

namespace tactus::analysis {

/// The measured ports, and the settings of the sweep (a node of type 'sweep').
struct MeasuredPath {
    std::string in;   ///< "actuator.drive": the input fed by the sweep, or the output replaced by it
    std::string out;  ///< "actuator.signal": the recorded output
    std::vector<OptionText> sweep;
};

/// The changed patch.
struct MeasuredPatch {
    patch::Patch patch;
    std::string rate;            ///< rate of both ports, as written in the patch
    std::string in_unit, out_unit;
    std::string file;            ///< name of the recording in the run's folder
};

/// Replaces the signal at `path.in` by a sweep and records `path.out`. Keeps only the nodes that lead to it. Throws
/// Error when a port does not exist or is not a signal, the ends run at different rates, or no wires lead from one to
/// the other.
MeasuredPatch measured_patch(const patch::Patch& patch, const MeasuredPath& path, compile::Catalogue catalogue);

}  // namespace tactus::analysis
