// SPDX-License-Identifier: Apache-2.0
// Several channels of one card, recorded by another client of its server.
#include "assets/sound/sound.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/jack_server.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <future>
#include <string>
#include <utility>
#include <vector>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::has_server;
using tactus::test::Outcome;
using tactus::test::Recorder;
using tactus::test::Server;
using tactus::test::slurp;

namespace {

const std::string channel_patch =
    R"(wires = [ "low.signal -> left.signal", "middle.signal -> centre.signal", "high.signal -> right.signal" ]
[actuators.wrist]
channel = 3
full_scale = 2
[nodes]
low = { type = "sine", rate = "48 kHz", frequency = "441.7 Hz" }
middle = { type = "sine", rate = "48 kHz", frequency = "1000.3 Hz" }
high = { type = "sine", rate = "48 kHz", frequency = "2777 Hz" }
right = { type = "audio_output", rate = "48 kHz", channel = 8 }
centre = { type = "audio_output", rate = "48 kHz", actuator = "wrist" }
left = { type = "audio_output", rate = "48 kHz", channel = 1 }
)";

std::vector<float> rendered(const Folder& folder, const std::string& node) {
    const auto sound = tactus::sound::load_sound(folder.path / "r" / (node + ".wav"));
    return {sound.samples.begin(), sound.samples.end()};
}

/// False when this machine was too busy to play without a gap.
bool plays_the_same(const Folder& folder, const std::string& file) {
    Server server(folder, 256, 8);
    Recorder recorder(8);
    INFO(server.said());
    REQUIRE(recorder.is_there());
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run " + file + " --seconds 1.5 --audio default --audio-margin 500 --overwrite --out " +
                             (folder.path / "live").string());
    });
    // Port 8 exists once the card is open with all of its channels.
    bool listens = recorder.listen_to("tactus:right", 7);
    const std::array<const char*, 7> ports{"tactus:left",  "tactus:out_1", "tactus:centre", "tactus:out_3",
                                           "tactus:out_4", "tactus:out_5", "tactus:out_6"};
    for (std::size_t k = 0; k < ports.size(); ++k) listens = recorder.listen_to(ports[k], k) && listens;
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(listens);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    REQUIRE(summary["sound"].size() == 1);
    const json& sound = summary["sound"][0];
    INFO(sound.dump());
    if (sound["underflows"] > 0 || sound["frames_dropped"] > 0 || sound["frames_left_out"] > 0 ||
        summary["groups"][0]["skipped"] > 0)
        return false;
    const std::array<std::string, 8> nodes{"left", "", "centre", "", "", "", "", "right"};
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        INFO("channel " << k + 1);
        std::vector<float> heard = recorder.heard(k);
        if (nodes[k].empty()) {
            CHECK(std::ranges::all_of(heard, [](float x) { return x == 0.0F; }));
            continue;
        }
        // All channels begin at the same sample: the first that is not 0 is the second of each sine.
        std::vector<float> wanted = rendered(folder, nodes[k]);
        wanted.erase(wanted.begin());
        REQUIRE(heard.size() >= wanted.size());
        heard.resize(wanted.size());
        CHECK(heard == wanted);
    }
    return true;
}

}  // namespace

TEST_CASE("each channel of a card plays its own node, sample by sample with the others, and ports have names",
          "[live]") {
    if (!has_server()) return;
    const Folder folder;
    const std::string file = folder.write("channels.toml", channel_patch).string();
    const Outcome done = folder.tactus("render " + file + " --seconds 1.5 --out " + (folder.path / "r").string());
    INFO(done.err);
    REQUIRE(done.code == 0);
    const std::vector<float> centre = rendered(folder, "centre");
    CHECK(*std::ranges::max_element(centre) == Approx(0.5).margin(1e-3));
    bool played = false;
    for (int attempt = 0; attempt < 3 && !played; ++attempt) played = plays_the_same(folder, file);
    if (!played) tactus::test::skip("this machine was too busy to play without gaps");
}

