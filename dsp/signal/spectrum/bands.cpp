// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/bands.hpp"

#include "dsp/core/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus::signal {

double band_power(std::span<const double> density, double df, double low, double high) {
    if (density.empty()) return 0.0;
    const double last = static_cast<double>(density.size() - 1);
    const double from = std::clamp(low / df, -0.5, last + 0.5), to = std::clamp(high / df, -0.5, last + 0.5);
    double sum = 0.0;
    for (double bin = std::floor(from + 0.5); bin - 0.5 < to && bin <= last; ++bin) {
        const double share = std::min(to, bin + 0.5) - std::max(from, bin - 0.5);
        if (share > 0.0) sum += share * density[static_cast<std::size_t>(bin)];
    }
    return sum * df;
}

double band_power(const Spectrum& density, double low, double high) {
    return band_power(density.power, density.df, low, high);
}

namespace {

constexpr std::size_t kernel_reach = 64;  // bins

/// Power of a tone that a Hann window puts into the bins beside it, averaged over its places between two bins.
std::array<double, kernel_reach + 1> hann_kernel() {
    std::array<double, kernel_reach + 1> kernel{};
    constexpr int places = 32;
    double sum = 0.0;
    for (std::size_t d = 0; d <= kernel_reach; ++d) {
        for (int n = 0; n < places; ++n) {
            const double x = static_cast<double>(d) + (n + 0.5) / places - 0.5, below = x * (1.0 - x * x);
            const double amplitude = std::abs(below) < 1e-9 ? 0.0 : std::sin(pi * x) / (pi * below);
            kernel[d] += amplitude * amplitude / places;
        }
        sum += (d == 0 ? 1.0 : 2.0) * kernel[d];
    }
    for (double& value : kernel) value /= sum;
    return kernel;
}

}  // namespace

void estimate_leakage(std::vector<Band>& bands, const Spectrum& density) {
    static const std::array<double, kernel_reach + 1> kernel = hann_kernel();
    const std::vector<double>& power = density.power;
    if (bands.empty() || power.size() < 3) return;
    const auto reach = static_cast<std::ptrdiff_t>(kernel_reach), count = static_cast<std::ptrdiff_t>(power.size());
    std::vector<double> smeared(power.size());
    for (std::ptrdiff_t k = 0; k < count; ++k)
        for (std::ptrdiff_t d = -reach; d <= reach; ++d) {
            // The spectrum goes on at negative frequencies, with half of the one-sided power, and beyond half the rate.
            std::ptrdiff_t from = std::abs(k + d);
            if (from >= count) from = 2 * (count - 1) - from;
            if (from >= 0 && from < count)
                smeared[static_cast<std::size_t>(k)] +=
                    kernel[static_cast<std::size_t>(std::abs(d))] * power[static_cast<std::size_t>(from)];
        }
    // The power of a line within two bins of a border, below and above it: more than there is beside it.
    const auto line_at = [&](double border) {
        const double df = density.df, below = band_power(density, border - 6.0 * df, border - 2.0 * df),
                     above = band_power(density, border + 2.0 * df, border + 6.0 * df);
        const double floor = 0.5 * std::min(below, above);
        return std::pair(std::max(0.0, band_power(density, border - 2.0 * df, border) - floor),
                         std::max(0.0, band_power(density, border, border + 2.0 * df) - floor));
    };
    for (Band& band : bands) {
        const double again = band_power(smeared, density.df, band.low, band.high);
        if (!(band.power > 0.0)) continue;
        const double ratio = again / band.power, least = std::pow(10.0, -0.1 * max_leakage_db);
        // The true power by the estimate is 2 - ratio of the measured.
        const auto [outside_low, inside_low] = line_at(band.low);
        const auto [inside_high, outside_high] = line_at(band.high);
        const double lost = std::max(least, 1.0 - (inside_low + inside_high) / band.power),
                     won = 1.0 + (outside_low + outside_high) / band.power;
        for (const double possible : {std::max(least, 2.0 - ratio), lost, won})
            band.leakage_db =
                std::max(band.leakage_db, std::min(max_leakage_db, std::abs(10.0 * std::log10(possible))));
    }
}

std::vector<Band> third_octaves(const Spectrum& density) {
    std::vector<Band> bands;
    if (density.power.size() < 3) return bands;
    const double highest = density.df * static_cast<double>(density.power.size() - 1);
    const double half = std::pow(10.0, 0.05);
    for (int n = -10; n <= 60; ++n) {
        Band band;
        band.centre = std::pow(10.0, n / 10.0);
        band.low = band.centre / half;
        band.high = band.centre * half;
        if (band.high - band.low < 2.0 * density.df) continue;
        if (band.high > highest) break;
        band.power = band_power(density, band.low, band.high);
        bands.push_back(band);
    }
    return bands;
}

}  // namespace tactus::signal
