// SPDX-License-Identifier: Apache-2.0
// Sounds as the formats allow them, written byte by byte: widths, byte orders, floating-point numbers, extensible waves, AIFC.
#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "assets/sound/sound_reader.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string number_of(std::uint64_t value, int bytes, bool big) {
    std::string out;
    for (int n = 0; n < bytes; ++n) out += static_cast<char>(value >> (8 * (big ? bytes - 1 - n : n)) & 0xff);
    return out;
}

std::string piece(const std::string& name, const std::string& bytes, bool big) {
    return name + number_of(bytes.size(), 4, big) + bytes + std::string(bytes.size() % 2, '\0');
}

/// Multiples of 1/8: every width holds them.
double value_of(std::size_t n) { return (static_cast<double>(n * 5 % 15) - 7.0) / 8.0; }
constexpr std::size_t frame_count = 400;

/// Whole numbers of `bits` at the top of `bytes`, or floating-point numbers for 0 bits; unsigned for one byte of a wave.
std::string samples_of(int bytes, int bits, bool big, int channels = 1, bool is_unsigned = false) {
    std::string out;
    for (std::size_t n = 0; n < frame_count * static_cast<std::size_t>(channels); ++n) {
        const double x = value_of(n);
        std::uint64_t raw = 0;
        if (bits == 0)
            raw = bytes == 4 ? std::bit_cast<std::uint32_t>(static_cast<float>(x)) : std::bit_cast<std::uint64_t>(x);
        else
            raw = static_cast<std::uint64_t>(static_cast<std::int64_t>(x * std::ldexp(1.0, bits - 1)))
                  << (8 * bytes - bits);
        if (is_unsigned) raw += 128;
        out += number_of(raw, bytes, big);
    }
    return out;
}

std::string format_piece(int tag, int channels, int bytes, bool big, const std::string& more = {}) {
    return number_of(static_cast<std::uint64_t>(tag), 2, big) +
           number_of(static_cast<std::uint64_t>(channels), 2, big) + number_of(8000, 4, big) +
           number_of(static_cast<std::uint64_t>(8000 * channels * bytes), 4, big) +
           number_of(static_cast<std::uint64_t>(channels * bytes), 2, big) +
           number_of(static_cast<std::uint64_t>(8 * bytes), 2, big) + more;
}

std::string extension_of(int tag, int bits) {
    return number_of(22, 2, false) + number_of(static_cast<std::uint64_t>(bits), 2, false) + number_of(0, 4, false) +
           number_of(static_cast<std::uint64_t>(tag), 2, false) +
           std::string("\0\0\0\0\x10\0\x80\0\0\xaa\0\x38\x9b\x71", 14);
}

std::string wave_of(const std::string& format, const std::string& samples, bool big = false) {
    const std::string body = "WAVE" + piece("fmt ", format, big) + piece("data", samples, big);
    return (big ? "RIFX" : "RIFF") + number_of(body.size(), 4, big) + body;
}

std::string aifc_of(const std::string& kind, int bits, const std::string& samples) {
    // 8000 Hz as a number of 80 bits.
    const std::string rate("\x40\x0b\xfa\0\0\0\0\0\0\0", 10);
    std::string about = number_of(1, 2, true) + number_of(frame_count, 4, true) +
                        number_of(static_cast<std::uint64_t>(bits), 2, true) + rate;
    if (!kind.empty()) about += kind + std::string("\0\0", 2);
    const std::string body = (kind.empty() ? "AIFF" : "AIFC" + piece("FVER", number_of(0xa2805140, 4, true), true)) +
                             piece("COMM", about, true) + piece("SSND", std::string(8, '\0') + samples, true);
    return "FORM" + number_of(body.size(), 4, true) + body;
}

struct SoundFiles {
    TemporaryFolder folder;

    std::vector<double> read(const std::string& name, const std::string& bytes) const {
        file::write_whole_file(folder / name, bytes);
        sound::SoundReader reader(folder / name);
        CHECK(reader.rate() == 8000.0);
        std::vector<double> all(reader.frames() * reader.channels());
        all.resize(reader.read(all.data(), reader.frames()) * reader.channels());
        return all;
    }
    void check(const std::string& name, const std::string& bytes, int channels = 1) const {
        CAPTURE(name);
        const std::vector<double> values = read(name, bytes);
        REQUIRE(values.size() == frame_count * static_cast<std::size_t>(channels));
        for (std::size_t n = 0; n < values.size(); ++n) REQUIRE(values[n] == value_of(n));
    }
};

