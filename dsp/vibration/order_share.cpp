// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/order_share.hpp"

#include "dsp/signal/spectrum/welch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::vibration {

namespace {

constexpr int orders = 8;
constexpr double wander = 0.02;         // of the rate
constexpr double bins_per_order = 32.0;  // the main lobe of a line has four

}  // namespace

double order_share(std::span<const float> samples, double sample_rate, double rate) {
    if (!(rate > 0.0) || !(sample_rate > 2.0 * rate)) return 0.0;
    if (static_cast<double>(samples.size()) * rate < 16.0 * sample_rate) return 0.0;
    const auto segment = static_cast<std::size_t>(std::lround(bins_per_order * sample_rate / rate));
    const std::size_t used = std::min(segment, samples.size());
    const signal::Spectrum spectrum = signal::welch(samples, signal::WelchSettings::hann(sample_rate, used, used / 2));
    double total = 0.0, lines = 0.0;
    for (std::size_t bin = 0; bin < spectrum.power.size(); ++bin)
        if (spectrum.frequency(bin) > 0.5 * rate) total += spectrum.power[bin];
    if (!(total > 0.0)) return 0.0;
    const auto bin_of = [&](double frequency) {
        return std::min(static_cast<std::size_t>(std::lround(frequency / spectrum.df)), spectrum.power.size());
    };
    std::vector<double> between;
    for (int order = 1; order <= orders; ++order) {
        const double middle = order * rate, half = std::max(2.5 * spectrum.df, wander * middle);
        if (middle + 0.5 * rate > 0.5 * sample_rate) break;
        const std::size_t low = bin_of(middle - half), high = bin_of(middle + half) + 1;
        between.clear();
        double inside = 0.0;
        for (std::size_t bin = bin_of(middle - 0.5 * rate); bin < bin_of(middle + 0.5 * rate); ++bin) {
            if (bin >= low && bin < high) inside += spectrum.power[bin];
            else between.push_back(spectrum.power[bin]);
        }
        double noise = 0.0;
        if (!between.empty()) {
            const auto half_way = between.begin() + static_cast<std::ptrdiff_t>(between.size() / 2);
            std::nth_element(between.begin(), half_way, between.end());
            noise = *half_way * static_cast<double>(high - low);
        }
        lines += std::max(0.0, inside - noise);
    }
    return std::min(1.0, lines / total);
}

}  // namespace tactus::vibration
