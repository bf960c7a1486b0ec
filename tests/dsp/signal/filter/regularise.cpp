// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/regularise.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/geometry/spline.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

using namespace tactus;

namespace {

using Channels = std::vector<std::vector<double>>;

double wave(double t) { return std::sin(2.0 * std::numbers::pi * 17.0 * t); }

}  // namespace

TEST_CASE("a spline goes through its points, straight where they are straight") {
    const geometry::Spline line({0.0, 1.0, 3.0, 4.0}, {1.0, 3.0, 7.0, 9.0});
    for (const double x : {-1.0, 0.0, 0.3, 2.0, 4.0, 6.0}) {
        CHECK(line(x).value == Approx(1.0 + 2.0 * x));
        CHECK(line(x).slope == Approx(2.0));
    }
    CHECK_THROWS_AS(geometry::Spline({0.0, 0.0}, {1.0, 2.0}), Error);
    CHECK_THROWS_AS(geometry::Spline({0.0}, {1.0}), Error);
}

TEST_CASE("samples at uneven times give the wave they were taken from") {
    const Random random{1};
    std::vector<double> times, values;
    for (std::size_t i = 0; i < 2000; ++i) times.push_back(0.003 * (static_cast<double>(i) + 0.6 * random.uniform(i)));
    for (const double t : times) values.push_back(wave(t));
    const signal::EvenRecord even = signal::regularise(times, Channels{values});
    CHECK(even.rate == Approx(1.0 / 0.003).epsilon(1e-3));
    CHECK(even.usable < 0.5 * even.rate);
    CHECK(even.gaps == 0);
    REQUIRE(even.pieces.size() == 1);
    double worst = 0.0;
    const std::vector<double>& out = even.pieces[0][0];
    for (std::size_t i = 10; i + 10 < out.size(); ++i)
        worst = std::max(worst, std::abs(out[i] - wave(times.front() + static_cast<double>(i) / even.rate)));
    CHECK(worst < 2e-3);
}

TEST_CASE("uneven times do not change the level of a tone below 0.4 of the rate") {
    const Random random{1};
    for (const double frequency : {0.1, 0.2, 0.3, 0.39}) {
        std::vector<double> times, values;
        for (std::size_t i = 0; i < 4000; ++i) {
            times.push_back(0.003 * (static_cast<double>(i) + 0.4 * random.uniform(i) - 0.2));
            values.push_back(std::sin(2.0 * std::numbers::pi * frequency / 0.003 * times.back()));
        }
        const signal::EvenRecord even = signal::regularise(times, Channels{values});
        double square = 0.0;
        for (const double x : even.pieces[0][0]) square += x * x / static_cast<double>(even.pieces[0][0].size());
        CAPTURE(frequency);
        CHECK(std::sqrt(square) == Approx(1.0 / std::numbers::sqrt2).epsilon(0.005));
    }
}

TEST_CASE("a gap parts the record, nothing is made up in it, and equal time stamps are spread") {
    std::vector<double> times, values;
    for (int i = 0; i < 300; ++i) {
        if (i >= 100 && i < 150) continue;
        times.push_back(std::floor(i / 3) * 0.003);  // a clock of 3 ms under samples of 1 ms
        values.push_back(i);
    }
    const signal::EvenRecord even = signal::regularise(times, Channels{values});
    CHECK(even.rate == Approx(1000.0).epsilon(0.02));
    CHECK(even.gaps == 1);
    CHECK(even.lost == Approx(0.05).epsilon(0.1));
    REQUIRE(even.pieces.size() == 2);
    for (std::size_t i = 0; i + 1 < even.pieces[1][0].size(); ++i)
        CHECK(even.pieces[1][0][i + 1] - even.pieces[1][0][i] == Approx(1.0).epsilon(0.1));
}

TEST_CASE("times that run backwards or stand still are refused") {
    const std::vector<double> values{1, 2, 3, 4};
    CHECK_THROWS_WITH(signal::regularise(std::vector{0.0, 1.0, 0.5, 2.0}, Channels{values}),
                      Catch::Matchers::ContainsSubstring("backwards"));
    CHECK_THROWS_WITH(signal::regularise(std::vector{1.0, 1.0, 1.0, 1.0}, Channels{values}),
                      Catch::Matchers::ContainsSubstring("stands still"));
    CHECK_THROWS_AS(signal::regularise(std::vector{0.0}, Channels{values}), Error);
}

