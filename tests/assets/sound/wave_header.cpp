// SPDX-License-Identifier: Apache-2.0
// Waves as recorders leave them after a crash, and as programs write them against the standard.
#include "assets/sound/wave_header.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "assets/sound/sound_reader.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string little(std::uint64_t number, int bytes) {
    std::string out;
    for (int n = 0; n < bytes; ++n) out += static_cast<char>(number >> (8 * n) & 0xff);
    return out;
}

std::string chunk_of(const std::string& name, std::uint64_t size, const std::string& bytes) {
    return name + little(size, 4) + bytes;
}

/// 16 bits, two channels, 8 kHz.
const std::string wave_format =
    little(1, 2) + little(2, 2) + little(8000, 4) + little(32000, 4) + little(4, 2) + little(16, 2);

std::string samples_of_wave() {
    std::string out;
    for (int n = 0; n < 500; ++n)
        out += little(static_cast<std::uint64_t>(n * 30), 2) + little(static_cast<std::uint64_t>(-n * 20), 2);
    return out;
}

/// Sizes of the whole and of the samples as the header states them.
std::string wave_bytes(std::uint64_t riff, std::uint64_t data, const std::string& samples) {
    return "RIFF" + little(riff, 4) + "WAVE" + chunk_of("fmt ", 16, wave_format) + chunk_of("data", data, samples);
}

struct WaveFile {
    std::filesystem::path path = std::filesystem::temp_directory_path() / fmt::format("tactus-wave-{}.wav", ::getpid());
    ~WaveFile() { std::filesystem::remove(path); }
};

std::vector<double> frames_of(const std::filesystem::path& path, std::string* note = nullptr) {
    sound::SoundReader reader(path);
    if (note) *note = reader.note();
    std::vector<double> all(reader.frames() * reader.channels() + 64);
    std::size_t count = 0;
    for (std::size_t got; (got = reader.read(all.data() + count * 2, 16)) > 0;) count += got;
    all.resize(count * 2);
    return all;
}

}  // namespace

TEST_CASE("whatever sizes the header of a wave states, all samples that the file has are read, with a note") {
    const WaveFile file;
    const std::string samples = samples_of_wave();
    const std::uint64_t whole = 36 + samples.size();
    file::write_whole_file(file.path, wave_bytes(whole, samples.size(), samples));
    const std::vector<double> right = frames_of(file.path);
    REQUIRE(right.size() == 1000);
    CHECK_FALSE(sound::repaired_wave_header(file.path));
    for (const auto& [riff, data] :
         std::vector<std::pair<std::uint64_t, std::uint64_t>>{{whole + 8, samples.size()},
                                                              {0, 0},
                                                              {whole, 0},
                                                              {0xffffffff, 0xffffffff},
                                                              {0x7fffffff, 0x7fffffff},
                                                              {36, 0},
                                                              {whole + 24, samples.size() + 24}}) {
        CAPTURE(riff, data);
        file::write_whole_file(file.path, wave_bytes(riff, data, samples));
        std::string note;
        CHECK(frames_of(file.path, &note) == right);
        CHECK_FALSE(note.empty());
        CHECK(sound::load_sound(file.path).frames == 500);
    }
}

TEST_CASE("samples behind a stated size that is too small are read with a note, chunks and tags there are none") {
    const WaveFile file;
    const std::string samples = samples_of_wave();
    file::write_whole_file(file.path, wave_bytes(36 + samples.size(), samples.size(), samples));
    const std::vector<double> right = frames_of(file.path);
    std::string note;
    for (const std::uint64_t stated : {200u, 201u, 1000u}) {
        CAPTURE(stated);
        file::write_whole_file(file.path, wave_bytes(36 + stated, stated, samples));
        CHECK(frames_of(file.path, &note) == right);
        CHECK_THAT(note,
                   ContainsSubstring(fmt::format("states {} bytes", stated)) && ContainsSubstring("read as samples"));
        CHECK(sound::load_sound(file.path).note == note);
    }
    for (const std::string& behind : {chunk_of("LIST", 12, "INFOICMT    "), chunk_of("abcd", 4, "1234"),
                                      "TAG" + std::string(125, 'x'), std::string(6, '\0')}) {
        CAPTURE(behind);
        file::write_whole_file(file.path,
                               wave_bytes(36 + samples.size() + behind.size(), samples.size(), samples) + behind);
        CHECK(frames_of(file.path, &note) == right);
        CHECK(note.empty());
    }
}

TEST_CASE("a wave that is cut anywhere is read up to its last whole frame") {
    const WaveFile file;
    const std::string samples = samples_of_wave(), bytes = wave_bytes(36 + samples.size(), samples.size(), samples);
    file::write_whole_file(file.path, bytes);
    const std::vector<double> right = frames_of(file.path);
    for (std::size_t length = 49; length < bytes.size(); length += 97) {
        CAPTURE(length);
        file::write_whole_file(file.path, bytes.substr(0, length));
        std::string note;
        const std::vector<double> read = frames_of(file.path, &note);
        CHECK(read == std::vector(right.begin(), right.begin() + static_cast<std::ptrdiff_t>((length - 44) / 4 * 2)));
        CHECK_THAT(note, ContainsSubstring("cut short"));
    }
    file::write_whole_file(file.path, bytes.substr(0, 44));
    CHECK_THROWS_WITH(frames_of(file.path), ContainsSubstring("empty"));
}

TEST_CASE("samples before their format, an unfinished RF64 and an empty wave with a comment are told apart") {
    const WaveFile file;
    const std::string samples = samples_of_wave();
    file::write_whole_file(file.path, wave_bytes(36 + samples.size(), samples.size(), samples));
    const std::vector<double> right = frames_of(file.path);
    std::string note;
    file::write_whole_file(file.path, "RIFF" + little(36 + samples.size(), 4) + "WAVE" +
                                          chunk_of("data", samples.size(), samples) +
                                          chunk_of("fmt ", 16, wave_format));
    CHECK(frames_of(file.path, &note) == right);
    CHECK_THAT(note, ContainsSubstring("before their format"));
    file::write_whole_file(file.path, "RF64" + little(0xffffffff, 4) + "WAVE" +
                                          chunk_of("ds64", 28, std::string(28, '\0')) +
                                          chunk_of("fmt ", 16, wave_format) + chunk_of("data", 0xffffffff, samples));
    CHECK(frames_of(file.path, &note) == right);
    CHECK_THAT(note, ContainsSubstring("not finished"));
    file::write_whole_file(file.path, wave_bytes(56, 0, chunk_of("LIST", 12, "INFOICMT    ")));
    CHECK_THROWS_WITH(frames_of(file.path), ContainsSubstring("empty"));
}
