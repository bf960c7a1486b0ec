// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/equalisation.hpp"

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <cmath>
#include <fstream>

using namespace tactus;

namespace {

/// A flat response with a notch of this depth and quality factor between two centres of third octaves.
analysis::Equalisation equalised(double depth_db, double q, double greatest_db, vibration::EqualiserKind kind) {
    const test::Folder folder;
    const std::filesystem::path file = folder.path / "notch.csv";
    std::ofstream out(file);
    out << "frequency_hz,level_db\n";
    for (double hz = 20.0; hz < 2000.0; hz *= 1.004) {
        const double away = q * (hz / 283.0 - 283.0 / hz);
        out << hz << "," << depth_db / (1.0 + away * away) << "\n";
    }
    out.close();
    analysis::EqualiseSettings settings;
    settings.response = file;
    settings.design.kind = kind;
    settings.design.greatest_gain = std::pow(10.0, greatest_db / 20.0);
    return analysis::equalise(settings);
}

}  // namespace

TEST_CASE("the boost and the loudest sine of an equaliser are those of all frequencies, not of third octaves") {
    for (const auto kind : {vibration::EqualiserKind::minimum_phase, vibration::EqualiserKind::linear_phase})
        for (const double q : {4.0, 15.0}) {
            CAPTURE(q);
            const analysis::Equalisation made = equalised(-20.0, q, 30.0, kind);
            // The notch has -20 dB at 283 Hz; the centres of the bands beside it are 251 and 316 Hz.
            CHECK(made.flat.before_db > 17.0);
            CHECK(made.flat.loudest_hz == Approx(283.0).epsilon(0.01));
            double greatest = 0.0;
            for (double hz = 1.0; hz < 2400.0; hz += 0.37)
                greatest = std::max(greatest, 20.0 * std::log10(std::abs(made.equaliser.gain(hz))));
            CHECK(made.flat.boost_db == Approx(greatest).margin(0.05));
            CHECK(made.flat.boost_hz == Approx(283.0).epsilon(0.01));
        }
}

TEST_CASE("the taps of an equaliser keep to the greatest gain that was allowed") {
    for (const auto kind : {vibration::EqualiserKind::minimum_phase, vibration::EqualiserKind::linear_phase})
        for (const double greatest_db : {3.0, 6.0, 12.0}) {
            CAPTURE(greatest_db);
            CHECK(equalised(-25.0, 20.0, greatest_db, kind).flat.boost_db <= greatest_db + 0.1);
        }
}