struct SoundCase {
    std::string name, bytes;
    int channels = 1;
};

std::vector<SoundCase> wave_cases() {
    std::vector<SoundCase> cases;
    for (const int channels : {1, 2})
        for (const auto& [name, tag, bytes, bits] : {std::tuple{"i8", 1, 1, 8},
                                                     {"i16", 1, 2, 16},
                                                     {"i24", 1, 3, 24},
                                                     {"i32", 1, 4, 32},
                                                     {"f32", 3, 4, 0},
                                                     {"f64", 3, 8, 0}})
            cases.push_back({fmt::format("{}_{}.wav", name, channels),
                             wave_of(format_piece(tag, channels, bytes, false),
                                     samples_of(bytes, bits, false, channels, bytes == 1)),
                             channels});
    cases.push_back({"rifx.wav", wave_of(format_piece(1, 1, 2, true), samples_of(2, 16, true), true), 1});
    return cases;
}

}  // namespace

TEST_CASE("waves of every width and byte order, extensible or not, hold the same numbers") {
    const SoundFiles files;
    for (const SoundCase& one : wave_cases()) files.check(one.name, one.bytes, one.channels);
    for (const auto& [name, tag, bytes, bits, valid] : {std::tuple{"16", 1, 2, 16, 16},
                                                        {"24in32", 1, 4, 24, 24},
                                                        {"20in24", 1, 3, 20, 20},
                                                        {"12in16", 1, 2, 12, 12},
                                                        {"float", 3, 4, 0, 32},
                                                        {"double", 3, 8, 0, 64},
                                                        {"unstated", 1, 2, 16, 0}})
        files.check(
            fmt::format("extensible_{}.wav", name),
            wave_of(format_piece(0xfffe, 1, bytes, false, extension_of(tag, valid)), samples_of(bytes, bits, false)));
}

TEST_CASE("AIFF and AIFC in either byte order, whole or floating-point, hold the same numbers") {
    const SoundFiles files;
    files.check("plain.aiff", aifc_of("", 16, samples_of(2, 16, true)));
    files.check("none.aifc", aifc_of("NONE", 16, samples_of(2, 16, true)));
    files.check("sowt.aifc", aifc_of("sowt", 16, samples_of(2, 16, false)));
    files.check("23ni.aifc", aifc_of("23ni", 32, samples_of(4, 32, false)));
    files.check("in24.aifc", aifc_of("in24", 24, samples_of(3, 24, true)));
    for (const char* const kind : {"fl32", "FL32"})
        files.check(fmt::format("{}.aifc", kind), aifc_of(kind, 32, samples_of(4, 0, true)));
    files.check("fl64.aifc", aifc_of("fl64", 64, samples_of(8, 0, true)));
}

TEST_CASE("sounds whose header has no rate, no channels or two chunks of samples are refused in one sentence") {
    const SoundFiles files;
    const std::string good = wave_of(format_piece(1, 1, 2, false), samples_of(2, 16, false));
    std::string no_rate = good, no_channels = good;
    no_rate.replace(24, 4, 4, '\0');
    no_channels.replace(22, 2, 2, '\0');
    CHECK_THROWS_WITH(files.read("a.wav", no_rate), ContainsSubstring("a.wav: "));
    CHECK_THROWS_WITH(files.read("a.wav", no_channels), ContainsSubstring("a.wav: "));
    const std::string body = "WAVE" + piece("fmt ", format_piece(1, 1, 2, false), false) +
                             piece("data", samples_of(2, 16, false), false) +
                             piece("data", samples_of(2, 16, false), false);
    CHECK_THROWS_WITH(files.read("a.wav", "RIFF" + number_of(body.size(), 4, false) + body),
                      ContainsSubstring("its header is damaged"));
}

TEST_CASE("room behind the samples of a WAV that was reserved and not needed is no sound") {
    const SoundFiles files;
    const std::string wave = wave_of(format_piece(1, 1, 2, false), samples_of(2, 16, false));
    file::write_whole_file(files.folder / "whole.wav", wave);
    const auto frames = sound::SoundReader(files.folder / "whole.wav").frames();
    for (const char padding : {'\0', '\xff'}) {
        file::write_whole_file(files.folder / "padded.wav", wave + std::string(100000, padding));
        CHECK(sound::SoundReader(files.folder / "padded.wav").frames() == frames);
    }
}

