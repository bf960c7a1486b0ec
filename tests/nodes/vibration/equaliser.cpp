// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/equaliser.hpp"

#include "dsp/vibration/sweep.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::NodeHarness;

namespace {

std::shared_ptr<const vibration::Equaliser> filter_of(std::vector<float> taps, double delay = 0.0,
                                                      double rate = 48000.0) {
    vibration::Equaliser equaliser;
    equaliser.taps = std::move(taps);
    equaliser.delay = delay;
    equaliser.rate = rate;
    return std::make_shared<const vibration::Equaliser>(std::move(equaliser));
}

}  // namespace

TEST_CASE("an equaliser node gives its impulse response, by halves when half of it is asked for") {
    const std::vector<float> taps{0.5f, -0.25f, 2.0f, 0.125f};
    for (const bool half : {false, true}) {
        NodeHarness node("equaliser");
        node.asset("filter", filter_of(taps, 2.0 / 48000.0));
        node.feed<float>("in", [](std::int64_t k) { return k == 10 ? 1.0f : 0.0f; });
        if (half) node.set("amount", "0.5");
        node.prepare();
        node.run(40);
        const auto out = node.values<float>("out");
        for (std::size_t i = 0; i < out.size(); ++i) {
            const float tap = i >= 10 && i < 14 ? taps[i - 10] : 0.0f;
            // The other half is the signal itself, as late as the equalised one.
            CHECK(out[i] == (half ? 0.5f * tap + (i == 12 ? 0.5f : 0.0f) : tap));
        }
    }
}

TEST_CASE("an equaliser made for another rate is refused and the message says how to make one that fits") {
    NodeHarness node("equaliser");
    node.asset("filter", filter_of({1.0f}, 0.0, 44100.0));
    CHECK_THROWS_WITH(node.prepare(), ContainsSubstring("44100 Hz") && ContainsSubstring("--rate 48000"));
}

TEST_CASE("a sweep node plays the sweep that identification expects, as often as asked, then silence") {
    NodeHarness node("sweep");
    node.set("first", "50 Hz")
        .set("last", "500 Hz")
        .set("duration", "0.1 s")
        .set("pause", "0.05 s")
        .set("repeats", "2");
    node.set("amplitude", "3");
    node.prepare();
    node.run(24000);
    const auto out = node.values<float>("signal");
    const vibration::ExponentialSweep sweep{50.0, 500.0, 0.1, 0.01};
    for (std::size_t i = 0; i < 7200; ++i) {
        CHECK(static_cast<double>(out[i]) == Approx(3.0 * sweep(static_cast<double>(i) / 48000.0)).margin(1e-6));
        CHECK(out[i + 7200] == out[i]);
        CHECK(out[i + 14400] == 0.0f);
    }
}

TEST_CASE("a sweep that cannot be played is refused") {
    for (const char* last : {"10 Hz", "30 kHz"}) {
        NodeHarness node("sweep");
        node.set("last", last);
        CHECK_THROWS_AS(node.prepare(), Error);
    }
}
