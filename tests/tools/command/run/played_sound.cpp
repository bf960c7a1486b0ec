// SPDX-License-Identifier: Apache-2.0
// A JACK server without hardware; a second client records what the command plays.
#include "assets/sound/sound.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/jack_server.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <future>
#include <memory>
#include <vector>

using namespace std::chrono_literals;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::has_server;
using tactus::test::Outcome;
using tactus::test::Recorder;
using tactus::test::Server;
using tactus::test::slurp;

namespace {

const std::string tone = R"(title = "tone"
wires = [ "tone.signal -> speaker.signal" ]
[nodes.tone]
type = "sine"
rate = "48 kHz"
frequency = "441.7 Hz"
[nodes.speaker]
type = "audio_output"
rate = "48 kHz"
)";

std::vector<float> rendered_sound(const Folder& folder, const std::string& patch) {
    const Outcome done =
        folder.tactus("render " + patch + " --seconds 1.5 --overwrite --out " + (folder.path / "r").string());
    INFO(done.err);
    REQUIRE(done.code == 0);
    const tactus::sound::Sound sound = tactus::sound::load_sound(folder.path / "r/speaker.wav");
    std::vector<float> samples(sound.samples.begin(), sound.samples.end());
    return {std::ranges::find_if(samples, [](float x) { return x != 0.0F; }), samples.end()};
}

/// Plays while the recorder listens; false when this machine was too busy to play without a gap.
bool plays_the_same(const Folder& folder, int period, bool freewheel, const std::vector<float>& wanted) {
    Server server(folder, period);
    Recorder recorder;
    INFO(server.said());
    REQUIRE(recorder.is_there());
    const std::string out = (folder.path / "live").string();
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run " + (folder.path / "tone.toml").string() +
                             " --seconds 1.5 --audio default --audio-margin 500 --overwrite --out " + out);
    });
    const bool listens = recorder.listen_to("tactus:speaker");
    if (listens && freewheel) {
        recorder.freewheel(true);
        // Leaving a server that freewheels takes a client ten seconds: it goes back to the usual pace before.
        recorder.wait_for(wanted.size());
        recorder.freewheel(false);
    }
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(listens);
    const json summary = json::parse(slurp(folder.path / "live/summary.json")), sound = summary["sound"][0];
    INFO(sound.dump());
    if (sound["underflows"] > 0 || sound["frames_dropped"] > 0 || sound["frames_left_out"] > 0 ||
        summary["groups"][0]["skipped"] > 0)
        return false;
    CHECK(sound["largest_callback"] == period);
    std::vector<float> heard = recorder.heard();
    REQUIRE(heard.size() >= wanted.size());
    heard.resize(wanted.size());
    CHECK(heard == wanted);
    return true;
}

void check_playing(bool freewheel, std::initializer_list<int> periods) {
    if (!has_server()) return;
    const Folder folder;
    const std::vector<float> wanted = rendered_sound(folder, folder.write("tone.toml", tone).string());
    REQUIRE(wanted.size() > 70'000);
    for (const int period : periods) {
        INFO("period " << period);
        bool played = false;
        for (int attempt = 0; attempt < 3 && !played; ++attempt)
            played = plays_the_same(folder, period, freewheel, wanted);
        if (!played)
            tactus::test::skip("this machine was too busy to play without gaps, period " + std::to_string(period));
    }
}

}  // namespace

TEST_CASE("what a second client records of a live run is the offline render, sample by sample", "[live]") {
    check_playing(false, {16, 64, 100, 256, 1024});
}

TEST_CASE("a server in freewheel gets every sample, too", "[live]") { check_playing(true, {64, 1024}); }

// Costly: seconds of sound through a server, live.
TEST_CASE("a server that dies leaves a run that ends by itself, silent, with faded forces and a whole take",
          "[kernel]") {
    if (!has_server()) return;
    const Folder folder;
    Server server(folder, 256);
    auto recorder = std::make_unique<Recorder>();
    INFO(server.said());
    REQUIRE(recorder->is_there());
    const std::string out = (folder.path / "live").string(), take = (folder.path / "take").string();
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run saw-training --seconds 4 --audio default --out " + out + " --record " + take);
    });
    CHECK(recorder->listen_to("tactus:speaker"));
    recorder.reset();
    std::this_thread::sleep_for(1500ms);
    server.end(SIGKILL);
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 3);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    INFO(summary["sound"].dump() << summary["notices"].dump());
    CHECK(summary["sound"][0]["losses"] == 1);
    CHECK(summary["notices"].dump().find("was lost") != std::string::npos);
    CHECK(summary["faults"].dump().find("the sound card was lost") != std::string::npos);
    const Outcome again = folder.tactus("replay " + take);
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}

TEST_CASE("an output that an edit makes anew plays on through the card that is open", "[kernel]") {
    if (!has_server()) return;
    const Folder folder;
    Server server(folder, 256);
    {
        const Recorder there;
        INFO(server.said());
        REQUIRE(there.is_there());
    }
    const std::string patch = folder.write("tone.toml", tone).string(), out = (folder.path / "live").string();
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run " + patch + " --seconds 2.5 --audio default --out " + out);
    });
    std::this_thread::sleep_for(1000ms);
    std::string renamed = tone;
    for (std::size_t at = 0; (at = renamed.find("speaker", at)) != std::string::npos; at += 3)
        renamed.replace(at, 7, "ear");
    folder.write("tone.toml", renamed);
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    INFO(summary.dump());
    CHECK(outcome.err.find("edit 1 takes effect") != std::string::npos);
    REQUIRE(summary["sound"].size() == 1);
    CHECK(summary["sound"][0]["frames_written"] > 90'000);
}

TEST_CASE("a card that is not there, or cannot go at the asked pace, is an error that says so") {
    const Folder folder;
    const std::string patch = folder.write("tone.toml", tone).string(), out = (folder.path / "live").string();
    const Outcome missing = folder.tactus("run " + patch + " --seconds 0.1 --audio nobody-has-this --out " + out);
    CHECK(missing.code == 2);
    CHECK(missing.err.find("sound output") != std::string::npos);
    const Outcome slow = folder.tactus("run " + patch + " --seconds 0.1 --audio default --dilate 2 --out " + out);
    CHECK(slow.code == 2);
    CHECK(slow.err.find("--dilate") != std::string::npos);
}

TEST_CASE("sound goes to a file or nowhere when asked to") {
    const Folder folder;
    const std::string patch = folder.write("tone.toml", tone).string();
    for (const char* where : {"file", "none"}) {
        const std::string out = (folder.path / where).string();
        const Outcome outcome = folder.tactus("run " + patch + " --seconds 0.1 --audio " + where + " --out " + out);
        INFO(outcome.err);
        CHECK(outcome.code == 0);
        CHECK(std::filesystem::exists(folder.path / where / "speaker.wav") == (std::string(where) == "file"));
    }
}
