// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/recording_set.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

/// A folder with a buzz of 1 s at 200 Hz, "a.wav", and a set next to it.
struct Folder : TemporaryFolder {
    Folder() {
        std::vector<float> samples(48000);
        for (std::size_t i = 0; i < samples.size(); ++i)
            for (int k = 1; k <= 5; ++k)
                samples[i] += static_cast<float>(
                    0.2 / k * std::sin(2.0 * std::numbers::pi * k * 200.0 * static_cast<double>(i) / 48000.0));
        write("a.wav", samples);
    }
    void write(const std::string& name, const std::vector<float>& samples) const {
        sound::SoundWriter writer(path / name, 1, 48000);
        writer.write(samples.data(), samples.size());
        writer.finish();
    }
    sound::RecordingSet load(const std::string& text) const {
        file::write_whole_file(path / "set.toml", text);
        return sound::load_recording_set(path / "set.toml");
    }
    std::string error(const std::string& text) const {
        try {
            load(text);
        } catch (const Error& caught) {
            return caught.what();
        }
        return {};
    }
};

const std::string cutting = "[[recording]]\nfile = \"a.wav\"\nstate = \"cutting\"\nrate = \"200 Hz\"\nload = \"7 N\"\n";
const std::string free_air = "[[recording]]\nfile = \"a.wav\"\nstate = \"free_air\"\nrate = \"200 Hz\"\n";

}  // namespace

TEST_CASE("a set is read in SI, and what stands at its top holds for each recording") {
    const Folder folder;
    const sound::RecordingSet set = folder.load(
        "title = \"T\"\nnote = \"N\"\nlicence = \"L\"\nsynthesised = true\n"
        "sensor = \"microphone\"\nfull_scale = \"0.1 km/s^2\"\n" +
        cutting + "loop = [\"100 ms\", \"0.9 s\"]\n" + free_air + "sensor = \"accelerometer\"\nnote = \"calm\"\n");
    CHECK(set.title == "T");
    CHECK(set.note == "N");
    CHECK(set.licence == "L");
    CHECK(set.synthesised);
    CHECK(set.calibrated());
    REQUIRE(set.recordings.size() == 2);
    const sound::Recording &first = set.recordings[0], &second = set.recordings[1];
    CHECK(first.cutting);
    CHECK(first.load == 7.0);
    CHECK(first.rate == 200.0);
    CHECK_FALSE(first.rate_estimated);
    CHECK(first.sensor == "microphone");
    CHECK(first.full_scale == Approx(100.0));
    CHECK(first.samples.size() == 48000);
    CHECK_FALSE(second.cutting);
    CHECK(second.sensor == "accelerometer");
    CHECK(second.note == "calm");
    const std::vector<vibration::SawRecording> saw = sound::saw_recordings(set);
    REQUIRE(saw.size() == 2);
    CHECK(saw[0].loop_begin == 4800);
    CHECK(saw[0].loop_end == 43200);
    CHECK(saw[0].gain == Approx(100.0));
    CHECK(saw[0].samples.data() == first.samples.data());
    CHECK(saw[1].loop_end == 48000);
    vibration::SawVoice voice;
    CHECK_NOTHROW(voice.prepare(48000.0, saw));
}

TEST_CASE("without full_scale a set is uncalibrated, and the two do not mix") {
    const Folder folder;
    CHECK_FALSE(folder.load(cutting).calibrated());
    CHECK_FALSE(folder.load("full_scale = \"uncalibrated\"\n" + cutting).calibrated());
    CHECK_THAT(folder.error(cutting + free_air + "full_scale = \"98.1 m/s^2\"\n"), ContainsSubstring("set.toml:6:1: "));
}

TEST_CASE("a rate that nobody states is heard") {
    const Folder folder;
    const sound::RecordingSet set =
        folder.load("[[recording]]\nfile = \"a.wav\"\nstate = \"cutting\"\nload = \"7 N\"\n");
    CHECK(set.recordings[0].rate_estimated);
    CHECK(set.recordings[0].rate == Approx(200.0).margin(0.05));
}

