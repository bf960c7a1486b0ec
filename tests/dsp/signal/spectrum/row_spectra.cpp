// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/row_spectra.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

signal::WelchSettings settings() {
    signal::WelchSettings welch = signal::WelchSettings::hann(1000.0, 100, 50);
    welch.scaling = signal::Scaling::spectrum;
    return welch;
}

/// 100 Hz, with an amplitude that is the second.
std::vector<double> rising(std::size_t count) {
    std::vector<double> x(count);
    for (std::size_t i = 0; i < count; ++i)
        x[i] = static_cast<double>(i) / 1000.0 * std::sin(0.2 * std::numbers::pi * static_cast<double>(i));
    return x;
}

}  // namespace

TEST_CASE("each row has the level of its own stretch, however the samples come") {
    signal::RowSpectra rows(settings(), 3000, 51), pieces(settings(), 3000, 51);
    const std::vector<double> x = rising(3000);
    rows.push(x);
    for (std::size_t i = 0; i < x.size(); i += 17)
        pieces.push(std::span(x).subspan(i, std::min<std::size_t>(17, x.size() - i)));
    REQUIRE(rows.rows().size() == 59);
    CHECK(rows.rows() == pieces.rows());
    for (std::size_t i = 0; i < 59; ++i) {
        const double middle = (static_cast<double>(i) * 50.0 + 50.0) / 1000.0;
        CHECK(std::sqrt(2.0 * static_cast<double>(rows.rows()[i][10])) == Approx(middle).epsilon(0.01));
    }
}

TEST_CASE("a long record has no more rows than a picture can show, each of all its samples") {
    const std::vector<double> x = rising(300000);
    signal::RowSpectra rows(settings(), x.size(), 11);
    rows.push(x);
    CHECK(rows.rows().size() == signal::RowSpectra::max_rows);
    CHECK(rows.length() == 750);
    CHECK(rows.rows().front().size() == 11);
    for (std::size_t i = 100; i < 400; ++i)
        CHECK(std::sqrt(2.0 * static_cast<double>(rows.rows()[i][10])) ==
              Approx(0.75 * (static_cast<double>(i) + 0.5)).epsilon(0.01));
}
