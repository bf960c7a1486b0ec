// SPDX-License-Identifier: Apache-2.0
// A sound file in pieces: for records that do not fit in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace tactus::sound {

class SoundReader {
public:
    /// Anything libsndfile knows: WAV, W64, AIFF, CAF, FLAC and others, any number of channels, any rate. Throws Error
    /// when the file is missing, no sound, empty, or shorter than its header says.
    explicit SoundReader(std::filesystem::path path);
    ~SoundReader();
    SoundReader(SoundReader&&) noexcept;
    SoundReader& operator=(SoundReader&&) noexcept;

    double rate() const noexcept;  ///< Hz
    std::size_t channels() const noexcept;
    std::size_t frames() const noexcept;  ///< as the header says

    /// Up to `frames` frames, interleaved, into `samples` (frames × channels); full scale is ±1, floats may go beyond.
    /// Returns the number of frames; 0 at the end. Throws Error when the file is damaged, ends early, or holds a NaN or
    /// an infinity.
    std::size_t read(double* samples, std::size_t frames);

private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tactus::sound
