// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/resample.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

std::vector<double> tone(double hz, double rate, std::size_t count) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / rate);
    return out;
}

/// Largest deviation from the tone itself, away from the ends.
double error_of(const std::vector<double>& samples, double hz, double rate, double start = 0.0) {
    double worst = 0.0;
    for (std::size_t i = samples.size() / 10; i < samples.size() * 9 / 10; ++i)
        worst = std::max(worst, std::abs(samples[i] - std::sin(2.0 * std::numbers::pi * hz *
                                                               (start + static_cast<double>(i) / rate))));
    return worst;
}

}  // namespace

TEST_CASE("a tone stays itself at another sample rate, at a ratio of small numbers and at an odd one") {
    for (const double from : {8000.0, 44100.0, 48000.0, 192000.0, 7919.3})
        for (const double to : {8000.0, 48000.0, 8123.4}) {
            INFO(from << " to " << to);
            const double hz = 0.35 * std::min(from, to);
            const auto count = static_cast<std::size_t>(from * 0.2);
            CHECK(error_of(signal::resample(tone(hz, from, count), from, to), hz, to) < 1.2e-3);
            CHECK(error_of(signal::resample(tone(233.0, from, count), from, to), 233.0, to) < 5e-4);
        }
}

TEST_CASE("resampling from a later start moves a tone by that time, to a fraction of a sample") {
    const double start = 0.0123456;
    CHECK(error_of(signal::resample(tone(400.0, 8000.0, 4000), 8000.0, 8000.0, start), 400.0, 8000.0, start) < 5e-4);
}

TEST_CASE("what the lower rate cannot carry is gone and not folded back") {
    const std::vector<double> high = signal::resample(tone(9000.0, 48000.0, 9600), 48000.0, 8000.0);
    for (std::size_t i = 200; i < 1400; ++i) CHECK(std::abs(high[i]) < 2e-4);
}

TEST_CASE("a record in pieces is resampled to the same bits as in one") {
    const std::vector<double> record = tone(700.0, 44100.0, 30000);
    for (const double to : {8000.0, 8123.4, 48000.0, 44100.0})
        for (const double start : {0.0, 0.1234567, -0.01}) {
            const std::vector<double> whole = signal::resample(record, 44100.0, to, start);
            for (const std::size_t piece : {std::size_t{1}, std::size_t{997}, std::size_t{29999}}) {
                INFO(to << " Hz from " << start << " s in pieces of " << piece);
                signal::ResamplingStream stream(record.size(), 44100.0, to, start);
                std::vector<double> out;
                for (std::size_t i = 0; i < record.size(); i += piece)
                    stream.push(std::span(record).subspan(i, std::min(piece, record.size() - i)), out);
                CHECK(stream.frames() == out.size());
                CHECK(out == whole);
            }
        }
}

TEST_CASE("resampling refuses rates that mean nothing and gives nothing of nothing") {
    CHECK_THROWS_AS(signal::resample(tone(1.0, 8.0, 10), 0.0, 8000.0), Error);
    CHECK(signal::resample(std::vector<double>{}, 48000.0, 8000.0).empty());
}
