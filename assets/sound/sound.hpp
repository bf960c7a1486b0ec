// SPDX-License-Identifier: Apache-2.0
// Sound files, in and out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

namespace tactus::sound {

struct Sound {
    int rate = 0;                ///< samples per second, Hz
    int channels = 0;
    std::size_t frames = 0;      ///< samples per channel
    std::vector<float> samples;  ///< interleaved, frames × channels; full scale is ±1

    double duration() const { return static_cast<double>(frames) / rate; }  ///< s
};

/// Reads whatever libsndfile knows (WAV, FLAC, AIFF, Ogg and others). Throws Error when the file is missing, is no
/// sound, is cut short, is empty, holds a NaN or an infinity, or has more than 2^28 samples.
Sound load_sound(const std::filesystem::path& path);

/// The mean of all channels.
std::vector<float> mix_to_mono(const Sound& sound);

enum class SoundFormat {
    float_wav,  ///< 32-bit float, may exceed full scale; the same samples give the same bytes
    flac,       ///< 24 bit, cut at full scale
};

/// Writes beside the file (name + ".part") and renames when finished. An unfinished file is removed. On a full disk the
/// sound ends with the last frame that found room.
/// For offline work and threads without a deadline.
class SoundWriter {
public:
    /// `rate` in Hz. Throws Error when the file cannot be made.
    SoundWriter(std::filesystem::path path, int channels, int rate, SoundFormat format = SoundFormat::float_wav);
    ~SoundWriter();
    SoundWriter(SoundWriter&&) noexcept;
    SoundWriter& operator=(SoundWriter&&) noexcept;

    /// `samples`: interleaved, frames × channels. Throws Error when the disk is full; nothing more may be written then.
    void write(const float* samples, std::size_t frames);
    /// Completes the file under its own name, after a failed `write` too: with what was written; without any sample there
    /// is no file. Throws Error and leaves the part when that is not possible. Nothing may be written afterwards.
    void finish();

private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tactus::sound
