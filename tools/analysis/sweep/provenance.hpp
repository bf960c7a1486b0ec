// SPDX-License-Identifier: Apache-2.0
// What made a row: build, machine and processor.
#pragma once

#include "assets/file/json.hpp"

#include <string>

namespace tactus::analysis {

/// Of this process. `version`: as `tactus --version` prints it; `runner`: "local", "slurm 17_3", …; `jobs`: workers.
file::Json worker_description(const std::string& version, const std::string& runner, int jobs);

/// All that the bits of a result may depend on, as one text: build, C library, vector target, features of the processor.
/// Where two rows have the same text, the same point must give the same output.
std::string bits_of(const file::Json& worker);

}  // namespace tactus::analysis
