// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>

using namespace tactus;
using test::NodeHarness;

namespace {

/// Root mean square of samples first … first + 0.2 s.
double level(const std::vector<float>& samples, std::size_t first) {
    double sum = 0.0;
    for (std::size_t i = first; i < first + 9600; ++i) sum += std::pow(static_cast<double>(samples[i]), 2.0);
    return std::sqrt(sum / 9600.0);
}

}  // namespace

TEST_CASE("a saw spins up to its rate while the trigger is held, and stops after") {
    NodeHarness node("saw");
    node.set("blade_rate", "200 Hz").disconnect("load");
    node.feed<bool>("trigger", [](std::int64_t k) { return k < 48000; });
    node.prepare();
    node.run(3 * 48000);
    const auto rate = node.values<double>("rate");
    CHECK(rate[0] < 10.0);
    CHECK(rate[47999] == Approx(200.0).epsilon(0.01));
    CHECK(rate.back() == Approx(0.0).margin(1.0));
    CHECK(node.values<bool>("running")[47999]);
    CHECK_FALSE(node.last<bool>("running"));
    CHECK(node.last<float>("signal") == 0.0f);
}

TEST_CASE("a saw with no trigger wire always runs, and cuts louder than it idles") {
    NodeHarness node("saw");
    node.set("blade_rate", "200 Hz").disconnect("trigger");
    node.feed<double>("load", [](std::int64_t k) { return k < 48000 ? 0.0 : 7.0; });
    node.prepare();
    node.run(2 * 48000);
    const auto signal = node.values<float>("signal");
    // The sample recordings: 20 and 50 m/s² of a fundamental with 30 % of its octave.
    const double shape = std::sqrt((1.0 + 0.09) / 2.0);
    CHECK(level(signal, 36000) == Approx(20.0 * shape).epsilon(0.05));
    CHECK(level(signal, 84000) == Approx(50.0 * shape).epsilon(0.05));
}

TEST_CASE("a saw played as a model has the levels and the rate of its recordings") {
    NodeHarness node("saw");
    node.set("blade_rate", "200 Hz").set("voice", "model").disconnect("trigger").disconnect("density");
    node.feed<double>("load", [](std::int64_t k) { return k < 48000 ? 0.0 : 7.0; });
    node.prepare();
    node.run(2 * 48000);
    const auto signal = node.values<float>("signal");
    const double shape = std::sqrt((1.0 + 0.09) / 2.0);
    CHECK(level(signal, 36000) == Approx(20.0 * shape).epsilon(0.05));
    CHECK(level(signal, 84000) == Approx(50.0 * shape).epsilon(0.05));
    CHECK(node.last<double>("rate") == Approx(200.0).epsilon(0.01));
    CHECK(node.last<bool>("running"));
}
