// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/sound.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound_reader.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::vector<float> ramp_samples(std::size_t count) {
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = std::sin(0.01f * static_cast<float>(i)) * 0.75f;
    return out;
}

void write(const std::filesystem::path& path, const std::vector<float>& samples, int channels = 1,
           sound::SoundFormat format = sound::SoundFormat::float_wav) {
    sound::SoundWriter writer(path, channels, 48000, format);
    writer.write(samples.data(), samples.size() / static_cast<std::size_t>(channels));
    writer.finish();
}

}  // namespace

TEST_CASE("a float WAV comes back bit for bit, also beyond full scale") {
    const TemporaryFolder folder;
    std::vector<float> samples = ramp_samples(9600);
    samples[17] = 3.5f;
    write(folder / "a.wav", samples, 2);
    const sound::Sound sound = sound::load_sound(folder / "a.wav");
    CHECK(sound.rate == 48000);
    CHECK(sound.channels == 2);
    CHECK(sound.frames == 4800);
    CHECK(sound.duration() == Approx(0.1));
    CHECK(sound.samples == samples);
}

TEST_CASE("FLAC keeps 24 bits and cuts at full scale") {
    const TemporaryFolder folder;
    std::vector<float> samples = ramp_samples(9600);
    samples[17] = 3.5f;
    samples[18] = -3.5f;
    write(folder / "a.flac", samples, 1, sound::SoundFormat::flac);
    const sound::Sound sound = sound::load_sound(folder / "a.flac");
    REQUIRE(sound.samples.size() == samples.size());
    CHECK(sound.samples[17] == Approx(1.0f).margin(1e-6));
    CHECK(sound.samples[18] == Approx(-1.0f).margin(1e-6));
    float worst = 0.0f;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (i != 17 && i != 18) worst = std::max(worst, std::abs(sound.samples[i] - samples[i]));
    CHECK(worst < 1.0f / (1 << 23));
}

TEST_CASE("the same samples give the same bytes") {
    const TemporaryFolder folder;
    for (const auto format : {sound::SoundFormat::float_wav, sound::SoundFormat::flac}) {
        write(folder / "a", ramp_samples(5000), 1, format);
        write(folder / "b", ramp_samples(5000), 1, format);
        const std::string bytes = file::read_whole_file(folder / "a");
        CHECK(bytes == file::read_whole_file(folder / "b"));
        CHECK(bytes.find("PEAK") == std::string::npos);
    }
}

TEST_CASE("an unfinished sound leaves no file, and until it is finished the old one stays") {
    const TemporaryFolder folder;
    write(folder / "a.wav", ramp_samples(100));
    {
        sound::SoundWriter writer(folder / "a.wav", 1, 48000);
        writer.write(ramp_samples(5000).data(), 5000);
        CHECK(sound::load_sound(folder / "a.wav").frames == 100);
    }
    CHECK(sound::load_sound(folder / "a.wav").frames == 100);
    CHECK_FALSE(std::filesystem::exists(folder / "a.wav.part"));
}

TEST_CASE("a FLAC that lost its tail is refused, a WAV is read up to the cut") {
    const TemporaryFolder folder;
    const std::vector<float> whole = ramp_samples(48000);
    write(folder / "a.wav", whole);
    const auto size = std::filesystem::file_size(folder / "a.wav"), head = size - whole.size() * sizeof(float);
    for (const auto kept : {size - 1, size - 1000, size / 2, size / 10}) {
        write(folder / "a.wav", whole);
        std::filesystem::resize_file(folder / "a.wav", kept);
        INFO("a.wav of " << size << " bytes cut to " << kept);
        const sound::Sound read = sound::load_sound(folder / "a.wav");
        CHECK(read.frames == (kept - head) / sizeof(float));
        CHECK(std::equal(read.samples.begin(), read.samples.end(), whole.begin()));
    }
    write(folder / "a.flac", whole, 1, sound::SoundFormat::flac);
    const auto packed = std::filesystem::file_size(folder / "a.flac");
    for (const auto kept : {packed - 1, packed - 1000, packed / 2, packed / 10}) {
        write(folder / "a.flac", whole, 1, sound::SoundFormat::flac);
        std::filesystem::resize_file(folder / "a.flac", kept);
        INFO("a.flac of " << packed << " bytes cut to " << kept);
        CHECK_THROWS_AS(sound::load_sound(folder / "a.flac"), Error);
    }
}

TEST_CASE("what is no sound is refused with its name") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(sound::load_sound(folder / "none.wav"), ContainsSubstring("none.wav: no such sound file"));
    CHECK_THROWS_WITH(sound::load_sound(folder.path), ContainsSubstring("is a folder"));
    file::write_whole_file(folder / "text.wav", "this is no sound at all, only words");
    CHECK_THROWS_WITH(sound::load_sound(folder / "text.wav"), ContainsSubstring("text.wav: cannot be read as sound"));
    write(folder / "empty.wav", {});
    CHECK_THROWS_WITH(sound::load_sound(folder / "empty.wav"), ContainsSubstring("empty"));
    write(folder / "nan.wav", {0.0f, std::numeric_limits<float>::quiet_NaN()});
    CHECK_THROWS_WITH(sound::load_sound(folder / "nan.wav"), ContainsSubstring("NaN"));
}

