// SPDX-License-Identifier: Apache-2.0
// Measuring through a sound card: a JACK server without hardware, its output connected to its input.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

TEST_CASE("a sweep through a sound card tells the delay of the loop and that a cable changes nothing", "[live]") {
    if (std::system("command -v jackd >/dev/null && command -v jack_connect >/dev/null") != 0) {
        tactus::test::skip("no JACK server (apt-get install jackd2)");
        return;
    }
    const Folder folder;
    const std::string base = folder.path.string(), csv = base + "/card.csv";
    folder.write("asound.conf", "pcm.!default { type null }\n");
    folder.write("card.sh", R"(cd "$1"
export JACK_DEFAULT_SERVER=tactus_test_$$ JACK_NO_START_SERVER=1 JACK_NO_AUDIO_RESERVATION=1 ALSA_CONFIG_PATH=$1/asound.conf
jackd -n $JACK_DEFAULT_SERVER -r -m -d dummy -r 48000 -p 1024 -C 2 -P 2 >jackd.log 2>&1 &
server=$!
jack_wait -w -t 10 >/dev/null 2>&1 || { kill $server; exit 77; }
"$2" measure --device default --amplitude 0.5 --duration 2 --pause 0.5 --repeats 2 --json -o card.csv >measured.json 2>measured.err &
measuring=$!
for attempt in 1 2 3 4 5 6 7 8 9 10; do
  jack_connect tactus:out_0 tactus:in_0 >/dev/null 2>&1 && break
  sleep 0.02
done
wait $measuring; code=$?
kill $server; wait $server
rm -f /dev/shm/jack_sem.*_"$JACK_DEFAULT_SERVER"_*
exit $code
)");
    const int status = std::system(("sh " + base + "/card.sh " + base + " " + tactus::test::command()).c_str());
    if (WEXITSTATUS(status) == 77) {
        tactus::test::skip("the JACK server does not start here");
        return;
    }
    INFO(slurp(folder.path / "measured.err"));
    REQUIRE(WEXITSTATUS(status) == 0);
    const json result = json::parse(slurp(folder.path / "measured.json"));
    CHECK(result["device"]["name"] == "JACK Audio Connection Kit: system");
    if (result["device"]["underflows"] > 0) {
        tactus::test::skip("this machine was too busy to play without gaps");
        return;
    }
    // What the client plays in one period of the server it hears in the next.
    CHECK(result["latency_s"].get<double>() == Approx(1024.0 / 48000.0).margin(2e-5));
    CHECK(result["coherence_mean"] > 0.999);
    CHECK(result["resonance_hz"].is_null());
    for (const json& order : result["thd"]) CHECK(order["percent"] < 0.1);
}

TEST_CASE("a machine without a sound card that listens is told so", "[live]") {
    const Folder folder;
    const Outcome outcome = folder.tactus("measure --device no-such-card -o " + (folder.path / "r.csv").string());
    CHECK(outcome.code == 2);
    CHECK_FALSE(outcome.err.empty());
    CHECK_FALSE(std::filesystem::exists(folder.path / "r.csv"));
}
