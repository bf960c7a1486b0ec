// SPDX-License-Identifier: Apache-2.0
// Checks the names of files to be written, before the work is done.
#pragma once

#include <filesystem>
#include <span>

namespace tactus::file {

/// Throws Error when an output is one of the sources, stands twice in the list, is a folder, or has no folder. Empty paths
/// are skipped. Called before the work: a result must never overwrite a patient's scan, nor another result.
void check_outputs(std::span<const std::filesystem::path> sources, std::span<const std::filesystem::path> outputs);

}  // namespace tactus::file
