// SPDX-License-Identifier: Apache-2.0
// Measuring through a sound card: a JACK server without hardware, its output connected to its input.
#include "assets/sound/response_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/jack_server.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

/// `tactus measure` with that at a server whose output port is connected to an input port; empty: it cannot be tried here.
json measured(const Folder& folder, const std::string& arguments, int out, int in) {
    if (std::system("command -v jackd >/dev/null && command -v jack_connect >/dev/null") != 0) {
        tactus::test::skip("no JACK server (apt-get install jackd2)");
        return {};
    }
    tactus::test::use_own_shared_memory();
    const tactus::test::Turn turn;
    const std::string base = folder.path.string();
    folder.write("asound.conf", "pcm.!default { type null }\n");
    folder.write("arguments", arguments);
    folder.write("card.sh", R"(cd "$1"
export JACK_DEFAULT_SERVER=tactus_test_$$ JACK_NO_START_SERVER=1 JACK_NO_AUDIO_RESERVATION=1 ALSA_CONFIG_PATH=$1/asound.conf
jackd -n $JACK_DEFAULT_SERVER -r -m -d dummy -r 48000 -p 1024 -C 2 -P 2 >jackd.log 2>&1 &
server=$!
jack_wait -w -t 10 >/dev/null 2>&1 || { kill $server; exit 77; }
"$2" measure $(cat arguments) --json >measured.json 2>measured.err &
measuring=$!
for attempt in 1 2 3 4 5 6 7 8 9 10; do
  jack_connect tactus:out_$3 tactus:in_$4 >/dev/null 2>&1 && break
  sleep 0.02
done
wait $measuring; code=$?
kill $server; wait $server
rm -f /dev/shm/jack_sem.*_"$JACK_DEFAULT_SERVER"_*
exit $code
)");
    const int status = std::system(("sh " + base + "/card.sh " + base + " " + tactus::test::command() + " " +
                                    std::to_string(out) + " " + std::to_string(in))
                                       .c_str());
    if (WEXITSTATUS(status) == 77) {
        tactus::test::skip("the JACK server does not start here");
        return {};
    }
    INFO(slurp(folder.path / "measured.err"));
    REQUIRE(WEXITSTATUS(status) == 0);
    json result = json::parse(slurp(folder.path / "measured.json"));
    CHECK(result["device"]["name"] == "JACK Audio Connection Kit: system");
    if (result["device"]["underflows"] > 0) {
        tactus::test::skip("this machine was too busy to play without gaps");
        return {};
    }
    return result;
}

}  // namespace

TEST_CASE("a sweep through a sound card measures the delay of the loop and that a cable changes nothing", "[live]") {
    const Folder folder;
    const json result =
        measured(folder, "--device default --amplitude 0.5 --duration 2 --pause 0.5 --repeats 2 -o card.csv", 0, 0);
    if (result.is_null()) return;
    // What the client plays in one period of the server it hears in the next.
    CHECK(result["latency_s"].get<double>() == Approx(1024.0 / 48000.0).margin(2e-5));
    CHECK(result["coherence_mean"] > 0.999);
    CHECK(result["resonance_hz"].is_null());
    for (const json& order : result["thd"]) CHECK(order["percent"] < 0.1);
    CHECK(result["device"]["clipped_samples"] == 0);
}

TEST_CASE("an actuator is calibrated by a sensor of its patch in their units, and its equaliser is made", "[live]") {
    const Folder folder;
    folder.write("calibrate.toml", R"(wires = [ "skin.signal -> kept.in" ]
[actuators.handle]
channel = 2
full_scale = 2
[sensors.skin]
channel = 1
full_scale = 49
[nodes]
skin = { type = "audio_input", rate = "48 kHz", sensor = "skin" }
kept = { type = "record", rate = "48 kHz" }
)");
    const json result = measured(
        folder,
        "calibrate.toml --actuator handle --sensor skin --duration 2 --pause 0.5 -o card.csv --equaliser flat.toml", 1,
        0);
    if (result.is_null()) return;
    // The cable passes each volt as half of full scale, which the sensor calls 24.5.
    const auto response = tactus::sound::load_response(folder.path / "card.csv").identified.response;
    for (std::size_t i = 0; i < response.hz.size(); ++i) {
        if (response.hz[i] < 50.0 || response.hz[i] > 1000.0) continue;
        CAPTURE(response.hz[i]);
        REQUIRE(std::abs(response.gain[i]) == Approx(24.5).epsilon(0.01));
    }
    CHECK(result["equaliser"]["deviation_after_db"] < 0.5);
    CHECK(std::filesystem::exists(folder.path / "flat.toml"));
    const Outcome loud = folder.tactus("measure " + (folder.path / "calibrate.toml").string() +
                                       " --actuator handle --sensor skin --amplitude 3");
    CHECK(loud.code == 2);
    CHECK(loud.err.find("an amplitude of 3 is more than actuator 'handle' has at full scale, 2") != std::string::npos);
    const Outcome half = folder.tactus("measure " + (folder.path / "calibrate.toml").string() + " --actuator handle");
    CHECK(half.code == 2);
    CHECK(half.err.find("--sensor NAME") != std::string::npos);
}

TEST_CASE("a machine without a sound card that listens is told so") {
    const Folder folder;
    const Outcome outcome = folder.tactus("measure --device no-such-card -o " + (folder.path / "r.csv").string());
    CHECK(outcome.code == 2);
    CHECK_FALSE(outcome.err.empty());
    CHECK_FALSE(std::filesystem::exists(folder.path / "r.csv"));
}
