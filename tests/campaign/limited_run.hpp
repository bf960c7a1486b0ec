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

struct RunEnd {
    std::string fault;  ///< a signal, an exit code above 3, too much time or memory; "" when nothing was wrong
    int code = -1;
};

/// The command that is tried: $TACTUS, or the one built beside this program.
std::string tried_command();

/// Runs `words` in `folder`. What they print goes to the file `told`, or nowhere.
RunEnd run_limited(const std::vector<std::string>& words, const std::filesystem::path& folder,
                   const RunLimits& limits = {}, const std::filesystem::path& told = "/dev/null");

}  // namespace tactus::campaign