TEST_CASE("an edit takes a channel away and brings it back, and the others play on sample by sample", "[live]") {
    if (!has_server()) return;
    const Folder folder;
    const std::string file = folder.write("channels.toml", channel_patch).string();
    const Outcome done = folder.tactus("render " + file + " --seconds 3 --out " + (folder.path / "r").string());
    REQUIRE(done.code == 0);
    const Server server(folder, 256, 8);
    Recorder recorder(3);
    INFO(server.said());
    REQUIRE(recorder.is_there());
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run " + file + " --seconds 3 --audio default --audio-margin 500 --out " +
                             (folder.path / "live").string());
    });
    CHECK(recorder.listen_to("tactus:right", 2));
    CHECK(recorder.listen_to("tactus:left", 0));
    CHECK(recorder.listen_to("tactus:centre", 1));
    recorder.wait_for(10'000);
    std::string without = channel_patch;
    const std::string wire = "\"middle.signal -> centre.signal\", ", node = "centre = ";
    without.erase(without.find(wire), wire.size());
    const std::size_t line = without.find(node);
    without.erase(line, without.find('\n', line) + 1 - line);
    folder.write("channels.toml", without);
    recorder.wait_for(70'000);
    folder.write("channels.toml", channel_patch);
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    const json& sound = summary["sound"][0];
    INFO(sound.dump());
    REQUIRE(summary["sound"].size() == 1);
    CHECK(outcome.err.find("edit 2 takes effect") != std::string::npos);
    if (sound["underflows"] > 0 || sound["frames_dropped"] > 0 || sound["frames_left_out"] > 0 ||
        summary["groups"][0]["skipped"] > 0) {
        tactus::test::skip("this machine was too busy to play without gaps");
        return;
    }
    for (const auto& [k, name] : {std::pair{0, "left"}, {2, "right"}}) {
        std::vector<float> heard = recorder.heard(static_cast<std::size_t>(k)), wanted = rendered(folder, name);
        wanted.erase(wanted.begin());
        REQUIRE(heard.size() >= wanted.size());
        heard.resize(wanted.size());
        CHECK(heard == wanted);
    }
    // The channel sounds, is silent over one stretch, and sounds again.
    const std::vector<float> centre = recorder.heard(1), wanted = rendered(folder, "centre");
    const auto silent = [&](std::size_t at) {
        return std::all_of(centre.begin() + static_cast<std::ptrdiff_t>(at),
                           centre.begin() + static_cast<std::ptrdiff_t>(at + 480), [](float x) { return x == 0.0F; });
    };
    std::size_t gone = 0;
    while (gone + 480 < wanted.size() && !silent(gone)) gone += 48;
    std::size_t back = gone;
    while (back + 480 < wanted.size() && silent(back)) back += 48;
    CHECK(gone > 9'000);
    CHECK(back > gone + 4'800);
    CHECK(back < wanted.size() - 4'800);
    CHECK_FALSE(silent(wanted.size() - 4'800));
}

TEST_CASE("a channel that two nodes play, a card with two rates and an unknown actuator are refused") {
    const Folder folder;
    using Catch::Matchers::ContainsSubstring;
    const auto refused = [&](const std::string& a, const std::string& b, const std::string& rate = "48 kHz") {
        const std::string text = R"(wires = ["t.signal -> a.signal", "u.signal -> b.signal"]
[actuators.wrist]
chanel = 2
[actuators.palm]
channel = 2
[nodes]
t = { type = "sine", rate = "48 kHz", frequency = "100 Hz" }
u = { type = "sine", rate = "%R", frequency = "100 Hz" }
a = { type = "audio_output", rate = "48 kHz", %A }
b = { type = "audio_output", rate = "%R", %B }
)";
        std::string channel_patch = text;
        for (const auto& [name, value] : {std::pair{"%A", a}, {"%B", b}, {"%R", rate}, {"%R", rate}})
            channel_patch.replace(channel_patch.find(name), 2, value);
        const Outcome outcome = folder.tactus("check " + folder.write("p.toml", channel_patch).string());
        CHECK(outcome.code == 2);
        return outcome.err;
    };
    CHECK_THAT(refused("channel = 2", "actuator = \"palm\""),
               ContainsSubstring("p.toml:10:1: node 'b' plays on channel 2 of the sound card, and so does 'a'"));
    CHECK_THAT(refused("channel = 2", "channel = 1", "24 kHz"),
               ContainsSubstring("nodes 'a' and 'b' use channels of the sound card, so they need one rate"));
    CHECK_THAT(refused("channel = 2", "actuator = \"plam\""),
               ContainsSubstring("no actuator 'plam' in [actuators]; did you mean 'palm'?"));
    CHECK_THAT(refused("channel = 1", "actuator = \"wrist\""),
               ContainsSubstring("p.toml:3:10: no node that names actuator 'wrist' has a parameter 'chanel'; did you "
                                 "mean 'channel'?"));
    CHECK_THAT(refused("channel = 1.5", "channel = 2"), ContainsSubstring("a channel is a whole number"));
}
