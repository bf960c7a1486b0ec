// SPDX-License-Identifier: Apache-2.0
// Other engines that run the same chain for comparison: Pure Data and scsynth, when they are installed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::bench {

/// An oscillator and behind it `nodes` multiplications by 0.999, one after the other, at 48 kHz in blocks of `block`.
struct Chain {
    int nodes = 0;
    int block = 64;
    double seconds = 1.0;  ///< of sound
};

/// Runs the chain as fast as it goes, in a process of its own; files go to `folder`. Processor time in s of the whole
/// process, start and loading included, or nothing when the program is missing or fails.
std::optional<double> run_in_pure_data(const Chain& chain, const std::filesystem::path& folder);
std::optional<double> run_in_scsynth(const Chain& chain, const std::filesystem::path& folder);

}  // namespace tactus::bench
