// SPDX-License-Identifier: Apache-2.0
// Nodes that listen to vibration from a slow group: what they say, and that a tick of theirs stays real-time safe.
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/realtime_check.hpp"

#include <string>

using namespace tactus;
using test::NodeHarness;

namespace {

/// Batches of about ten values every 1/800 s: 16 kHz at most. In the harness a batch is of any length from 0 to 20, so
/// time is what has come, not what has passed.
test::HarnessOptions slow() { return {.period = flicks_per_second / 800}; }

double number(const Report& report, const char* section, const char* key) {
    return std::get<double>(report.sections.at(section).at(key));
}

}  // namespace

TEST_CASE("the nodes that listen transform segments without allocating, locking or calling the system") {
    for (const char* type : {"spectrum_analyser", "spectral_monitor"}) {
        INFO(type);
        NodeHarness node(type, slow());
        if (std::string(type) == "spectrum_analyser") node.set("segment", "50 ms");
        node.prepare();
        const RealtimeViolations seen = watch_scopes([&] { node.run(4000); });
        INFO(seen.describe());
        CHECK(seen.none());
        CHECK(node.finite());
        if (std::string(type) == "spectrum_analyser") CHECK(number(node.report(), "node", "segments") > 20.0);
        else CHECK(number(node.report(), "node", "heard_s") > 1.0);
    }
}

TEST_CASE("at 44.1 kHz the nodes that listen are real-time safe, whatever factors their segments have") {
    // 20 values in a full batch; segments of 2205 and 4410 samples have the factor 7, 2249 and 22579 large primes.
    const test::HarnessOptions of_44100{.period = flicks_per_second / 2205};
    for (const char* segment : {"50 ms", "100 ms", "51 ms", "512 ms", ""}) {
        const bool is_monitor = !*segment;
        INFO(segment);
        NodeHarness node(is_monitor ? "spectral_monitor" : "spectrum_analyser", of_44100);
        if (!is_monitor) node.set("segment", segment);
        node.prepare();
        const RealtimeViolations seen = watch_scopes([&] { node.run(10000); });
        INFO(seen.describe());
        CHECK(seen.none());
        CHECK(node.finite());
        if (is_monitor) CHECK(number(node.report(), "node", "heard_s") > 1.0);
        else CHECK(number(node.report(), "node", "segments") > 3.0);
    }
}

TEST_CASE("a signal too slow to carry a vibration is refused by name") {
    NodeHarness node("spectral_monitor", {.period = flicks_per_second / 10});
    CHECK_THROWS_WITH(node.prepare(), Catch::Matchers::ContainsSubstring("223 Hz"));
}
