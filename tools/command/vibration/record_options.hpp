// SPDX-License-Identifier: Apache-2.0
// Options of the verbs that analyse records.
#pragma once

#include "tools/analysis/vibration/record.hpp"
#include "tools/command/options.hpp"
#include "tools/command/vibration/stretch_options.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::command {

struct RecordChoice {
    std::vector<std::filesystem::path> files;
    analysis::RecordSettings record;  ///< without the stretch: see `settings`
    StretchChoice stretch;

    analysis::RecordSettings settings() const;
};

/// `files`: help text of the files argument. `rate`: names of the option for the rate of a log without times.
void add_record_options(VerbOptions& verb, RecordChoice& choice, const char* files,
                        const char* rate = "--sample-rate,--rate");

}  // namespace tactus::command
