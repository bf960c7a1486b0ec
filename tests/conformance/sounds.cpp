// SPDX-License-Identifier: Apache-2.0
// Sounds: formats written by libsndfile, and waves with the headers of broken recorders.
#include "assets/file/whole_file.hpp"
#include "tests/conformance/cases.hpp"

#include <sndfile.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace tactus::conformance {

namespace {

using namespace nlohmann::literals;
using Bytes = std::string;

constexpr double turn = 6.283185307179586, rate = 8000.0, tone = 100.0, level = 0.5;
constexpr std::size_t frame_count = 8000;

double sample(std::size_t n) { return level * std::sin(turn * tone * double(n) / rate); }

std::function<void(const fs::path&)> sound(int format, int channels = 1, int sample_rate = int(rate)) {
    return [=](const fs::path& path) {
        SF_INFO info{};
        info.format = format, info.channels = channels, info.samplerate = sample_rate;
        SNDFILE* const file = sf_open(path.c_str(), SFM_WRITE, &info);
        if (!file) throw std::runtime_error(fmt::format("libsndfile cannot write {}", path.string()));
        std::vector<double> samples;
        for (std::size_t n = 0; n < frame_count; ++n)
            for (int c = 0; c < channels; ++c) samples.push_back(sample(n));
        sf_writef_double(file, samples.data(), sf_count_t(frame_count));
        sf_close(file);
    };
}

Check is_tone(double relative, double seconds = 1.0, double of_rate = rate) {
    return [=](const Json& found) {
        const Json& row = found["rows"][0];
        if (auto fault = differs("the rate", row["sample_rate_hz"], of_rate); !fault.empty()) return fault;
        if (auto fault = differs("the duration", row["duration_s"], seconds, 1e-2); !fault.empty()) return fault;
        for (const Json& channel : row["channels"])
            if (auto fault = differs("the rms", channel["rms"], level / std::sqrt(2.0), relative); !fault.empty())
                return fault;
        return std::string();
    };
}

Bytes little(std::uint64_t number, int size) {
    Bytes out;
    for (int n = 0; n < size; ++n) out += char(number >> (8 * n) & 0xff);
    return out;
}

Bytes samples() {
    Bytes out;
    for (std::size_t n = 0; n < frame_count; ++n)
        out += little(std::uint64_t(std::int64_t(std::lround(sample(n) * 32767.0))), 2);
    return out;
}

Bytes format_chunk(std::uint64_t of_rate = 8000, std::uint64_t channels = 1) {
    return "fmt " + little(16, 4) + little(1, 2) + little(channels, 2) + little(of_rate, 4) + little(of_rate * 2, 4) +
           little(2, 2) + little(16, 2);
}
Bytes chunk(const Bytes& name, std::uint64_t size, const Bytes& content) { return name + little(size, 4) + content; }

/// Sizes of the whole and of the samples as the header states them.
Bytes wave(std::uint64_t whole, std::uint64_t size, const Bytes& content = samples()) {
    return "RIFF" + little(whole, 4) + "WAVE" + format_chunk() + chunk("data", size, content);
}
Bytes riff(const Bytes& body) { return "RIFF" + little(body.size(), 4) + body; }

std::function<void(const fs::path&)> cut(const std::function<void(const fs::path&)>& write) {
    return [=](const fs::path& path) {
        write(path);
        const Bytes whole = file::read_whole_file(path);
        file::write_whole_file(path, whole.substr(0, whole.size() / 2));
    };
}

std::string file_note(const Json& found) {
    const Json note = found.value("/rows/0/calibration/file_note"_json_pointer, Json());
    return note.is_string() ? note.get<std::string>() : "";
}

Format waves() {
    const std::uint64_t size = 2 * frame_count, whole = 36 + size;
    const Bytes not_a_number = [] {
        Bytes out;
        for (int n = 0; n < 8000; ++n) out += n == 77 ? Bytes("\0\0\xc0\x7f", 4) : Bytes(4, '\0');
        return riff("WAVEfmt " + little(16, 4) + little(3, 2) + little(1, 2) + little(8000, 4) + little(32000, 4) +
                    little(4, 2) + little(32, 2) + chunk("data", out.size(), out));
    }();
    return {
        "WAV",
        {"spectrum", "FILE", "--json"},
        {},
        is_tone(1e-3),
        {
            {"8 bits, unsigned", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_PCM_U8), Result::read, "", {}, is_tone(2e-2)},
            {"16 bits", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_PCM_16)},
            {"24 bits", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_PCM_24)},
            {"32 bits", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_PCM_32)},
            {"floating-point, 32 bits", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_FLOAT)},
            {"floating-point, 64 bits", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_DOUBLE)},
            {"extensible, six channels", "a.wav", sound(SF_FORMAT_WAVEX | SF_FORMAT_PCM_24, 6)},
            {"big endian (RIFX)", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_PCM_16 | SF_ENDIAN_BIG)},
            {"mu-law", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_ULAW), Result::read, "", {}, is_tone(2e-2)},
            {"A-law", "a.wav", sound(SF_FORMAT_WAV | SF_FORMAT_ALAW), Result::read, "", {}, is_tone(2e-2)},
            {"ADPCM of IMA",
             "a.wav",
             sound(SF_FORMAT_WAV | SF_FORMAT_IMA_ADPCM),
             Result::read,
             "",
             {},
             is_tone(3e-2, 1.01)},
            {"100 kHz",
             "a.wav",
             sound(SF_FORMAT_WAV | SF_FORMAT_PCM_16, 1, 100000),
             Result::read,
             "",
             {},
             is_tone(1e-3, 0.08, 100000.0)},
            {"sizes of 0, as after a crash", "a.wav", bytes(wave(0, 0)), Result::note, "not finished"},
            {"a size of samples that is 0", "a.wav", bytes(wave(whole, 0)), Result::note, "the file has"},
            {"the largest sizes, as of a stream", "a.wav", bytes(wave(0xffffffff, 0xffffffff)), Result::note,
             "the file has"},
            {"sizes of INT32_MAX", "a.wav", bytes(wave(0x7fffffff, 0x7fffffff)), Result::note, "the file has"},
            {"a whole size that is wrong by 8", "a.wav", bytes(wave(whole + 8, size)), Result::note, "the file has"},
            {"a size of samples that is too small", "a.wav", bytes(wave(36 + size / 10, size / 10)), Result::note,
             "read as samples"},
            {"cut short",
             "a.wav",
             bytes(wave(whole, size, samples().substr(0, size / 2 + 1))),
             Result::note,
             "cut short",
             {},
             is_tone(1e-2, 0.5)},
            {"samples before their format", "a.wav",
             bytes(riff("WAVE" + chunk("data", size, samples()) + format_chunk())), Result::note,
             "before their format"},
            {"no samples", "a.wav", bytes(wave(36, 0, "")), Result::refused, "empty"},
            {"a rate of 0", "a.wav", bytes(riff("WAVE" + format_chunk(0) + chunk("data", size, samples()))),
             Result::refused, "a.wav"},
            {"no channels", "a.wav", bytes(riff("WAVE" + format_chunk(8000, 0) + chunk("data", size, samples()))),
             Result::refused, "a.wav"},
            {"two chunks of samples", "a.wav",
             bytes(riff("WAVE" + format_chunk() + chunk("data", size, samples()) + chunk("data", size, samples()))),
             Result::refused, "damaged"},
            {"a sample that is not a number", "a.wav", bytes(not_a_number), Result::refused, "a.wav"},
        }};
}

