// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/open_sound.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>

namespace tactus::sound {

namespace {

constexpr int fastest_rate = 10'000'000;  // Hz; no sound card or data logger for vibration is faster
/// Best compression, of silence: FLAC packs 65535 samples into about 13 bytes, Vorbis 4096 into two.
constexpr double most_frames_per_byte = 8192.0;
/// libsndfile reports an unknown length as the largest number.
constexpr sf_count_t unknown_length = sf_count_t{1} << 62;

/// libsndfile reads a truncated RIFF file without an error.
void check_riff_length(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    unsigned char head[8] = {};
    if (!file.read(reinterpret_cast<char*>(head), sizeof head) || std::memcmp(head, "RIFF", 4) != 0) return;
    const std::uintmax_t promised =
        8u + (head[4] | head[5] << 8 | head[6] << 16 | static_cast<std::uintmax_t>(head[7]) << 24);
    const std::uintmax_t present = std::filesystem::file_size(path);
    // Streaming programs leave the length field at its largest value.
    if (promised < 0xFFFFFF00u && present < promised)
        throw Error(fmt::format("{}: the sound is cut short: it has {} of {} bytes", path.string(), present, promised));
}

}  // namespace

SoundHandle open_sound(const std::filesystem::path& path, SF_INFO& info) {
    const auto fail = [&path](const std::string& why) { throw Error(fmt::format("{}: {}", path.string(), why)); };
    if (!std::filesystem::exists(path)) fail("no such sound file");
    if (std::filesystem::is_directory(path)) fail("is a folder, not a sound file");
    const auto size = static_cast<double>(file::require_file(path));
    SoundHandle file(sf_open(path.c_str(), SFM_READ, &info));
    if (!file) fail(fmt::format("cannot be read as sound: {}", sf_strerror(nullptr)));
    check_riff_length(path);
    if (info.frames <= 0) fail("the sound is empty");
    if (info.samplerate <= 0 || info.channels <= 0) fail("the sound's header is damaged");
    if (info.samplerate > fastest_rate)
        fail(fmt::format("its header states {} samples per second; the limit is {}", info.samplerate, fastest_rate));
    if (info.frames < unknown_length)
        file::require_possible(static_cast<double>(info.frames), most_frames_per_byte * size, path, "samples");
    return file;
}

}  // namespace tactus::sound
