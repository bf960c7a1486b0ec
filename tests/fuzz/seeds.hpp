// SPDX-License-Identifier: Apache-2.0
// Small valid files, from which fuzzers and the campaign of mutants start.
#pragma once

#include <filesystem>

namespace tactus {

/// Writes files of the formats that patients' data come in to root/<room>_<reader>/.
void write_seeds(const std::filesystem::path& root);

}  // namespace tactus
