// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/bands.hpp"

#include "dsp/core/constants.hpp"

#include <algorithm>
#include <cmath>

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

double integrated_band_power(const Spectrum& density, double low, double high) {
    std::vector<double> integrated(density.power.size());
    for (std::size_t k = 1; k < integrated.size(); ++k) {
        const double omega = 2.0 * pi * density.frequency(k);
        integrated[k] = density.power[k] / (omega * omega);
    }
    return band_power(integrated, density.df, low, high);
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
