// SPDX-License-Identifier: Apache-2.0
// A command that may take only so much of the machine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::campaign {

struct RunLimits {
    int processor_s = 20, wall_s = 120;
    double resident_mb = 2000.0;
};

/// Runs `words` in `folder`. Returns what was wrong with its end: a signal, an exit code above 3, too much time or memory;
/// "" when nothing was.
std::string run_limited(const std::vector<std::string>& words, const std::filesystem::path& folder,
                        const RunLimits& limits = {});

}  // namespace tactus::campaign