Format long_waves() {
    return {"RF64, W64",
            {"spectrum", "FILE", "--json"},
            {},
            is_tone(1e-3),
            {{"RF64", "a.wav", sound(SF_FORMAT_RF64 | SF_FORMAT_PCM_16)},
             {"RF64 that was not finished", "a.wav",
              bytes("RF64" + little(0xffffffff, 4) + "WAVE" + chunk("ds64", 28, Bytes(28, '\0')) + format_chunk() +
                    chunk("data", 0xffffffff, samples())),
              Result::note, "not finished"},
             {"W64, cut short",
              "a.w64",
              cut(sound(SF_FORMAT_W64 | SF_FORMAT_PCM_16)),
              Result::note,
              "cut short",
              {},
              is_tone(2e-2, 0.5)},
             {"W64", "a.w64", sound(SF_FORMAT_W64 | SF_FORMAT_PCM_16)}}};
}

Format others() {
    return {"others",
            {"spectrum", "FILE", "--json"},
            {},
            is_tone(1e-3),
            {
                {"AIFF, in capitals (`A.AIFF`)", "A.AIFF", sound(SF_FORMAT_AIFF | SF_FORMAT_PCM_16)},
                {"AIFC, little endian", "a.aifc", sound(SF_FORMAT_AIFF | SF_FORMAT_PCM_16 | SF_ENDIAN_LITTLE)},
                {"AIFC, floating-point", "a.aifc", sound(SF_FORMAT_AIFF | SF_FORMAT_FLOAT)},
                {"AIFF, cut short",
                 "a.aiff",
                 cut(sound(SF_FORMAT_AIFF | SF_FORMAT_PCM_16)),
                 Result::note,
                 "cut short",
                 {},
                 is_tone(2e-2, 0.5)},
                {"CAF", "a.caf", sound(SF_FORMAT_CAF | SF_FORMAT_PCM_24)},
                {"CAF, cut short", "a.caf", cut(sound(SF_FORMAT_CAF | SF_FORMAT_PCM_24)), Result::refused, "malformed"},
                {"AU, cut short",
                 "a.au",
                 cut(sound(SF_FORMAT_AU | SF_FORMAT_PCM_16)),
                 Result::note,
                 "cut short",
                 {},
                 is_tone(2e-2, 0.5)},
                {"AU, a size of samples that is too small",
                 "a.au",
                 [](const fs::path& path) {
                     sound(SF_FORMAT_AU | SF_FORMAT_PCM_16)(path);
                     Bytes whole = file::read_whole_file(path);
                     whole.replace(8, 4, Bytes("\0\0\x06\x40", 4));
                     file::write_whole_file(path, whole);
                 },
                 Result::note,
                 "the rest was not read",
                 {},
                 is_tone(2e-2, 0.1)},
                {"AU", "a.au", sound(SF_FORMAT_AU | SF_FORMAT_PCM_16)},
                {"FLAC", "a.flac", sound(SF_FORMAT_FLAC | SF_FORMAT_PCM_24)},
                {"FLAC, cut short", "a.flac", cut(sound(SF_FORMAT_FLAC | SF_FORMAT_PCM_24)), Result::refused, "a.flac"},
                {"Ogg Vorbis", "a.ogg", sound(SF_FORMAT_OGG | SF_FORMAT_VORBIS), Result::read, "", {}, is_tone(5e-2)},
                {"Ogg Opus", "a.opus", sound(SF_FORMAT_OGG | SF_FORMAT_OPUS), Result::read, "", {}, is_tone(5e-2)},
                {"Ogg, cut short", "a.ogg", cut(sound(SF_FORMAT_OGG | SF_FORMAT_VORBIS)), Result::refused, "a.ogg"},
                {"text", "a.wav", bytes("no sound\n"), Result::refused, "a.wav"},
                {"an empty file", "a.wav", bytes(""), Result::refused, "a.wav"},
            }};
}

}  // namespace

Table sound_table() {
    Table table{"sounds", {waves(), long_waves(), others()}};
    for (Format& format : table.formats)
        format.notes = [](const Json& found) {
            const std::string note = file_note(found);
            return note.empty() ? std::vector<std::string>{} : std::vector{note};
        };
    return table;
}

}  // namespace tactus::conformance
