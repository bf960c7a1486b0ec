// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/weighting.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using signal::weighting_b;
using signal::weighting_d;
using signal::weighting_h;
using signal::weighting_k;

namespace {

std::vector<double> sine(double frequency, double amplitude, double seconds, double rate) {
    std::vector<double> x(static_cast<std::size_t>(seconds * rate));
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = amplitude * std::sin(2.0 * std::numbers::pi * frequency * static_cast<double>(i) / rate);
    return x;
}

}  // namespace

TEST_CASE("the weighting of the hand has the values of its definition in the norm") {
    // |H| at 10^(n/10) Hz, n = 8 … 31.
    constexpr std::array wanted{.72721, .87310, .95140, .95759, .89581, .78198, .64708, .51917,
                                .41111, .32439, .25605, .20239, .16021, .12696, .10068, .07988,
                                .06338, .05026, .03980, .03137, .02447, .01862, .01346, .00894};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double frequency = std::pow(10.0, (8.0 + static_cast<double>(i)) / 10.0);
        CHECK(std::abs(std::abs(weighting_h(frequency)) - wanted[i]) < 6e-6);
    }
    CHECK(std::abs(weighting_h(500.0 / (2.0 * std::numbers::pi))) == Approx(0.2020).margin(5e-5));
    CHECK(std::abs(weighting_h(233.0)) == Approx(0.06835).margin(5e-6));
}

TEST_CASE("the weightings of the body have the values of ISO 2631-1, table 3, from 0.1 to 100 Hz") {
    // Factors in thousandths of Wk and Wd, at 10^(n/10) Hz, n = -10 … 20.
    constexpr std::array k{31.2, 48.6, 79.0, 121., 182., 263., 352.,  418.,  459.,  477., 482.,
                           484., 494., 531., 631., 804., 967., 1039., 1054., 1036., 988., 902.,
                           768., 636., 513., 405., 314., 246., 186.,  132.,  88.7};
    constexpr std::array d{62.4,  97.3, 158., 243., 365., 530., 713., 853., 944., 992., 1011.,
                           1008., 968., 890., 776., 642., 512., 409., 323., 253., 212., 161.,
                           125.,  100., 80.0, 63.2, 49.4, 38.8, 29.5, 21.1, 14.1};
    for (std::size_t i = 0; i < k.size(); ++i) {
        const double frequency = std::pow(10.0, (static_cast<double>(i) - 10.0) / 10.0);
        CAPTURE(frequency);
        CHECK(1e3 * std::abs(weighting_k(frequency)) == Approx(k[i]).epsilon(0.02));
        // The table of 1997 has 212 at 10 Hz, where the definition has 202.
        CHECK(1e3 * std::abs(weighting_d(frequency)) == Approx(d[i]).epsilon(i == 20 ? 0.05 : 0.02));
    }
}

TEST_CASE("the weighting of trains is that of ISO 8041-1: 1.024 times its transition and step, with the limits of Wk") {
    // python3 -c "import numpy as np
    // for f in (0.5, 1, 2, 4, 6.3095734, 8, 10, 16, 31.622777, 80):
    //     s = 2j*np.pi*f; p = lambda f, q: 1 + s/(2*np.pi*f*q) + (s/(2*np.pi*f))**2
    //     w = 2*np.pi*.4
    //     print(f, abs(1/(1 + 2**.5*w/s + (w/s)**2) / p(100, .5**.5) * 1.024*(1 + s/(2*np.pi*16)) / p(16, .55)
    //                  * p(2.5, .9) / p(4, .95) * (2.5/4)**2))"
    for (const auto& [frequency, wanted] : std::initializer_list<std::pair<double, double>>{{0.5, 0.3342310},
                                                                                            {1.0, 0.3852515},
                                                                                            {2.0, 0.4173091},
                                                                                            {4.0, 0.8891442},
                                                                                            {6.3095734, 1.0544942},
                                                                                            {8.0, 1.0250521},
                                                                                            {10.0, 0.9744800},
                                                                                            {16.0, 0.8102712},
                                                                                            {31.622777, 0.4906260},
                                                                                            {80.0, 0.1714882}})
        CHECK(std::abs(weighting_b(frequency)) == Approx(wanted).epsilon(1e-6));
}

