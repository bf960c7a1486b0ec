// SPDX-License-Identifier: Apache-2.0
// Channels of a card that a patch hears: from a file, and from another client of a JACK server, which counts frames.
#include "assets/sound/sound.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/jack_server.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <optional>
#include <set>
#include <string>
#include <vector>

using nlohmann::json;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;

namespace {

/// Hears two channels, and plays them on two others.
const std::string echo = R"(wires = [ "mic.signal -> left.signal", "wrist.signal -> right.signal" ]
[sensors.wrist]
channel = 2
full_scale = 2
[nodes]
mic = { type = "audio_input", rate = "48 kHz" }
wrist = { type = "audio_input", rate = "48 kHz", sensor = "wrist" }
left = { type = "audio_output", rate = "48 kHz", channel = 1 }
right = { type = "audio_output", rate = "48 kHz", channel = 2 }
)";

/// A client whose outputs count frames, and which notes how many frames later its inputs hear each count.
class Counter {
public:
    static constexpr int most = 1 << 20;

    Counter() {
        for (int i = 0; i < 200 && client_ == nullptr; ++i) {
            client_ = jack_client_open("counter", JackNoStartServer, nullptr);
            if (client_ == nullptr) std::this_thread::sleep_for(50ms);
        }
        if (client_ == nullptr) return;
        for (std::size_t k = 0; k < 2; ++k) {
            const std::string number = std::to_string(k);
            out_[k] =
                jack_port_register(client_, ("out" + number).c_str(), JACK_DEFAULT_AUDIO_TYPE, JackPortIsOutput, 0);
            in_[k] = jack_port_register(client_, ("in" + number).c_str(), JACK_DEFAULT_AUDIO_TYPE, JackPortIsInput, 0);
            heard_[k].assign(48000 * 20, {});
        }
        jack_set_process_callback(
            client_, [](jack_nframes_t n, void* self) { return static_cast<Counter*>(self)->count(n); }, this);
        jack_activate(client_);
    }
    ~Counter() {
        if (client_ != nullptr) jack_client_close(client_);
    }
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;

    bool is_there() const { return client_ != nullptr; }
    bool connect() {
        for (int i = 0; i < 4000; ++i, std::this_thread::sleep_for(5ms)) {
            bool all = true;
            for (const char* port : {"tactus:mic", "tactus:wrist", "tactus:left", "tactus:right"})
                all = all && jack_port_by_name(client_, port) != nullptr;
            if (!all) continue;
            return jack_connect(client_, "counter:out0", "tactus:mic") == 0 &&
                   jack_connect(client_, "counter:out1", "tactus:wrist") == 0 &&
                   jack_connect(client_, "tactus:left", "counter:in0") == 0 &&
                   jack_connect(client_, "tactus:right", "counter:in1") == 0;
        }
        return false;
    }
    /// Frames from a count to its echo, of all that were heard.
    std::set<int> delays(std::size_t channel) const {
        std::set<int> all;
        for (std::size_t i = 0; i < frames_.load(); ++i)
            if (heard_[channel][i] != 0.0F)
                all.insert(static_cast<int>(i) - static_cast<int>(std::lround(heard_[channel][i] * 2.0F * most)));
        return all;
    }
    std::size_t echoes(std::size_t channel) const {
        return static_cast<std::size_t>(
            std::count_if(heard_[channel].begin(), heard_[channel].end(), [](float x) { return x != 0.0F; }));
    }

private:
    int count(jack_nframes_t n) {
        const std::size_t from = frames_.load(std::memory_order_relaxed);
        for (std::size_t k = 0; k < 2; ++k) {
            auto* const out = static_cast<float*>(jack_port_get_buffer(out_[k], n));
            const auto* const in = static_cast<const float*>(jack_port_get_buffer(in_[k], n));
            // The second channel is half as loud: its sensor has twice the full scale.
            for (jack_nframes_t i = 0; i < n; ++i) {
                out[i] = static_cast<float>((from + i) % most) / (2.0F * most) / (k == 1 ? 2.0F : 1.0F);
                if (from + i < heard_[k].size()) heard_[k][from + i] = in[i];
            }
        }
        frames_.store(std::min(from + n, heard_[0].size()), std::memory_order_release);
        return 0;
    }

