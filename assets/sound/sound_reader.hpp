// SPDX-License-Identifier: Apache-2.0
// Reads a sound file in blocks, for records that do not fit in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace tactus::sound {

class SoundReader {
public:
    /// Opens any format of libsndfile (WAV, W64, AIFF, CAF, FLAC and others), with any number of channels and any rate.
    /// Throws Error when the file is missing, not a sound, empty, or shorter than its header states.
    explicit SoundReader(std::filesystem::path path);
    ~SoundReader();
    SoundReader(SoundReader&&) noexcept;
    SoundReader& operator=(SoundReader&&) noexcept;

    double rate() const noexcept;  ///< Hz
    std::size_t channels() const noexcept;
    std::size_t frames() const noexcept;  ///< as stated in the header
    /// Describes a defect of the file's header in one sentence; empty: none.
    const std::string& note() const noexcept;
    /// The comment of the file and the description of a broadcast wave; empty: none.
    std::string comment() const;

    /// Reads up to `frames` interleaved frames into `samples` (frames × channels); full scale is ±1, floats may exceed
    /// it. Returns the number of frames, 0 at the end. Throws Error when the file is damaged, ends early, or contains
    /// NaN or infinity.
    std::size_t read(double* samples, std::size_t frames);

    /// Skips frames from the start, without reading them where the format allows it. Throws Error if the file is
    /// damaged.
    void skip(std::size_t frames);

private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tactus::sound
