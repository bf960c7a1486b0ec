// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/headroom.hpp"

#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace tactus::vibration {

namespace {

/// Power per bin of the whole record with a Hann window.
std::vector<double> powers(std::span<const double> samples, std::size_t size) {
    std::vector<double> windowed(samples.begin(), samples.end()), out;
    const double turn = 2.0 * std::numbers::pi / static_cast<double>(samples.size());
    for (std::size_t i = 0; i < windowed.size(); ++i)
        windowed[i] *= 0.5 - 0.5 * std::cos(turn * (static_cast<double>(i) + 0.5));
    for (const auto& value : signal::spectrum_of(windowed, size)) out.push_back(std::norm(value));
    return out;
}

}  // namespace

double voltage_within(double voltage_limit, double current_limit, double resistance) {
    return std::min(voltage_limit, current_limit * resistance);
}

Headroom headroom(std::span<const double> drive, double rate, double limit) {
    Headroom result;
    std::vector<double> cut(drive.begin(), drive.end());
    std::size_t limited = 0;
    for (double& volt : cut) {
        result.peak = std::max(result.peak, std::abs(volt));
        const double kept = std::clamp(volt, -limit, limit);
        limited += kept != volt;
        volt = kept;
    }
    if (drive.empty() || !(result.peak > 0.0)) return result;
    result.headroom_db = 20.0 * std::log10(limit / result.peak);
    result.limited_fraction = static_cast<double>(limited) / static_cast<double>(drive.size());
    if (limited == 0) return result;
    const std::size_t size = std::bit_ceil(drive.size());
    const std::vector<double> before = powers(drive, size), after = powers(cut, size);
    const double step = rate / static_cast<double>(size);
    struct Band {
        double centre, asked = 0.0, left = 0.0;
    };
    std::vector<Band> bands;
    double strongest = 0.0;
    for (int n = 16; n <= 30; ++n) {
        Band& band = bands.emplace_back(Band{std::pow(10.0, n / 10.0)});
        for (std::size_t k = 0; k < before.size(); ++k) {
            const double f = static_cast<double>(k) * step;
            if (f < band.centre * std::pow(10.0, -0.05) || f >= band.centre * std::pow(10.0, 0.05)) continue;
            band.asked += before[k];
            band.left += after[k];
        }
        strongest = std::max(strongest, band.asked);
    }
    for (const Band& band : bands) {
        if (!(band.asked > 1e-3 * strongest && band.left > 0.0)) continue;
        const double lost = 10.0 * std::log10(band.asked / band.left);
        if (lost >= 0.1) result.losses.push_back({band.centre, lost});
    }
    return result;
}

}  // namespace tactus::vibration