TEST_CASE("the filter is within 0.5 % of the definition in the bands of each weighting, from 16 times its limit on") {
    struct Case {
        const signal::Weighting& weighting;
        double rate, deviation;
    };
    for (const Case& one : {Case{weighting_h, 20000.0, 0.005},
                            {weighting_h, 44100.0, 0.001},
                            {weighting_h, 48000.0, 0.001},
                            {weighting_h, 96000.0, 5e-4},
                            {weighting_k, 1600.0, 0.005},
                            {weighting_d, 1600.0, 0.005},
                            {weighting_b, 1600.0, 0.005},
                            {weighting_k, 48000.0, 1e-4},
                            {weighting_d, 48000.0, 1e-4},
                            {weighting_b, 48000.0, 1e-4}}) {
        const signal::WeightingFilter filter(one.weighting, one.rate);
        for (double f = 0.3 * one.weighting.low; f < 1.6 * one.weighting.high; f *= 1.05) {
            const double ratio = std::abs(filter.response(f)) / std::abs(one.weighting(f));
            CAPTURE(std::string(one.weighting.name), one.rate, f);
            if (f >= one.weighting.lowest * 1.12 && f <= one.weighting.highest / 1.12)
                CHECK(std::abs(ratio - 1.0) < one.deviation);
            else CHECK(std::abs(ratio - 1.0) < 0.02);
        }
    }
}

TEST_CASE("filter and transform agree within 0.5 % from one second and 20 kHz on, whatever offset the record has") {
    for (const double rate : {20000.0, 48000.0})
        for (const double seconds : {1.0, 1.37, 5.0})
            for (const double frequency : {8.0, 31.5, 125.0, 233.0, 1000.0}) {
                CAPTURE(rate, seconds, frequency);
                std::vector<double> x(static_cast<std::size_t>(seconds * rate));
                for (std::size_t i = 0; i < x.size(); ++i)
                    x[i] = -9.81 + 10.0 * std::cos(2.0 * std::numbers::pi * frequency * static_cast<double>(i) / rate);
                signal::WeightedRecord record(weighting_h, rate, -9.81);
                record.push(std::span(x).first(x.size() / 3));
                record.push(std::span(x).subspan(x.size() / 3));
                record.end_piece();
                CHECK(record.by_filter() == Approx(record.by_transform()).epsilon(0.005));
                const double wanted = 10.0 / std::numbers::sqrt2 * std::abs(weighting_h(frequency));
                CHECK(record.by_transform() == Approx(wanted).epsilon(frequency < 20.0 ? 0.02 : 0.005));
            }
}

TEST_CASE("a gap parts the record: no step between its pieces is weighted") {
    const std::vector<double> x = sine(100.0, 1.0, 2.0, 48000.0);
    signal::WeightedRecord whole(weighting_h, 48000.0, 0.0), parted(weighting_h, 48000.0, 0.0);
    whole.push(x);
    whole.end_piece();
    parted.push(std::span(x).first(48000));
    parted.end_piece();
    parted.push(std::span(x).subspan(48000));
    parted.end_piece();
    CHECK(parted.by_transform() == Approx(whole.by_transform()).epsilon(0.005));
    CHECK(parted.by_filter() == Approx(parted.by_transform()).epsilon(0.002));
}

TEST_CASE("a sine has the dose (3/8 T)^1/4 of its weighted amplitude, and a burst the running rms of its second") {
    constexpr double rate = 2000.0, seconds = 60.0;
    const double amplitude = 2.0 * std::abs(weighting_k(6.0));
    signal::WeightedRecord steady(weighting_k, rate, 0.0);
    steady.push(sine(6.0, 2.0, seconds, rate));
    steady.end_piece();
    CHECK(steady.seconds() == 60.0);
    CHECK(steady.dose() == Approx(amplitude * std::pow(0.375 * seconds, 0.25)).epsilon(0.005));
    CHECK(steady.peak() == Approx(amplitude).epsilon(0.15));  // the onset overshoots
    CHECK(steady.max_running_rms() == Approx(amplitude / std::numbers::sqrt2).epsilon(0.03));
    // Two seconds of a minute: the greatest second is that of the burst, the mean is much less.
    std::vector<double> burst(120000);
    const std::vector<double> two = sine(6.0, 2.0, 2.0, rate);
    std::copy(two.begin(), two.end(), burst.begin() + 50000);
    signal::WeightedRecord record(weighting_k, rate, 0.0);
    record.push(burst);
    record.end_piece();
    CHECK(record.max_running_rms() == Approx(amplitude / std::numbers::sqrt2).epsilon(0.03));
    CHECK(record.by_filter() == Approx(amplitude / std::numbers::sqrt2 * std::sqrt(2.0 / 60.0)).epsilon(0.03));
    // After a gap the running second begins anew.
    signal::WeightedRecord parted(weighting_k, rate, 0.0);
    for (int i = 0; i < 3; ++i) {
        parted.push(std::span(burst).subspan(50000, 1000));
        parted.end_piece();
    }
    CHECK(parted.max_running_rms() < 1.1 * record.max_running_rms());
}
