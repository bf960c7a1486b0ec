// SPDX-License-Identifier: Apache-2.0
// A patch whose saw runs steadily at one rate and load, and recorders at what shall be compared.
#pragma once

#include "graph/compile/plan.hpp"

#include <filesystem>
#include <string>

namespace tactus::study {

/// Where in a patch the saw stands, and where its vibration reaches the hand.
struct SawPath {
    std::string saw;    ///< name of the node
    std::string out;    ///< "handle.out": the vibration of the handle
    std::string drive;  ///< "actuator.voltage"; empty: the patch has none, or several
};

/// Finds what the names leave open: the only node of type 'saw'; what is recorded as handle.wav, or else what the only
/// actuator does. Throws Error naming the options --saw and --out when that is not clear.
SawPath find_saw_path(const patch::Patch& patch, const std::string& saw, const std::string& out,
                      compile::Catalogue catalogue);

/// How the saw runs.
struct SteadySaw {
    std::filesystem::path recordings;  ///< in place of the patch's
    double rate = 0.0;                 ///< strokes per second, Hz
    double load = 0.0;                 ///< N; 0: in free air
    double gain = 1.0;                 ///< of the saw, on top of the patch's
};

/// What became of the patch; files are in the folder of the run.
struct SteadyPatch {
    patch::Patch patch;
    std::string out_file, drive_file;  ///< the latter empty without a drive
};

/// The saw's load, trigger and rate no longer come from wires; of the patch only the nodes remain that lead to
/// `path.out`. Throws Error when no wires lead from the saw to it.
SteadyPatch steady_patch(const patch::Patch& patch, const SawPath& path, const SteadySaw& saw,
                         compile::Catalogue catalogue);

}  // namespace tactus::study
