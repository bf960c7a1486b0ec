// SPDX-License-Identifier: Apache-2.0
// Prepares a patch for validation: the saw runs steadily at one rate and load, and the compared outputs are recorded.
#pragma once

#include "graph/compile/schedule.hpp"

#include <filesystem>
#include <string>

namespace tactus::analysis {

/// The saw of a patch, and the port where its vibration reaches the hand.
struct SawPath {
    std::string saw;    ///< name of the node
    std::string out;    ///< "handle.out": the vibration of the handle
    std::string drive;  ///< "actuator.voltage"; empty: no actuator, or several
};

/// Fills in missing names: the only node of type 'saw'; the output recorded as handle.wav, otherwise that of the only
/// actuator. Throws Error naming the options --saw and --out if this is ambiguous.
SawPath find_saw_path(const patch::Patch& patch, const std::string& saw, const std::string& out,
                      compile::Catalogue catalogue);

/// Condition of the saw.
struct SteadySaw {
    std::filesystem::path recordings;  ///< replaces the set of the patch
    double rate = 0.0;                 ///< strokes per second, Hz
    double load = 0.0;                 ///< N; 0: in free air
    double gain = 1.0;                 ///< gain of the saw, relative to the patch
};

/// The changed patch; files are in the folder of the run.
struct SteadyPatch {
    patch::Patch patch;
    std::string out_file, drive_file;  ///< drive_file is empty without a drive
};

/// Replaces the wires to the saw's load, trigger and rate by constants, and keeps only the nodes that lead to
/// `path.out`. Throws Error when no wires lead from the saw to it.
SteadyPatch steady_patch(const patch::Patch& patch, const SawPath& path, const SteadySaw& saw,
                         compile::Catalogue catalogue);

}  // namespace tactus::analysis