TEST_CASE("a sound file is a set of one cutting recording") {
    const Folder folder;
    const sound::RecordingSet heard = sound::load_recording_set(folder / "a.wav");
    REQUIRE(heard.recordings.size() == 1);
    CHECK(heard.recordings[0].cutting);
    CHECK(heard.recordings[0].load == 7.0);
    CHECK(heard.recordings[0].rate_estimated);
    CHECK(heard.recordings[0].rate == Approx(200.0).margin(0.05));
    CHECK_FALSE(heard.calibrated());
    const sound::RecordingSet told = sound::load_recording_set(folder / "a.wav", 100.0);
    CHECK(told.recordings[0].rate == 100.0);
    CHECK_FALSE(told.recordings[0].rate_estimated);
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "a.wav", 2000.0), ContainsSubstring("5 Hz to 1 kHz"));
    folder.load(cutting);
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "set.toml", 100.0), ContainsSubstring("states its own rates"));
}

TEST_CASE("the rate of a sound file may follow its name") {
    const Folder folder;
    const sound::RecordingSet set = sound::load_recording_set(folder / "a.wav#100 Hz");
    CHECK(set.recordings[0].rate == 100.0);
    CHECK_FALSE(set.recordings[0].rate_estimated);
    CHECK(set.recordings[0].file.filename() == "a.wav");
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "a.wav#fast"), ContainsSubstring("#233 Hz"));
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "a.wav#2 kHz"), ContainsSubstring("5 Hz to 1 kHz"));
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "b.wav#100 Hz"), ContainsSubstring("no such sound file"));
    folder.load(cutting);
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "set.toml#100 Hz"), ContainsSubstring("states its own rates"));
}

TEST_CASE("a sound in which a rate is hardly heard is questioned, and a set that somebody wrote is not") {
    const Folder folder;
    CHECK(sound::saw_question(sound::load_recording_set(folder / "a.wav#200 Hz")).empty());
    std::vector<float> noise(48000);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<float>(0.1 * Random{5}.normal(i));
    folder.write("a.wav", noise);
    const sound::RecordingSet set = sound::load_recording_set(folder / "a.wav#200 Hz");
    CHECK_THAT(sound::saw_question(set),
               ContainsSubstring("is a.wav the sound of a saw?") && ContainsSubstring("200 Hz"));
    CHECK(sound::saw_question(folder.load(cutting)).empty());
}

TEST_CASE("noise has no rate, and a sound of a few cycles is too short") {
    const Folder folder;
    std::vector<float> noise(48000);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<float>(0.1 * Random{5}.normal(i));
    folder.write("noise.wav", noise);
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "noise.wav"), ContainsSubstring("noise.wav: no rate"));
    noise.resize(480);
    folder.write("short.wav", noise);
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "short.wav", 200.0), ContainsSubstring("2.0 cycles"));
    const std::string brief = folder.error(cutting + "loop = [\"0 s\", \"10 ms\"]\n");
    CHECK_THAT(brief, ContainsSubstring("set.toml:4:8: ") && ContainsSubstring("cycles"));
}

