// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/sound.hpp"

#include "assets/file/room.hpp"
#include "assets/sound/open_sound.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>

namespace tactus::sound {

namespace {

constexpr std::size_t max_samples = std::size_t{1} << 28;

}  // namespace

Sound load_sound(const std::filesystem::path& path) {
    const auto fail = [&path](const std::string& why) { throw Error(fmt::format("{}: {}", path.string(), why)); };
    SF_INFO info{};
    std::string note;
    const SoundHandle file = open_sound(path, info, &note);
    if (static_cast<std::size_t>(info.frames) > max_samples / static_cast<std::size_t>(info.channels))
        fail("the sound is longer than 2^28 samples; cut it first");
    Sound sound{info.samplerate, info.channels, static_cast<std::size_t>(info.frames), {}, std::move(note)};
    file::require_room(double(info.frames) * info.channels * sizeof(float), path, "its samples");
    // The stated length is not trusted: memory grows with the data that is read.
    const std::size_t chunk_frames = std::min<std::size_t>(65536, sound.frames);
    std::vector<float> chunk(chunk_frames * static_cast<std::size_t>(info.channels));
    for (sf_count_t got; (got = sf_readf_float(file.get(), chunk.data(), static_cast<sf_count_t>(chunk_frames))) > 0;)
        sound.samples.insert(sound.samples.end(), chunk.begin(), chunk.begin() + got * info.channels);
    if (sf_error(file.get()) != SF_ERR_NO_ERROR) fail(fmt::format("the sound is damaged: {}", sf_strerror(file.get())));
    if (sound.samples.size() != sound.frames * static_cast<std::size_t>(sound.channels)) fail("the sound is cut short");
    for (const float sample : sound.samples)
        if (!std::isfinite(sample)) fail("the sound holds a NaN or an infinity");
    return sound;
}

std::vector<float> mix_to_mono(const Sound& sound) {
    const auto channels = static_cast<std::size_t>(sound.channels);
    std::vector<float> mono(sound.frames);
    for (std::size_t i = 0; i < sound.frames; ++i) {
        double sum = 0.0;
        for (std::size_t c = 0; c < channels; ++c) sum += static_cast<double>(sound.samples[i * channels + c]);
        mono[i] = static_cast<float>(sum / static_cast<double>(channels));
    }
    return mono;
}

namespace {

/// The length in the header; none when it cannot be read.
sf_count_t frames_in(const std::filesystem::path& path) {
    SF_INFO info{};
    const SoundHandle sound(sf_open(path.c_str(), SFM_READ, &info));
    return sound ? info.frames : 0;
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return word;
}

void put_number(std::uint64_t number, std::size_t size, std::string& bytes, std::size_t at) {
    for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<char>(number >> (8 * i));
}

constexpr char reserved[] = "JUNK";
constexpr std::uint32_t reserved_bytes = 28;  // of the chunk ds64, without its table

/// Makes RF64 of a WAV of `data_bytes` of samples, in place: the chunk ds64, which has the lengths, comes to the front, and the
/// reserved chunk goes. libsndfile chooses the format when it opens a file, before the length is known. Returns false
/// for other headers.
bool make_rf64(const std::filesystem::path& path, std::uint64_t data_bytes) {
    constexpr std::uint64_t in_ds64 = 0xFFFFFFFF;
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    std::string head(1 << 16, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    file.clear();
    if (!head.starts_with("RIFF")) return false;
    std::string chunks;
    bool has_room = false;
    std::size_t at = 12;
    for (; at + 8 <= head.size() && head.compare(at, 4, "data") != 0;) {
        const std::size_t length = 8 + word_at(head, at + 4) + word_at(head, at + 4) % 2;
        const bool is_reserved = head.compare(at, 4, reserved) == 0 && word_at(head, at + 4) == reserved_bytes;
        if (is_reserved) has_room = true;
        else chunks += head.substr(at, length);
        at += length;
    }
    if (!has_room || at + 8 > head.size()) return false;
    std::string made = "RF64....WAVEds64" + std::string(4 + reserved_bytes, '\0') + chunks + "data....";
    put_number(in_ds64, 4, made, 4);
    put_number(reserved_bytes, 4, made, 16);
    put_number(std::filesystem::file_size(path) - 8, 8, made, 20);
    put_number(data_bytes, 8, made, 28);
    put_number(in_ds64, 4, made, made.size() - 4);
    if (made.size() != at + 8) return false;
    file.seekp(0);
    file.write(made.data(), static_cast<std::streamsize>(made.size()));
    file.flush();
    return file.good();
}

}  // namespace

struct SoundWriter::File {
    std::filesystem::path path, part;
    SoundHandle handle;
    sf_count_t frames = 0;  // written
    std::uint64_t rf64_from = 0;
    bool is_wav = false;
    std::uint64_t frame_bytes = 0;
    bool has_failed = false;