TEST_CASE("times that a coarse clock rounded are even, in every ratio of rate and clock") {
    for (const double rate : {130.0, 333.0, 700.0, 1600.0, 3200.0, 12345.0})
        for (const int rounding : {0, 1}) {
            CAPTURE(rate, rounding);
            const double clock = 1e-3, tone = 0.075 * rate;
            std::vector<double> times, values;
            for (int i = 0; i < 4000; ++i) {
                const double t = i / rate;
                times.push_back(clock * (rounding == 0 ? std::floor(t / clock + 1e-9) : std::round(t / clock)));
                values.push_back(std::sin(2.0 * std::numbers::pi * tone * t));
            }
            const signal::EvenRecord even = signal::regularise(times, Channels{values});
            CHECK(even.clock_step == Approx(clock));
            CHECK(even.rate == Approx(rate).epsilon(1e-3));
            REQUIRE(even.pieces.size() == 1);
            // Whatever is not the tone itself would be a line that the clock made.
            const std::vector<double>& out = even.pieces[0][0];
            double worst = 0.0;
            const double cosine = 2.0 * std::cos(2.0 * std::numbers::pi * tone / rate);
            for (std::size_t i = 20; i + 20 < out.size(); ++i)
                worst = std::max(worst, std::abs(out[i + 1] + out[i - 1] - cosine * out[i]));
            CHECK(worst < 0.02);
        }
}

TEST_CASE("times that were rounded to some decimals are even: the samples are taken as they are") {
    for (const double rate : {3200.0, 3000.0, 6666.0, 441.0}) {
        // From 3 % of a step to 0.02 %.
        for (const double clock : {1e-5, 1e-6, 1e-7}) {
            CAPTURE(rate, clock);
            std::vector<double> times, values;
            for (int i = 0; i < 3000; ++i) {
                times.push_back(clock * std::round(i / rate / clock));
                values.push_back(i % 2 == 0 ? 1.0 : -1.0);
            }
            const signal::EvenRecord even = signal::regularise(times, Channels{values});
            CHECK(even.rate == Approx(rate).epsilon(1e-5));
            REQUIRE(even.pieces.size() == 1);
            CHECK(even.pieces[0][0] == values);
        }
    }
    // Samples that jitter by more than the clock's step are interpolated.
    const Random random{4};
    std::vector<double> times, values;
    for (std::size_t i = 0; i < 3000; ++i) {
        times.push_back(1e-6 * std::round(1e6 * (static_cast<double>(i) + 0.02 * random.uniform(i)) / 3200.0));
        values.push_back(wave(times.back()));
    }
    CHECK(signal::regularise(times, Channels{values}).pieces[0][0] != values);
}

TEST_CASE("a clock that counts few steps in a record is refused, because the rate would be wrong") {
    const auto at_kilohertz = [](int count) {
        std::vector<double> times, values;
        for (int i = 0; i < count; ++i) times.push_back(std::floor(i / 1000.0)), values.push_back(wave(i / 1000.0));
        return signal::regularise(times, Channels{values});
    };
    CHECK_THROWS_WITH(at_kilohertz(8000), Catch::Matchers::ContainsSubstring("steps of 1 s, and 7 of them"));
    CHECK(at_kilohertz(60000).rate == Approx(1000.0).epsilon(1e-3));
}

TEST_CASE("a piece of any length between two gaps has the rate of the others under a coarse clock") {
    for (int count = 1; count <= 12; ++count) {
        CAPTURE(count);
        // 370 Hz under a clock of 10 ms.
        std::vector<double> times, values;
        for (int i = 0; i < 4000; ++i) {
            const bool is_short = i >= 2000 && i < 2000 + count;
            if (!is_short && i >= 1800 && i < 2200) continue;
            times.push_back(0.01 * std::floor(i / 370.0 / 0.01 + 1e-9));
            values.push_back(wave(i / 370.0));
        }
        const signal::EvenRecord even = signal::regularise(times, Channels{values});
        CHECK(even.rate == Approx(370.0).epsilon(1e-3));
        CHECK(even.pieces.size() >= 2);
    }
}