    jack_client_t* client_ = nullptr;
    std::array<jack_port_t*, 2> out_{}, in_{};
    std::array<std::vector<float>, 2> heard_;
    std::atomic<std::size_t> frames_{0};
};

std::uintmax_t bytes_in(const std::filesystem::path& folder) {
    std::uintmax_t bytes = 0;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        const auto size = entry.file_size(ignored);
        if (!ignored) bytes += size;
    }
    return bytes;
}

/// False when this machine was too busy to play without a gap.
bool echoes_every_frame(const Folder& folder, const std::string& file, int period) {
    Server server(folder, period);
    Counter counter;
    INFO(server.said());
    REQUIRE(counter.is_there());
    const std::string take = (folder.path / "take").string();
    std::filesystem::remove_all(take);
    auto running = std::async(std::launch::async, [&] {
        return folder.tactus("run " + file + " --seconds 4 --audio default --audio-margin 400 --overwrite --out " +
                             (folder.path / "live").string() + " --record " + take);
    });
    const bool connected = counter.connect();
    const Outcome outcome = running.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(connected);
    // A take repeats what was heard, also where it had gaps.
    const Outcome again = folder.tactus("replay " + take + " --json");
    INFO(again.out << again.err);
    CHECK(again.code == 0);
    CHECK(json::parse(again.out)["identical"] == true);
    CHECK(json::parse(again.out)["compared_values"] > 2 * 48'000);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    REQUIRE(summary["sound"].size() == 1);
    const json& sound = summary["sound"][0];
    INFO(sound.dump());
    CHECK(sound["heard"]["channels"] == 2);
    if (sound["underflows"] > 0 || sound["frames_dropped"] > 0 || sound["frames_left_out"] > 0 ||
        sound["heard"]["frames_missed"] > 0 || sound["heard"]["resyncs"] > 0 || summary["groups"][0]["skipped"] > 0)
        return false;
    CHECK(counter.echoes(0) > 48'000);
    CHECK(counter.delays(0).size() == 1);
    CHECK(counter.delays(0) == counter.delays(1));
    // A server that missed its own deadlines has shifted its time.
    if (sound["heard"]["card_xruns"] > 0) return false;
    // Each way the margin and a callback, and a call of the group, as 'check' says; to one callback. The sound begins
    // later when the thread is late, and the callbacks' times are those of a server that was late itself.
    const double late = 48e-3 * summary["groups"][0]["lateness_us"]["max"].get<double>();
    const int loop = *counter.delays(0).begin(), stated = 2 * (19'200 + period) + 48;
    INFO("loop " << loop << " frames, stated " << stated << ", latest call " << late << " frames late");
    CHECK(std::abs(loop - stated) <= period + late);
    return true;
}

}  // namespace

// Costly: seconds of sound through a server, live and repeated.
TEST_CASE("what a client plays is heard and played to the sample, at one distance, and a take repeats it", "[live]") {
    if (!has_server()) return;
    const Folder folder;
    const std::string file = folder.write("echo.toml", echo).string();
    for (const int period : {64, 1024}) {
        bool is_whole = false;
        // The margin outlasts most stalls of a loaded machine, and a run with a gap is made again.
        for (int attempt = 0; attempt < 5 && !is_whole; ++attempt) is_whole = echoes_every_frame(folder, file, period);
        if (!is_whole) tactus::test::skip("this machine was too busy to hear without gaps");
    }
}

TEST_CASE("a patch that only hears follows the card, and a run that is killed repeats what it heard", "[kernel]") {
    if (!has_server()) return;
    const Folder folder;
    const std::string file = folder
                                 .write("hear.toml", R"(wires = [ "mic.signal -> louder.in" ]
[nodes]
mic = { type = "audio_input", rate = "48 kHz", channel = 2 }
louder = { type = "gain", rate = "48 kHz", factor = 3 }
)")
                                 .string();
    Server server(folder, 256);
    std::optional<Recorder> there(std::in_place);
    INFO(server.said());
    REQUIRE(there->is_there());
    const Outcome outcome =
        folder.tactus("run " + file + " --seconds 1.5 --audio default --out " + (folder.path / "live").string());
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    INFO(summary["sound"].dump());
    CHECK(summary["sound"][0]["frames_written"] > 60'000);
    CHECK(summary["sound"][0]["heard"]["channels"] == 2);
    const std::string take = (folder.path / "cut").string();
    there.reset();
    {
        Run killed(folder,
                   file + " --seconds 60 --audio default --out " + (folder.path / "k").string() + " --record " + take);
        REQUIRE(wait_for([&] { return bytes_in(take) > 150'000; }));  // most of a second of what was heard
        killed.stop(SIGKILL);
    }
    server.end(SIGKILL);  // in order it would wait 100 s for the client that is gone
    const Outcome again = folder.tactus("replay " + take);
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}

TEST_CASE("a node without a channel plays on the card that its patch hears, which is opened once", "[kernel]") {
    if (!has_server()) return;
    const Folder folder;
    const auto run = [&](const std::string& outputs) {
        const std::string file = folder
                                     .write("both.toml", R"(wires = [ "mic.signal -> loud.signal" ]
[nodes]
mic = { type = "audio_input", rate = "48 kHz", channel = 2 }
)" + outputs)
                                     .string();
        const Server server(folder, 256);
        const Recorder there;
        INFO(server.said());
        REQUIRE(there.is_there());
        const Outcome outcome = folder.tactus("run " + file + " --seconds 1 --audio default --overwrite --out " +
                                              (folder.path / "live").string());
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        return json::parse(slurp(folder.path / "live/summary.json"))["sound"];
    };
    const json one = run("loud = { type = \"audio_output\", rate = \"48 kHz\" }\n");
    INFO(one.dump());
    REQUIRE(one.size() == 1);
    CHECK(one[0]["heard"]["channels"] == 2);
    CHECK(one[0]["frames_written"] > 30'000);
}

TEST_CASE("a card with inputs only is heard, and who plays on it is told that it has no outputs", "[kernel]") {
    if (!has_server()) return;
    const Folder folder;
    const std::string nodes = "[nodes]\nmic = { type = \"audio_input\", rate = \"48 kHz\", channel = 2 }\n";
    const std::string hears =
        folder
            .write("hear.toml", "wires = [ \"mic.signal -> louder.in\" ]\n" + nodes +
                                    "louder = { type = \"gain\", rate = \"48 kHz\", factor = 3 }\n")
            .string();
    const std::string plays =
        folder
            .write("play.toml", "wires = [ \"mic.signal -> loud.signal\" ]\n" + nodes +
                                    "loud = { type = \"audio_output\", rate = \"48 kHz\", channel = 1 }\n")
            .string();
    const Server server(folder, 256, 0);
    const Recorder there;
    INFO(server.said());
    REQUIRE(there.is_there());
    const auto run = [&](const std::string& file) {
        return folder.tactus("run " + file + " --seconds 1 --audio system --overwrite --out " +
                             (folder.path / "live").string());
    };
    const Outcome heard = run(hears);
    INFO(heard.err);
    REQUIRE(heard.code == 0);
    const json sound = json::parse(slurp(folder.path / "live/summary.json"))["sound"];
    INFO(sound.dump());
    REQUIRE(sound.size() == 1);
    CHECK(sound[0]["heard"]["channels"] == 2);
    CHECK(sound[0]["heard"]["frames_missed"] < 24'000);
    CHECK(sound[0]["frames_written"] > 30'000);
    const Outcome played = run(plays);
    CHECK(played.code == 2);
    CHECK_THAT(played.err, ContainsSubstring("sound card 'system' has no outputs"));
    const json cards = json::parse(folder.tactus("devices --json").out)["audio"];
    INFO(cards.dump());
    CHECK(std::ranges::any_of(cards, [](const json& card) {
        return card["channels"] == 0 && card["inputs"] == 2 && card["rate_hz"] == 48000.0;
    }));
}

TEST_CASE("offline a file is heard in place of a card, as loud as the sensor says") {
    const Folder folder;
    const std::string sound = folder
                                  .write("sound.toml", R"(wires = [ "tone.signal -> sound.in" ]
[nodes]
tone = { type = "sine", rate = "48 kHz", frequency = "441 Hz", amplitude = 0.3 }
sound = { type = "record", rate = "48 kHz" }
)")
                                  .string();
    REQUIRE(folder.tactus("render " + sound + " --seconds 0.2 --out " + (folder.path / "s").string()).code == 0);
    const std::string text = R"(wires = [ "mic.signal -> heard.in" ]
[assets]
voice = "s/sound.wav"
[sensors.skin]
full_scale = 4
channel = 3
file = "voice"
[nodes]
mic = { type = "audio_input", rate = "48 kHz", sensor = "skin" }
heard = { type = "record", rate = "48 kHz" }
)";
    const std::string file = folder.write("hear.toml", text).string(), take = (folder.path / "take").string();
    const Outcome outcome =
        folder.tactus("render " + file + " --seconds 0.3 --out " + (folder.path / "h").string() + " --record " + take);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const auto given = tactus::sound::load_sound(folder.path / "s/sound.wav");
    const auto heard = tactus::sound::load_sound(folder.path / "h/heard.wav");
    REQUIRE(given.samples.size() == 9600);
    REQUIRE(heard.samples.size() == 14'400);
    for (std::size_t i = 0; i < heard.samples.size(); ++i)
        REQUIRE(heard.samples[i] == (i < given.samples.size() ? 4.0F * given.samples[i] : 0.0F));
    CHECK(folder.tactus("replay " + take).code == 0);
    const Outcome louder = folder.tactus("render " + file + " --seconds 0.1 --set sensors.skin.full_scale=8 --out " +
                                         (folder.path / "l").string());
    INFO(louder.err);
    REQUIRE(louder.code == 0);
    CHECK(tactus::sound::load_sound(folder.path / "l/heard.wav").samples[100] == 8.0F * given.samples[100]);
}

TEST_CASE("a card that cannot be heard offline, and a sensor that is not there, are refused") {
    const Folder folder;
    const std::string file = folder.write("echo.toml", echo).string();
    const Outcome offline = folder.tactus("render " + file + " --seconds 0.1 --out " + (folder.path / "o").string());
    CHECK(offline.code == 2);
    CHECK_THAT(offline.err,
               ContainsSubstring("node 'mic' reads from a sound card, which only 'tactus run' has; give it a "
                                 "sound of [assets] instead"));
    CHECK_THAT(offline.err, ContainsSubstring("echo.toml:6"));
    const Outcome none =
        folder.tactus("run " + file + " --seconds 0.1 --audio none --out " + (folder.path / "n").string());
    CHECK(none.code == 2);
    CHECK_THAT(none.err, ContainsSubstring("--audio names none"));
    const Outcome checked = folder.tactus("check " + file);
    CHECK(checked.code == 0);
    CHECK_THAT(checked.out, ContainsSubstring("sound input is delayed by 10 ms (--audio-margin) and one callback"));
    CHECK_THAT(checked.out, ContainsSubstring("a run adds the card's buffer, 10 ms (--audio-margin) and one callback"));
    const auto refused = [&](const std::string& from, const std::string& to) {
        std::string text = echo;
        text.replace(text.find(from), from.size(), to);
        const Outcome outcome = folder.tactus("check " + folder.write("p.toml", text).string());
        CHECK(outcome.code == 2);
        return outcome.err;
    };
    CHECK_THAT(refused("sensor = \"wrist\"", "sensor = \"wirst\""),
               ContainsSubstring("no sensor 'wirst' in [sensors]; did you mean 'wrist'?"));
    CHECK_THAT(
        refused("channel = 2\nfull", "chanel = 2\nfull"),
        ContainsSubstring("p.toml:3:10: no node that names sensor 'wrist' has a parameter 'chanel'; did you mean "
                          "'channel'?"));
    const std::string two = folder
                                .write("two.toml", R"(wires = [ "tone.signal -> left.signal" ]
[nodes]
tone = { type = "sine", rate = "48 kHz" }
left = { type = "audio_output", rate = "48 kHz", channel = 1 }
mic = { type = "audio_input", rate = "24 kHz" }
)")
                                .string();
    CHECK_THAT(folder.tactus("check " + two).err,
               ContainsSubstring("use channels of the sound card, so they need one rate"));
    CHECK_THAT(folder.tactus("check " + file + " --set sensors.wist.channel=1").err,
               ContainsSubstring("no sensor 'sensors.wist'"));
}
