// SPDX-License-Identifier: Apache-2.0
// Identity of a file together with the samples that it refers to.
#pragma once

#include "dsp/core/hash.hpp"

#include <filesystem>

namespace tactus::volume {

/// Adds the bytes of a file, and for an NRRD header (.nrrd, .nhdr) those of the files of its samples, as far as they
/// can be read. Throws Error if the file itself cannot be read.
void add_file_with_samples(Hash& hash, const std::filesystem::path& path);

}  // namespace tactus::volume