TEST_CASE("of a wave whose header promises more than the file holds, the samples that are there are read") {
    const TemporaryFolder folder;
    write(folder / "a.wav", ramp_samples(1000));
    std::string bytes = file::read_whole_file(folder / "a.wav");
    const std::size_t data = bytes.find("data");
    REQUIRE(data != std::string::npos);
    const std::uint32_t claim = 0x7ffffff0u;
    std::memcpy(bytes.data() + data + 4, &claim, 4);
    std::memcpy(bytes.data() + 4, &claim, 4);
    file::write_whole_file(folder / "a.wav", bytes);
    CHECK(sound::load_sound(folder / "a.wav").samples == ramp_samples(1000));
}

TEST_CASE("a full disk and a missing folder are errors, not lost sounds") {
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(sound::SoundWriter(folder / "no/such/a.wav", 1, 48000), ContainsSubstring("cannot write"));
    if (!std::filesystem::exists("/dev/full")) return;
    std::filesystem::create_symlink("/dev/full", folder / "a.wav.part");
    CHECK_THROWS_AS(write(folder / "a.wav", ramp_samples(1 << 20)), Error);
    CHECK_FALSE(std::filesystem::exists(folder / "a.wav"));
}

TEST_CASE("mono is the mean of the channels") {
    sound::Sound sound{48000, 2, 2, {1.0f, 0.0f, -0.5f, 0.25f}};
    CHECK(sound::mix_to_mono(sound) == std::vector<float>{0.5f, -0.125f});
}

TEST_CASE("a header with a rate, or a number of samples, that cannot be is refused") {
    const TemporaryFolder folder;
    write(folder / "a.wav", ramp_samples(12000), 1, sound::SoundFormat::float_wav);
    const auto with_rate = [&](std::uint32_t rate) {
        std::fstream file(folder / "a.wav", std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(24);
        file.write(reinterpret_cast<const char*>(&rate), sizeof rate);
    };
    with_rate(10'000'000);
    CHECK(sound::load_sound(folder / "a.wav").frames == 12000);
    for (const std::uint32_t rate : {10'000'001u, 2'100'000'000u}) {
        with_rate(rate);
        CHECK_THROWS_WITH(sound::load_sound(folder / "a.wav"),
                          Catch::Matchers::ContainsSubstring("samples per second"));
    }
    // STREAMINFO of FLAC: 36 bits of samples, whose lowest 32 lie at byte 22.
    write(folder / "a.flac", ramp_samples(12000), 1, sound::SoundFormat::flac);
    std::fstream file(folder / "a.flac", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(22);
    file.write("\x7f\xff\xff\xff", 4);
    file.close();
    CHECK_THROWS_WITH(sound::load_sound(folder / "a.flac"),
                      Catch::Matchers::ContainsSubstring("more than a file of its size can hold"));
}

TEST_CASE("a WAV of the length from which on it is RF64 comes back bit for bit, and a shorter one stays a WAV") {
    const TemporaryFolder folder;
    const std::vector<float> samples = ramp_samples(9600);
    const auto name_of = [](const std::filesystem::path& path) { return file::read_whole_file(path).substr(0, 4); };
    for (const std::uint64_t from : {std::uint64_t{1000}, std::uint64_t{38'000}, std::uint64_t{39'000}}) {
        sound::SoundWriter writer(folder / "a.wav", 2, 3000, sound::SoundFormat::float_wav, "in N", from);
        writer.write(samples.data(), 4800);
        writer.finish();
        INFO(from);
        const bool is_long = std::filesystem::file_size(folder / "a.wav") >= from;
        CHECK(name_of(folder / "a.wav") == (is_long ? "RF64" : "RIFF"));
        const sound::Sound sound = sound::load_sound(folder / "a.wav");
        CHECK(sound.rate == 3000);
        CHECK(sound.channels == 2);
        CHECK(sound.samples == samples);
        if (from == 39'000) CHECK_FALSE(is_long);
    }
}

TEST_CASE("sounds of 2 and of 5 GiB are RF64 and read back whole", "[.large]") {
    const TemporaryFolder folder;
    const std::vector<float> silence(1 << 22, 0.25f);
    for (const std::int64_t pieces : {129, 320}) {
        sound::SoundWriter writer(folder / "a.wav", 1, 48000);
        for (std::int64_t i = 0; i < pieces; ++i) writer.write(silence.data(), silence.size());
        writer.finish();
        std::string name(4, ' ');
        std::ifstream(folder / "a.wav", std::ios::binary).read(name.data(), 4);
        CHECK(name == "RF64");
        sound::SoundReader reader(folder / "a.wav");
        CHECK(static_cast<std::int64_t>(reader.frames()) == pieces * static_cast<std::int64_t>(silence.size()));
    }
}