    ~File() {
        if (!handle) return;
        handle.reset();
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
    }
};

SoundWriter::SoundWriter(std::filesystem::path path, int channels, int rate, SoundFormat format,
                         const std::string& comment, std::uint64_t rf64_from)
    : file_(std::make_unique<File>()) {
    file_->part = path.string() + ".part";
    file_->path = std::move(path);
    SF_INFO info{};
    info.channels = channels;
    info.samplerate = rate;
    info.format = format == SoundFormat::flac ? SF_FORMAT_FLAC | SF_FORMAT_PCM_24 : SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    file_->is_wav = format == SoundFormat::float_wav;
    file_->rf64_from = rf64_from;
    file_->frame_bytes = sizeof(float) * static_cast<std::uint64_t>(channels);
    file_->handle.reset(sf_open(file_->part.c_str(), SFM_WRITE, &info));
    if (!file_->handle) throw Error(fmt::format("{}: cannot write: {}", file_->path.string(), sf_strerror(nullptr)));
    if (file_->is_wav) {
        char room[reserved_bytes] = {};
        SF_CHUNK_INFO chunk{};
        std::copy_n(reserved, 4, chunk.id);
        chunk.id_size = 4;
        chunk.datalen = reserved_bytes;
        chunk.data = room;
        sf_set_chunk(file_->handle.get(), &chunk);
    }
    // The PEAK chunk stores the time of writing. Without it the same samples give the same bytes.
    sf_command(file_->handle.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
    if (!comment.empty()) sf_set_string(file_->handle.get(), SF_STR_COMMENT, comment.c_str());
    if (format == SoundFormat::flac) sf_command(file_->handle.get(), SFC_SET_CLIPPING, nullptr, SF_TRUE);
}

SoundWriter::~SoundWriter() = default;
SoundWriter::SoundWriter(SoundWriter&&) noexcept = default;
SoundWriter& SoundWriter::operator=(SoundWriter&&) noexcept = default;

void SoundWriter::write(const float* samples, std::size_t frames) {
    const auto wanted = static_cast<sf_count_t>(frames);
    const sf_count_t written = sf_writef_float(file_->handle.get(), samples, wanted);
    file_->frames += std::max<sf_count_t>(written, 0);
    if (written == wanted) return;
    file_->has_failed = true;
    const std::string why = sf_strerror(file_->handle.get());
    keep_whole_frames(file_->handle.get(), file_->frames);
    throw Error(fmt::format("{}: cannot write: {}", file_->path.string(), why));
}

void SoundWriter::finish() {
    if (file_->has_failed && file_->frames == 0) {
        file_.reset();
        return;
    }
    sf_write_sync(file_->handle.get());
    bool failed = sf_error(file_->handle.get()) != SF_ERR_NO_ERROR || sf_close(file_->handle.release()) != 0;
    // On a failing disk the header cannot be updated either, which libsndfile does not report.
    failed = failed || (file_->has_failed && frames_in(file_->part) != file_->frames);
    if (!failed && file_->is_wav && std::filesystem::file_size(file_->part) >= file_->rf64_from)
        failed = !make_rf64(file_->part, static_cast<std::uint64_t>(file_->frames) * file_->frame_bytes) ||
                 frames_in(file_->part) != file_->frames;
    if (failed)
        throw Error(fmt::format("{}: the sound could not be completed; is the disk full? The part is in {}",
                                file_->path.string(), file_->part.string()));
    std::error_code failure;
    std::filesystem::rename(file_->part, file_->path, failure);
    if (failure)
        throw Error(fmt::format("{}: cannot be renamed to {}: {}", file_->part.string(), file_->path.string(),
                                failure.message()));
}

}  // namespace tactus::sound