TEST_CASE("even times with lost samples, and uneven ones, are not taken for rounded") {
    std::vector<double> times, values;
    for (int i = 0; i < 1000; ++i)
        if (i != 300 && i != 301 && i != 700) times.push_back(1e-3 * i), values.push_back(wave(1e-3 * i));
    const signal::EvenRecord lost = signal::regularise(times, Channels{values});
    CHECK(lost.clock_step == 0.0);
    for (std::size_t i = 10; i + 10 < lost.pieces[0][0].size(); ++i)
        CHECK(std::abs(lost.pieces[0][0][i] - wave(static_cast<double>(i) / lost.rate)) < 2e-3);
    const Random random{3};
    times.clear(), values.clear();
    double time = 0.0;
    for (std::size_t i = 0; i < 1000; ++i) {
        time += 1e-3 * (1.0 + std::floor(4.0 * random.uniform(i)));
        times.push_back(time), values.push_back(wave(time));
    }
    CHECK(signal::regularise(times, Channels{values}).clock_step == 0.0);
}

TEST_CASE("a long record computed in parts is the wave it was taken from, at the borders of the parts too") {
    const Random random{3};
    const std::size_t count = 270000;
    std::vector<double> times, values;
    for (std::size_t i = 0; i < count; ++i) {
        // Even in the middle, where the samples are passed through.
        const double off = i > 120000 && i < 210000 ? 0.0 : 0.3 * random.uniform(i) - 0.15;
        times.push_back(0.003 * (static_cast<double>(i) + (i == 0 || i + 1 == count ? 0.0 : off)));
        values.push_back(wave(times.back()));
    }
    const signal::EvenRecord even = signal::regularise(times, Channels{values});
    REQUIRE(even.pieces.size() == 1);
    const std::vector<double>& out = even.pieces[0][0];
    REQUIRE(out.size() == even.frames);
    REQUIRE(out.size() == count);
    double worst = 0.0;
    for (std::size_t i = 10; i + 10 < out.size(); ++i)
        worst = std::max(worst, std::abs(out[i] - wave(static_cast<double>(i) / even.rate)));
    CHECK(worst < 1e-3);
}

TEST_CASE("the blocks of a record are the same after a rewind, kept or computed anew") {
    const Random random{5};
    for (const std::size_t channels : {std::size_t{1}, std::size_t{30}}) {
        const std::size_t count = 300000;  // of 30 channels more than are kept
        std::vector<double> times;
        for (std::size_t i = 0; i < count; ++i)
            times.push_back(0.001 * (static_cast<double>(i) + (i > 200000 ? 50.0 : 0.0)));
        signal::Regulariser even({count, channels,
                                  [&](std::size_t first, std::span<double> out) {
                                      std::copy_n(times.begin() + static_cast<std::ptrdiff_t>(first), out.size(),
                                                  out.begin());
                                  },
                                  [&](std::size_t channel, std::size_t first, std::span<double> out) {
                                      for (std::size_t n = 0; n < out.size(); ++n)
                                          out[n] = random.uniform(first + n) + static_cast<double>(channel);
                                  }});
        CHECK(even.facts().gaps == 1);
        CHECK(even.facts().lost == Approx(0.05));
        double first_sum = 0.0;
        for (int round = 0; round < 2; ++round) {
            double sum = 0.0;
            std::size_t frames = 0, gaps = 0;
            std::vector<std::vector<double>> block;
            for (bool after_gap = false; even.next(block, after_gap);) {
                gaps += after_gap;
                frames += block.front().size();
                for (const double x : block.back()) sum += x * static_cast<double>(frames % 17);
            }
            CHECK(frames == even.facts().frames);
            CHECK(gaps == 1);
            CHECK(frames == count);
            if (round == 0) first_sum = sum;
            CHECK(sum == first_sum);
            even.rewind();
        }
    }
}
