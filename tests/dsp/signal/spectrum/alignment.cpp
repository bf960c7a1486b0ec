// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/alignment.hpp"

#include "dsp/core/random.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "tests/dsp/vibration/plant.hpp"
#include "tests/support/catch.hpp"

#include <limits>
#include <tuple>
#include <vector>

using namespace tactus;

namespace {

constexpr double aligned_rate = 8000.0;

signal::Alignment align(const std::vector<double>& a, const std::vector<double>& b) {
    return signal::align_takes(a, b, aligned_rate, 40.0, 1000.0, 2.0);
}

std::vector<double> take_in(double strokes, bool cutting, std::uint64_t seed, double start = 0.0) {
    return signal::resample(test::saw(strokes, cutting, 6.0, 48000.0, seed), 48000.0, aligned_rate, start);
}

std::vector<double> played(const std::vector<float>& drive, double start = 0.0) {
    return signal::resample(test::Plant{}(drive), 48000.0, aligned_rate, start);
}

}  // namespace

TEST_CASE("a take and what an actuator made of it are found to belong together, whatever the delay", "[slow]") {
    for (const bool cutting : {false, true})
        for (const double delay : {0.0, 0.00123, 0.7, -0.4}) {
            INFO((cutting ? "cutting, " : "idle, ") << delay << " s");
            const std::vector<float> drive = test::saw(233.0, cutting, 6.0, 48000.0, 1);
            const std::vector<double> reference = signal::resample(drive, 48000.0, aligned_rate, std::max(delay, 0.0));
            const signal::Alignment found =
                align(reference, signal::resample(drive, 48000.0, aligned_rate, std::max(-delay, 0.0)));
            CHECK(found.significant);
            // What repeats itself 233 times a second tells the delay up to whole periods.
            const double error = found.delay - delay;
            CHECK((cutting ? error : std::remainder(error, 1.0 / 233.0)) == Approx(0.0).margin(2e-5));
            CHECK(found.correlation > 0.8);
            CHECK(align(reference, played(drive, std::max(-delay, 0.0))).significant);
        }
}

TEST_CASE("two takes of one saw do not belong together, however alike", "[slow]") {
    for (const bool cutting : {false, true})
        for (std::uint64_t seed = 1; seed < 6; ++seed) {
            INFO((cutting ? "cutting, seed " : "idle, seed ") << seed);
            const std::vector<double> reference = take_in(233.0, cutting, seed);
            CHECK_FALSE(align(reference, take_in(233.4, cutting, seed + 50)).significant);
            CHECK_FALSE(align(reference, take_in(150.0, cutting, seed + 50)).significant);
        }
}

TEST_CASE("a reversed polarity is found as a negative correlation") {
    const std::vector<double> reference = take_in(233.0, true, 1);
    std::vector<double> reversed = reference;
    for (double& x : reversed) x = -x;
    const signal::Alignment found = align(reference, reversed);
    CHECK(found.significant);
    CHECK(found.delay == Approx(0.0).margin(1e-6));
    CHECK(found.correlation == Approx(-1.0).margin(1e-6));
}

TEST_CASE("noise belongs to no other noise: no alarm in 200 pairs") {
    int alarms = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        std::vector<double> a(8000), b(8000);
        const Random x{2 * seed}, y{2 * seed + 1};
        for (std::size_t i = 0; i < a.size(); ++i) a[i] = x.normal(i), b[i] = y.normal(i);
        alarms += align(a, b).significant;
    }
    CHECK(alarms == 0);
}

TEST_CASE("silence and records of a few samples belong to nothing") {
    CHECK_FALSE(align(std::vector<double>(8000), std::vector<double>(8000)).significant);
    CHECK_FALSE(align(std::vector<double>(10, 1.0), std::vector<double>(10, 1.0)).significant);
    CHECK_FALSE(align({}, {}).significant);
}

TEST_CASE("a part of a loop is found in it, through a filter and across its end") {
    const Random random{11};
    std::vector<double> loop(8000), part(3000);
    double y = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) loop[i] = y = 0.7 * y + random.normal(i);
    for (const std::size_t begin : {std::size_t{0}, std::size_t{1234}, std::size_t{6500}}) {
        double low = 0.0;
        for (std::size_t i = 0; i < part.size(); ++i)
            part[i] = low = 0.5 * low + loop[(begin + i) % loop.size()] + 0.3 * random.normal(20000 + i);
        const auto found = static_cast<double>(signal::stretch_of_loop(loop, part, 4000.0, 40.0, 1000.0));
        CAPTURE(begin, found);
        const double off = std::abs(found - static_cast<double>(begin));
        CHECK(std::min(off, 8000.0 - off) <= 2.0);
    }
}

TEST_CASE("an exact excerpt correlates fully wherever it is, and a copy that is shifted by more than half of itself") {
    std::vector<double> whole(80000);
    const Random random{71};
    double dull = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = dull = 0.9 * dull + random.normal(i);
    const auto part = [&](double from, double seconds) {
        const auto start = whole.begin() + static_cast<std::ptrdiff_t>(from * aligned_rate);
        return std::vector<double>(start, start + static_cast<std::ptrdiff_t>(seconds * aligned_rate));
    };
    for (const auto& [reference, output, delay] :
         {std::tuple{part(0.0, 10.0), part(6.3, 1.5), -6.3}, std::tuple{part(8.1, 1.2), part(0.0, 10.0), 8.1},
          std::tuple{part(0.0, 3.0), part(1.5, 3.0), -1.5}, std::tuple{part(2.2, 4.0), part(0.0, 4.0), 2.2}}) {
        const signal::Alignment found =
            signal::align_takes(reference, output, aligned_rate, 40.0, 1000.0, std::numeric_limits<double>::infinity());
        CAPTURE(delay);
        CHECK(found.significant);
        CHECK(found.delay == Approx(delay).margin(1e-4));
        CHECK(found.correlation > 0.999);
    }
}

TEST_CASE("of what repeats itself the delay at which all of it agrees is found") {
    // Strikes every 0.37 s ring by themselves; the copy begins 1.5 s late, after silence.
    std::vector<double> strikes(48000), late(60000);
    for (std::size_t i = 0; i < strikes.size(); ++i) {
        const std::size_t since = i % 2960;
        strikes[i] = std::exp(-static_cast<double>(since) / 200.0) * std::sin(0.157 * static_cast<double>(since));
        late[i + 12000] = strikes[i];
    }
    const signal::Alignment found =
        signal::align_takes(strikes, late, aligned_rate, 40.0, 1000.0, std::numeric_limits<double>::infinity());
    CHECK(found.delay == Approx(1.5).margin(1e-4));
    CHECK(found.correlation > 0.9999);
}

TEST_CASE("without a limit of the delay noise belongs to no other noise either") {
    int alarms = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        std::vector<double> a(24000), b(16000);
        const Random x{9000 + 2 * seed}, y{9001 + 2 * seed};
        for (std::size_t i = 0; i < a.size(); ++i) a[i] = x.normal(i);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] = y.normal(i);
        alarms +=
            signal::align_takes(a, b, aligned_rate, 40.0, 1000.0, std::numeric_limits<double>::infinity()).significant;
    }
    CHECK(alarms == 0);
}
