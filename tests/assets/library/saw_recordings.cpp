// SPDX-License-Identifier: Apache-2.0
#include "assets/library/saw_recordings.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/filter/biquad.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>

using namespace tactus;

namespace {

double rms(const sound::Recording& r) {
    double power = 0.0;
    for (const float x : r.samples) power += static_cast<double>(x) * x;
    return std::sqrt(power / static_cast<double>(r.samples.size())) * *r.full_scale;
}

const sound::Recording& find(const sound::RecordingSet& set, double rate, double load) {
    return *std::find_if(set.recordings.begin(), set.recordings.end(),
                         [&](const sound::Recording& r) { return r.rate == rate && r.load == load; });
}

}  // namespace

TEST_CASE("the bundled saw says that it is computed, and covers its rates and loads") {
    const TemporaryFolder folder;
    library::make_saw_recordings(folder / "saw");
    const sound::RecordingSet set = sound::load_recording_set(folder / "saw/reciprocating.toml");
    CHECK(set.synthesised);
    CHECK(set.calibrated());
    CHECK(set.recordings.size() == 12);
    std::map<double, int> rates, loads;
    for (const sound::Recording& r : set.recordings) {
        ++rates[r.rate];
        ++loads[r.load];
        CHECK(r.cutting == (r.load > 0.0));
        CHECK(r.sample_rate == 48000);
        CHECK(r.samples.size() == 96000);
        // Full scale is never reached, so FLAC has cut nothing.
        CHECK(std::ranges::max(r.samples) < 0.99f);
        CHECK(std::ranges::min(r.samples) > -0.99f);
    }
    CHECK(rates == std::map<double, int>{{150.0, 4}, {190.0, 4}, {233.0, 4}});
    CHECK(loads == std::map<double, int>{{0.0, 3}, {3.0, 3}, {7.0, 3}, {12.0, 3}});
}

TEST_CASE("the bundled saw shakes as hard as saws are known to, and its noise swells twice a cycle") {
    const TemporaryFolder folder;
    library::make_saw_recordings(folder.path);
    const sound::RecordingSet set = sound::load_recording_set(folder / "reciprocating.toml");
    CHECK(rms(find(set, 233.0, 0.0)) == Approx(90.5).epsilon(0.01));
    CHECK(rms(find(set, 233.0, 12.0)) == Approx(182.0).epsilon(0.01));
    // A stroke of constant length: acceleration goes with the square of the rate.
    CHECK(rms(find(set, 150.0, 0.0)) == Approx(90.5 * std::pow(150.0 / 233.0, 2)).epsilon(0.01));
    for (const double rate : {150.0, 190.0, 233.0}) CHECK(rms(find(set, rate, 3.0)) < rms(find(set, rate, 7.0)));

    // Power of the sound above 400 Hz by place in the cycle: great at mid-stroke, small at the ends.
    const sound::Recording& loud = find(set, 150.0, 12.0);
    signal::Biquad first{signal::highpass(400.0, 48000.0)}, second{signal::highpass(400.0, 48000.0)};
    double middle = 0.0, ends = 0.0;
    for (std::size_t i = 0; i < loud.samples.size(); ++i) {
        const double y = second(first(loud.samples[i]));
        const double cycle = std::fmod(150.0 * static_cast<double>(i) / 48000.0, 0.5);  // ends at 0, middle at 0.25
        (cycle > 0.125 && cycle < 0.375 ? middle : ends) += y * y;
    }
    CHECK(middle > 2.0 * ends);
}

TEST_CASE("the bundled saw is the same bytes each time", "[slow]") {
    const TemporaryFolder folder;
    library::make_saw_recordings(folder / "a");
    library::make_saw_recordings(folder / "b");
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "a")) {
        CHECK(file::read_whole_file(entry.path()) == file::read_whole_file(folder / "b" / entry.path().filename()));
        ++files;
    }
    CHECK(files == 13);
}

TEST_CASE("the bundled saw runs as a voice without a click", "[slow]") {
    const TemporaryFolder folder;
    library::make_saw_recordings(folder.path);
    const sound::RecordingSet set = sound::load_recording_set(folder / "reciprocating.toml");
    vibration::SawVoice voice;
    voice.prepare(48000.0, sound::saw_recordings(set));
    // Steps between samples, of the recordings at full speed and of the voice while trigger and load come and go.
    double known = 0.0, heard = 0.0;
    for (const sound::Recording& r : set.recordings)
        for (std::size_t i = 1; i < r.samples.size(); ++i)
            known = std::max(known, std::abs(static_cast<double>(r.samples[i]) - r.samples[i - 1]) * *r.full_scale);
    double before = 0.0;
    for (int i = 0; i < 5 * 48000; ++i) {
        const bool trigger = i < 4 * 48000;
        const double load = i > 48000 && (i / 12000) % 2 ? 12.0 : 0.0;
        const double y = voice.tick(load, trigger, i < 96000 ? 233.0 : 160.0);
        heard = std::max(heard, std::abs(y - before));
        before = y;
    }
    CHECK(heard < 1.1 * known);
    CHECK(heard > 0.2 * known);
}
