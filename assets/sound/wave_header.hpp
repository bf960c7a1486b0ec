// SPDX-License-Identifier: Apache-2.0
// Repairs the headers of WAV files that recorders did not finish.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus::sound {

/// A header that matches the samples of a file, for sizes that are wrong, too small, or that a crash left at 0 or at the maximum.
struct WaveHeader {
    std::string bytes;  ///< up to the samples
    std::uint64_t start = 0, size = 0;  ///< bytes of the samples in the file
    std::string note;  ///< the defect, one sentence
};

/// Returns nothing if the file is not a RIFF or RF64 wave, has a correct header, no format, or no samples. The samples
/// are those present: up to the end of the file if it ends before its stated size, or if no chunk begins behind it.
std::optional<WaveHeader> repaired_wave_header(const std::filesystem::path& path);

}  // namespace tactus::sound
