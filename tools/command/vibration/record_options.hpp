// SPDX-License-Identifier: Apache-2.0
// What the verbs that analyse records are given.
#pragma once

#include "tools/command/options.hpp"
#include "tools/study/vibration/record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::command {

struct RecordChoice {
    std::vector<std::filesystem::path> files;
    study::RecordSettings record;
    bool json = false;
};

/// `files`: what the help text says of them.
void add_record_options(VerbOptions& verb, RecordChoice& choice, const char* files);

}  // namespace tactus::command
