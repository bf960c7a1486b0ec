// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr int rate = 48000;

/// Half a second of the tone of a constant force, after another half second in which it settles.
std::vector<float> tone_of(const Vec3& force) {
    NodeHarness node("force_tone");
    node.feed<Wrench>("wrench", Wrench{force, Vec3(0.0)});
    node.prepare();
    node.run(rate);
    const std::vector<float> all = node.values<float>("signal");
    return {all.begin() + rate / 2, all.end()};
}

double peak_of(const std::vector<float>& tone) {
    double peak = 0.0;
    for (const float x : tone) peak = std::max(peak, std::abs(static_cast<double>(x)));
    return peak;
}

/// Cycles per second, of upward crossings.
double frequency_of(const std::vector<float>& tone) {
    int first = -1, last = -1, count = 0;
    for (std::size_t k = 1; k < tone.size(); ++k) {
        if (!(tone[k - 1] < 0.0f && tone[k] >= 0.0f)) continue;
        if (first < 0) first = static_cast<int>(k);
        last = static_cast<int>(k);
        ++count;
    }
    return count < 2 ? 0.0 : (count - 1.0) * rate / (last - first);
}

}  // namespace

TEST_CASE("a force tone is louder and higher the larger the force is and silent without one") {
    CHECK(peak_of(tone_of(Vec3(0.0))) == 0.0);
    const auto half = tone_of({3.0, 0.0, 4.0}), full = tone_of({0.0, -10.0, 0.0}), more = tone_of({0.0, 0.0, 60.0});
    CHECK(peak_of(half) == Approx(0.25).epsilon(0.01));
    CHECK(frequency_of(half) == Approx(220.0).epsilon(0.005));
    CHECK(peak_of(full) == Approx(0.5).epsilon(0.01));
    CHECK(frequency_of(full) == Approx(440.0).epsilon(0.005));
    CHECK(peak_of(more) == Approx(0.5).epsilon(0.01));
}

TEST_CASE("a force that is not a number makes no tone and none that stays") {
    CHECK(peak_of(tone_of({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0})) == 0.0);
    CHECK(peak_of(tone_of({std::numeric_limits<double>::infinity(), 0.0, 0.0})) == 0.0);
}