TEST_CASE("an AIFF or AU that is cut is read to the cut with a note, and a chunk without padding is passed") {
    const SoundFiles files;
    const auto note_of = [&](const std::string& name, const std::string& bytes) {
        file::write_whole_file(files.folder / name, bytes);
        return sound::SoundReader(files.folder / name).note();
    };
    const std::string aiff = aifc_of("", 16, samples_of(2, 16, true)), samples = samples_of(2, 16, true),
                      au = ".snd" + number_of(24, 4, true) + number_of(samples.size(), 4, true) +
                           number_of(3, 4, true) + number_of(8000, 4, true) + number_of(1, 4, true) + samples;
    for (const auto& [name, whole] : {std::pair{"a.aiff", aiff}, {"a.au", au}}) {
        CAPTURE(name);
        CHECK(note_of(name, whole).empty());
        CHECK_THAT(note_of(name, whole.substr(0, whole.size() - 300)), ContainsSubstring("cut short"));
    }
    // A size that is too small: what it does not count may be samples.
    std::string short_au = au, short_aiff = aiff;
    short_au.replace(8, 4, number_of(200, 4, true));
    short_aiff.replace(short_aiff.find("SSND") + 4, 4, number_of(208, 4, true));
    short_aiff.replace(short_aiff.find("COMM") + 10, 4, number_of(100, 4, true));
    for (const auto& [name, bytes] : {std::pair{"c.aiff", short_aiff}, {"c.au", short_au}}) {
        CAPTURE(name);
        CHECK_THAT(note_of(name, bytes), ContainsSubstring("the rest was not read"));
        CHECK_THAT(sound::load_sound(files.folder / name).note, ContainsSubstring("the rest was not read"));
    }
    CHECK(note_of("d.aiff", aiff + piece("NAME", "four", true)).empty());
    std::string longer = aiff;  // 8 bytes more in the header than there are
    longer.replace(4, 4, number_of(aiff.size(), 4, true));
    CHECK(note_of("b.aiff", longer).empty());
    const std::string wave = wave_of(format_piece(1, 1, 2, false), samples_of(2, 16, false));
    std::string unpadded = wave;
    unpadded.insert(12, "LIST" + number_of(3, 4, false) + "abc");
    unpadded.replace(4, 4, number_of(unpadded.size() - 8, 4, false));
    files.check("a.wav", unpadded);
    CHECK_THAT(note_of("a.wav", unpadded), ContainsSubstring("padding"));
}

TEST_CASE("scipy reads the same rate and numbers from waves", "[slow]") {
    if (std::system("/usr/bin/python3 -c 'import scipy' >/dev/null 2>&1") != 0)
        return test::skip("there is no scipy (package python3-scipy)");
    const SoundFiles files;
    std::string names;
    std::vector<double> sums;
    for (const SoundCase& one : wave_cases()) {
        double sum = 0.0;
        const std::vector<double> values = files.read(one.name, one.bytes);
        for (std::size_t n = 0; n < values.size(); ++n) sum += values[n] * static_cast<double>(n % 11);
        sums.push_back(sum);
        names += " " + (files.folder / one.name).string();
    }
    // Whole numbers count by their width; scipy has those of 24 bits in 32, and bytes around 128.
    file::write_whole_file(files.folder / "read.py",
                           "import sys, numpy\nfrom scipy.io import wavfile\nfor name in sys.argv[1:]:\n"
                           " rate, x = wavfile.read(name)\n y = x.astype(float).reshape(-1)\n"
                           " if x.dtype == numpy.uint8: y = (y - 128) / 128\n"
                           " elif x.dtype.kind == 'i': y = y / 2.0 ** (8 * x.dtype.itemsize - 1)\n"
                           " print(rate, (y * (numpy.arange(y.size) % 11)).sum())\n");
    const std::string command = fmt::format("/usr/bin/python3 {}{} > {}", (files.folder / "read.py").string(), names,
                                            (files.folder / "said.txt").string());
    REQUIRE(std::system(command.c_str()) == 0);
    std::istringstream said(file::read_whole_file(files.folder / "said.txt"));
    for (const double wanted : sums) {
        double rate = 0.0, sum = 0.0;
        REQUIRE(said >> rate >> sum);
        CHECK(rate == 8000.0);
        CHECK(sum == Approx(wanted).margin(1e-9));
    }
}
