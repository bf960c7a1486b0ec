// SPDX-License-Identifier: Apache-2.0
// Reads and writes sound files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::sound {

struct Sound {
    int rate = 0;                ///< samples per second, Hz
    int channels = 0;
    std::size_t frames = 0;      ///< samples per channel
    std::vector<float> samples;  ///< interleaved, frames × channels; full scale is ±1
    std::string note{};          ///< defect of the file's header, one sentence; empty: none

    double duration() const { return static_cast<double>(frames) / rate; }  ///< s
};

/// Reads every format of libsndfile (WAV, FLAC, AIFF, Ogg and others). Throws Error when the file is missing, not a
/// sound, truncated (a wave is read up to its end) or empty, contains NaN or infinity, or has more than 2^28 samples.
Sound load_sound(const std::filesystem::path& path);

/// The mean of all channels.
std::vector<float> mix_to_mono(const Sound& sound);

enum class SoundFormat {
    float_wav,  ///< 32-bit float, may exceed full scale; the same samples give the same bytes. RF64 when it is long
    flac,       ///< 24 bit, clipped at full scale
};

/// Writes to a part file (name + ".part") and renames it when finished. An unfinished file is removed. On a full disk
/// the sound ends with the last complete frame. For offline work and threads without a deadline.
class SoundWriter {
public:
    /// A WAV larger than this is completed as RF64 (EBU Tech 3306), which has 64-bit lengths. Lengths in WAV end at 4
    /// GiB, and many programs read them as signed, hence 2 GiB.
    static constexpr std::uint64_t max_wav_bytes = std::uint64_t{1} << 31;

    /// `rate` in Hz; `comment` is stored in the file's metadata. `rf64_from`: size in bytes from which the file is
    /// RF64, at most max_wav_bytes. Throws Error if the file cannot be created.
    SoundWriter(std::filesystem::path path, int channels, int rate, SoundFormat format = SoundFormat::float_wav,
                const std::string& comment = {}, std::uint64_t rf64_from = max_wav_bytes);
    ~SoundWriter();
    SoundWriter(SoundWriter&&) noexcept;
    SoundWriter& operator=(SoundWriter&&) noexcept;

    /// `samples`: interleaved, frames × channels. Throws Error if the disk is full; nothing more may be written then.
    void write(const float* samples, std::size_t frames);
    /// Completes the file and renames it, also after a failed `write`, with the samples written so far; without samples
    /// no file is created. On failure throws Error and keeps the part file. No writes may follow.
    void finish();

private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tactus::sound
