// SPDX-License-Identifier: Apache-2.0
// Repairs the headers of WAV files that recorders left unfinished.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tactus::sound {

/// A header that fits the samples of a file: sizes that a crash left at 0, at the largest number, or that are wrong.
struct WaveHeader {
    std::string bytes;                 ///< up to the samples
    std::uint64_t start = 0, size = 0;  ///< bytes of the samples in the file
    std::string note;                  ///< what was wrong, one sentence
};

/// None when the file is no RIFF or RF64 wave, has a right header, no format, or no samples. The samples are those that the
/// file has: up to its end if it ends before its stated size.
std::optional<WaveHeader> repaired_wave_header(const std::filesystem::path& path);

}  // namespace tactus::sound
