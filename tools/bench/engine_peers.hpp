// SPDX-License-Identifier: Apache-2.0
// The same chain in Pure Data and scsynth, if installed, for comparison.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::bench {

/// An oscillator followed by `nodes` multiplications by 0.999 in series, at 48 kHz in blocks of `block`.
struct Chain {
    int nodes = 0;
    int block = 64;
    double seconds = 1.0;  ///< of sound
};

/// Runs the chain offline in a separate process; files go to `folder`. Returns the processor time of the process in s,
/// including start-up, or nothing when the program is missing or fails.
std::optional<double> run_in_pure_data(const Chain& chain, const std::filesystem::path& folder);
std::optional<double> run_in_scsynth(const Chain& chain, const std::filesystem::path& folder);

}  // namespace tactus::bench
