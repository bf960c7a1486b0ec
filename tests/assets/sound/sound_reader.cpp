// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/sound_reader.hpp"

#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <sndfile.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

struct TemporarySound {
    fs::path path;
    explicit TemporarySound(const char* name)
        : path(fs::temp_directory_path() / fmt::format("tactus_{}_{}", ::getpid(), name)) {}
    ~TemporarySound() { fs::remove(path); }
};

void write(const fs::path& path, int format, int channels, int rate, const std::vector<double>& samples) {
    SF_INFO info{};
    info.format = format;
    info.channels = channels;
    info.samplerate = rate;
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    REQUIRE(file);
    sf_writef_double(file, samples.data(), static_cast<sf_count_t>(samples.size()) / channels);
    sf_close(file);
}

std::vector<double> read_all(const fs::path& path, std::size_t piece) {
    sound::SoundReader reader(path);
    std::vector<double> all, part(piece * reader.channels());
    while (const std::size_t count = reader.read(part.data(), piece))
        all.insert(all.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count * reader.channels()));
    return all;
}

} // namespace

TEST_CASE(
    "sounds of every container, width, rate and number of channels are "
    "read in pieces") {
    struct Case {
        const char* name;
        int format, channels, rate;
        double step; // of the numbers in the file
    };
    for (const auto& [name, format, channels, rate, step] :
         {Case{"8.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_U8, 1, 3000, 1.0 / 128},
          Case{"24.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_24, 7, 48000, 1.2e-7},
          Case{"f.w64", SF_FORMAT_W64 | SF_FORMAT_FLOAT, 2, 192000, 1e-7},
          Case{"d.caf", SF_FORMAT_CAF | SF_FORMAT_DOUBLE, 1, 44100, 0.0},
          Case{"16.aiff", SF_FORMAT_AIFF | SF_FORMAT_PCM_16, 2, 11025, 3.1e-5},
          Case{"24.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_24, 3, 96000, 1.2e-7}}) {
        CAPTURE(name);
        const TemporarySound file(name);
        std::vector<double> samples(static_cast<std::size_t>(channels) * 1000);
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = 0.9 * std::sin(0.1 * static_cast<double>(i));
        write(file.path, format, channels, rate, samples);
        const sound::SoundReader reader(file.path);
        CHECK(reader.rate() == rate);
        CHECK(reader.channels() == static_cast<std::size_t>(channels));
        const std::vector<double> got = read_all(file.path, 77);
        REQUIRE(got.size() == samples.size());
        double worst = 0.0;
        for (std::size_t i = 0; i < got.size(); ++i) worst = std::max(worst, std::abs(got[i] - samples[i]));
        CHECK(worst <= 2.0 * step);
    }
}

TEST_CASE("floats above full scale stay as they are, and a NaN names its place") {
    const TemporarySound file("loud.wav");
    write(file.path, SF_FORMAT_WAV | SF_FORMAT_DOUBLE, 1, 1000, {0.0, 3.5, -7.25});
    CHECK(read_all(file.path, 2) == std::vector{0.0, 3.5, -7.25});
    write(file.path, SF_FORMAT_WAV | SF_FORMAT_DOUBLE, 1, 1000,
          {0.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 0.0});
    CHECK_THROWS_WITH(read_all(file.path, 2),
                      Catch::Matchers::ContainsSubstring("NaN") && Catch::Matchers::ContainsSubstring("0.002 s"));
}

TEST_CASE("sounds that are cut short, empty or no sound are refused") {
    const TemporarySound file("short.wav");
    write(file.path, SF_FORMAT_WAV | SF_FORMAT_PCM_16, 1, 1000, std::vector<double>(1000));
    const TemporarySound flac("short.flac");
    std::vector<double> noise(50000);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = std::sin(static_cast<double>(i * i % 1013));
    write(flac.path, SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 1, 1000, noise);
    fs::resize_file(flac.path, fs::file_size(flac.path) / 2);
    CHECK_THROWS_AS(read_all(flac.path, 1000), Error);
    write(file.path, SF_FORMAT_WAV | SF_FORMAT_PCM_16, 1, 1000, {});
    CHECK_THROWS_WITH(sound::SoundReader(file.path), Catch::Matchers::ContainsSubstring("empty"));
    std::ofstream(file.path) << "this is no sound";
    CHECK_THROWS_WITH(sound::SoundReader(file.path), Catch::Matchers::ContainsSubstring("cannot be read as sound"));
    CHECK_THROWS_WITH(sound::SoundReader("/nowhere.wav"), Catch::Matchers::ContainsSubstring("no such sound file"));
}
