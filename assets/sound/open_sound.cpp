// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/open_sound.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/sound/stated_size.hpp"
#include "assets/sound/wave_header.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

namespace tactus::sound {

namespace {

constexpr int fastest_rate = 10'000'000;  // Hz; no sound card or data logger for vibration is faster
/// Best compression, of silence: FLAC packs 65535 samples into about 13 bytes, Vorbis 4096 into two.
constexpr double max_frames_per_byte = 8192.0;
/// libsndfile reports an unknown length as the largest number.
constexpr sf_count_t unknown_length = sf_count_t{1} << 62;

/// A header of ours before the samples of a file.
struct Repaired {
    std::ifstream file;
    WaveHeader header;
    sf_count_t at = 0;

    sf_count_t length() const { return static_cast<sf_count_t>(header.bytes.size() + header.size); }

    sf_count_t read(char* to, sf_count_t count) {
        const auto head = static_cast<sf_count_t>(header.bytes.size());
        sf_count_t done = 0;
        if (at < head) {
            done = std::min(count, head - at);
            std::memcpy(to, header.bytes.data() + at, static_cast<std::size_t>(done));
            at += done;
        }
        const sf_count_t rest = std::min(count - done, length() - at);
        if (rest <= 0) return done;
        file.clear();
        file.seekg(static_cast<std::streamoff>(header.start) + at - head);
        file.read(to + done, rest);
        at += file.gcount();
        return done + file.gcount();
    }
};

SF_VIRTUAL_IO repaired_input() {
    SF_VIRTUAL_IO io{};
    io.get_filelen = [](void* user) { return static_cast<Repaired*>(user)->length(); };
    io.seek = [](sf_count_t offset, int whence, void* user) {
        auto& source = *static_cast<Repaired*>(user);
        const sf_count_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? source.at : source.length();
        return source.at = std::clamp<sf_count_t>(base + offset, 0, source.length());
    };
    io.read = [](void* to, sf_count_t count, void* user) {
        return static_cast<Repaired*>(user)->read(static_cast<char*>(to), count);
    };
    io.write = [](const void*, sf_count_t, void*) { return sf_count_t{0}; };
    io.tell = [](void* user) { return static_cast<Repaired*>(user)->at; };
    return io;
}

}  // namespace

SoundHandle open_sound(const std::filesystem::path& path, SF_INFO& info, std::string* note) {
    const auto fail = [&path](const std::string& why) { throw Error(fmt::format("{}: {}", path.string(), why)); };
    if (!std::filesystem::exists(path)) fail("no such sound file");
    if (std::filesystem::is_directory(path)) fail("is a folder, not a sound file");
    const auto size = static_cast<double>(file::require_file(path));
    SoundHandle file;
    if (std::optional<WaveHeader> header = repaired_wave_header(path)) {
        if (note) *note = header->note;
        const auto source = std::make_shared<Repaired>();
        source->file.open(path, std::ios::binary);
        source->header = std::move(*header);
        SF_VIRTUAL_IO io = repaired_input();
        file = SoundHandle(sf_open_virtual(&io, SFM_READ, &info, source.get()), CloseSound{source});
    } else {
        file.reset(sf_open(path.c_str(), SFM_READ, &info));
    }
    if (!file) {
        const std::string_view why = sf_strerror(nullptr);
        // libsndfile's error for headers without a rate, and for chunks in an unknown order.
        if (why.starts_with("Internal error")) fail("cannot be read as sound: its header is damaged");
        // libsndfile recognises neither the content nor the extension.
        if (why.starts_with("File does not exist")) fail("cannot be read as sound: not a sound file of a known format");
        fail(fmt::format("cannot be read as sound: {}", why));
    }
    if (info.frames <= 0) fail("the sound is empty");
    if (const std::optional<std::uint64_t> stated = stated_size(path);
        note && stated && static_cast<double>(*stated) > size)
        *note =
            fmt::format("the sound is cut short: its header states {} bytes and the file has {:.0f}", *stated, size);
    if (note && note->empty())
        if (const std::uint64_t unread = unread_bytes(path, static_cast<std::uint64_t>(size)); unread > 0)
            *note = fmt::format(
                "the header states {:.0f} bytes and the file has {:.0f}: the rest was not read, though it may "
                "hold samples; repair the header, or convert the file again",
                size - static_cast<double>(unread), size);
    if (info.samplerate <= 0 || info.channels <= 0) fail("the sound's header is damaged");
    if (info.samplerate > fastest_rate)
        fail(fmt::format("its header states {} samples per second; the limit is {}", info.samplerate, fastest_rate));
    if (info.frames < unknown_length)
        file::require_possible(static_cast<double>(info.frames), max_frames_per_byte * size, path, "samples");
    return file;
}

}  // namespace tactus::sound