TEST_CASE("a bad set is refused in one line that says where") {
    const Folder folder;
    const auto said = [&](const std::string& text) { return folder.error(text); };
    CHECK_THAT(said(""), ContainsSubstring("set.toml:1:1: ") && ContainsSubstring("[[recording]]"));
    CHECK_THAT(said("title = "), ContainsSubstring("set.toml:1:") && ContainsSubstring("not valid TOML"));
    CHECK_THAT(said("titel = \"x\"\n" + cutting),
               ContainsSubstring(":1:1: unknown key 'titel'") && ContainsSubstring("'title'"));
    CHECK_THAT(said(cutting + "laod = \"7 N\"\n"),
               ContainsSubstring(":6:1: unknown key 'laod'") && ContainsSubstring("'load'"));
    CHECK_THAT(said("title = 5\n" + cutting), ContainsSubstring(":1:9: 'title' must be a text"));
    CHECK_THAT(said("synthesised = \"yes\"\n" + cutting),
               ContainsSubstring(":1:15:") && ContainsSubstring("true or false"));
    CHECK_THAT(said("recording = 5\n"), ContainsSubstring("[[recording]]"));
    CHECK_THAT(said("recording = []\n"), ContainsSubstring("no recording"));
    CHECK_THAT(said("recording = [5]\n"), ContainsSubstring("[[recording]]"));
    CHECK_THAT(said("[[recording]]\nstate = \"cutting\"\n"), ContainsSubstring(":1:") && ContainsSubstring("no file"));
    CHECK_THAT(said("[[recording]]\nfile = \"a.wav\"\n"), ContainsSubstring("no state"));
    CHECK_THAT(said("[[recording]]\nfile = \"a.wav\"\nstate = \"cuting\"\n"),
               ContainsSubstring(":3:9:") && ContainsSubstring("'cutting'"));
    CHECK_THAT(said("[[recording]]\nfile = \"a.wav\"\nstate = \"cutting\"\nrate = \"200 Hz\"\n"),
               ContainsSubstring("load"));
    CHECK_THAT(said(free_air + "load = \"7 N\"\n"), ContainsSubstring(":5:8:") && ContainsSubstring("free air"));
    CHECK_THAT(said(free_air + "load = \"7 kg\"\n"), ContainsSubstring(":5:8:"));
    CHECK_THAT(said("[[recording]]\nfile = \"a.wav\"\nstate = \"free_air\"\nrate = \"2 Hz\"\n"),
               ContainsSubstring(":4:8:"));
    CHECK_THAT(said("[[recording]]\nfile = \"a.wav\"\nstate = \"free_air\"\nrate = \"20 s\"\n"),
               ContainsSubstring(":4:8:"));
    CHECK_THAT(said("full_scale = \"0 m/s^2\"\n" + cutting), ContainsSubstring(":1:14:"));
    CHECK_THAT(said(free_air + "loop = [\"0 s\"]\n"), ContainsSubstring(":5:8:"));
    CHECK_THAT(said(free_air + "loop = [\"0.5 s\", \"1.5 s\"]\n"),
               ContainsSubstring(":5:8:") && ContainsSubstring("within the 1 s"));
    CHECK_THAT(said(free_air + "loop = [\"0.5 s\", \"0.2 s\"]\n"), ContainsSubstring(":5:8:"));
    CHECK_THAT(said("[[recording]]\nfile = \"b.wav\"\nstate = \"free_air\"\n"),
               ContainsSubstring(":2:8: ") && ContainsSubstring("b.wav: no such sound file"));
    CHECK_THROWS_WITH(sound::load_recording_set(folder / "none.toml"), ContainsSubstring("none.toml: no such file"));
    std::string many;
    for (int i = 0; i < 33; ++i) many += free_air;
    CHECK_THAT(said(many), ContainsSubstring("at most 32"));
}

TEST_CASE("a recorded saw of the real world becomes a voice") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    if (data == nullptr) {
        tactus::test::skip("TACTUS_SHARED_DATA does not name a folder with recordings/chainsaw_cutting_149294a.flac");
        return;
    }
    const sound::RecordingSet set =
        sound::load_recording_set(std::filesystem::path(data) / "recordings/chainsaw_cutting_149294a.flac");
    CHECK(set.recordings[0].rate_estimated);
    vibration::SawVoice voice;
    voice.prepare(48000.0, sound::saw_recordings(set));
    double power = 0.0;
    for (int i = 0; i < 48000; ++i) {
        const double y = voice.tick(7.0, true, set.recordings[0].rate);
        REQUIRE(std::isfinite(y));
        power += y * y / 48000.0;
    }
    CHECK(power > 1e-6);
}
