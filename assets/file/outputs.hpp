// SPDX-License-Identifier: Apache-2.0
// Checks the names of output files before the work starts.
#pragma once

#include <filesystem>
#include <span>

namespace tactus::file {

/// Throws Error if an output is one of the sources, occurs twice in the list, is a folder, or has no folder or one
/// that may not be written to. Empty paths are skipped. Called first, because a result must never overwrite a patient's scan or another result.
void check_outputs(std::span<const std::filesystem::path> sources, std::span<const std::filesystem::path> outputs);

}  // namespace tactus::file
