// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/lines.hpp"

#include "dsp/signal/spectrum/decibels.hpp"
#include "dsp/signal/spectrum/mains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::signal {

namespace {

/// Median of the bins 4 … 16 away from `k`, on both sides.
double floor_around(const Spectrum& spectrum, std::size_t k) {
    std::array<double, 26> bins;
    std::size_t count = 0;
    for (std::size_t away = 4; away <= 16; ++away) {
        if (k >= away + 1) bins[count++] = spectrum.power[k - away];
        if (k + away < spectrum.power.size()) bins[count++] = spectrum.power[k + away];
    }
    if (count == 0) return 0.0;
    const auto middle = bins.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(bins.begin(), middle, bins.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
}

constexpr double line_error = 0.1;  // bins: deviation of the frequency of a line at the threshold

double snr_of(const Spectrum& spectrum, std::size_t k) {
    const double floor = floor_around(spectrum, k);
    if (!(spectrum.power[k] > 0.0)) return 0.0;
    return std::min(200.0, decibels(spectrum.power[k] / std::max(floor, 1e-20 * spectrum.power[k])));
}

}  // namespace

bool is_top(const Spectrum& spectrum, std::size_t k) noexcept {
    const std::vector<double>& p = spectrum.power;
    return k >= 1 && k + 1 < p.size() && p[k] > p[k - 1] && p[k] >= p[k + 1];
}

SpectralLine line_at(const Spectrum& spectrum, std::size_t k) {
    const std::vector<double>& p = spectrum.power;
    SpectralLine line{spectrum.frequency(k), p[k] * spectrum.noise_bandwidth, snr_of(spectrum, k)};
    if (!is_top(spectrum, k)) return line;
    const bool above = p[k + 1] > p[k - 1];
    const double ratio = std::sqrt((above ? p[k + 1] : p[k - 1]) / p[k]);
    const double shift = std::clamp((2.0 * ratio - 1.0) / (ratio + 1.0), 0.0, 0.5);
    line.frequency += (above ? shift : -shift) * spectrum.df;
    if (shift > 1e-9) {
        const double angle = std::numbers::pi * shift;
        const double loss = std::sin(angle) / (angle * (1.0 - shift * shift));
        line.power /= loss * loss;
        line.snr_db -= decibels(loss * loss);
    }
    return line;
}

SpectralLine line_near(const Spectrum& spectrum, double frequency, double reach) {
    if (spectrum.power.size() < 3) return {frequency, 0.0, 0.0};
    const double last = static_cast<double>(spectrum.power.size() - 2);
    const double low = std::ceil((frequency - reach) / spectrum.df),
                 high = std::floor((frequency + reach) / spectrum.df);
    if (!(low <= last) || !(high >= 1.0)) return {frequency, 0.0, 0.0};
    auto k = static_cast<std::size_t>(std::clamp(low, 1.0, last));
    const auto end = static_cast<std::size_t>(std::clamp(std::max(low, high), 1.0, last));
    std::size_t best = k;
    for (; k <= end; ++k)
        if (spectrum.power[k] > spectrum.power[best]) best = k;
    return line_at(spectrum, best);
}

double detection_threshold_db(const Spectrum& spectrum) {
    // Quantile 1 − 10⁻⁶ of the mean of K exponential powers over their median (Wilson and Hilferty 1931).
    const double part = 1.0 / (9.0 * std::max(1.0, spectrum.effective_segments));
    const double tail = std::pow(1.0 - part + 4.75 * std::sqrt(part), 3.0), median = std::pow(1.0 - part, 3.0);
    // Scalloping: a line between two bins is up to 1.42 dB stronger than its stronger bin.
    return std::max(10.0, decibels(tail / median) + 1.42);
}

std::vector<SpectralLine> find_lines(const Spectrum& spectrum, double lowest, double highest, double snr_db) {
    std::vector<SpectralLine> lines;
    each_line(spectrum, lowest, highest, snr_db, [&](const SpectralLine& line) { lines.push_back(line); });
    return lines;
}

std::vector<Harmonic> harmonic_table(const Spectrum& spectrum, double fundamental, int orders) {
    std::vector<Harmonic> table;
    const double highest = spectrum.df * static_cast<double>(spectrum.power.size() - 2);
    for (int order = 1; order <= orders && fundamental > 0.0 && order * fundamental < highest; ++order) {
        const double place = order * fundamental;
        // A varying rate shifts the high orders most.
        const double reach = std::min(1.5 * spectrum.df + 0.005 * place, 0.4 * fundamental);
        Harmonic harmonic;
        static_cast<SpectralLine&>(harmonic) = line_near(spectrum, place, reach);
        harmonic.order = order;
        harmonic.present = harmonic.snr_db >= 6.0 && std::abs(harmonic.frequency - place) <= reach;
        table.push_back(harmonic);
    }
    return table;
}

std::optional<double> total_harmonic_distortion(std::span<const Harmonic> table) {
    if (table.empty() || !table.front().present || table.front().order != 1) return std::nullopt;
    double higher = 0.0;
    for (const Harmonic& harmonic : table.subspan(1))
        if (harmonic.present) higher += harmonic.power;
    return std::sqrt(higher / table.front().power);
}

std::vector<HumLine> find_hum(const Spectrum& spectrum, double fundamental) {
    std::vector<HumLine> found;
    if (spectrum.power.size() < 16) return found;
    const double threshold = detection_threshold_db(spectrum);
    const bool is_mains =
        std::ranges::any_of(mains_frequencies, [&](int nominal) { return mains_order(fundamental, nominal) == 1; });
    const auto is_order = [&](double hz) {
        if (!(fundamental > 0.0) || is_mains) return false;
        const double nearest = std::max(1.0, std::round(hz / fundamental)) * fundamental;
        return std::abs(hz - nearest) <= 1.5 * spectrum.noise_bandwidth + 0.003 * hz;
    };
    // A narrow line within half a bin and a fraction of `place`.
    const auto line_at_place = [&](double place, double range) -> std::optional<SpectralLine> {
        if (place > spectrum.frequency(spectrum.power.size() - 6) || place < 5.0 * spectrum.df) return std::nullopt;
        const double reach = 0.5 * spectrum.df + range * place;
        const SpectralLine line = line_near(spectrum, place, std::max(2.0 * spectrum.df, reach));
        const auto top = static_cast<std::size_t>(std::lround(line.frequency / spectrum.df));
        if (top < 3 || top + 3 >= spectrum.power.size()) return std::nullopt;
        // A steady line is as narrow as the window's main lobe; noise or a varying rate is wider.
        const double skirt = std::max(spectrum.power[top - 3], spectrum.power[top + 3]);
        const bool is_hum = line.snr_db >= threshold && spectrum.power[top] > 4.0 * skirt &&
                            std::abs(line.frequency - place) <= reach && !is_order(line.frequency);
        return is_hum ? std::optional(line) : std::nullopt;
    };
    for (const int nominal : mains_frequencies) {
        std::vector<MainsLine> lines;
        for (int order = 1; order <= max_mains_order; ++order)
            if (const auto line = line_at_place(order * nominal, mains_range))
                lines.push_back({line->frequency, line_error * spectrum.df, line->power});
        const std::optional<MainsComb> mains = fit_mains(lines, nominal);
        if (!mains) continue;
        for (int order = 1; order <= max_mains_order; ++order) {
            const auto line = line_at_place(order * mains->frequency, mains_drift);
            // 300 and 600 Hz belong to both families: the second one skips them.
            if (line && mains->order_of(line->frequency, line_error * spectrum.df) == order &&
                std::ranges::none_of(
                    found, [&](const HumLine& other) { return other.mains * other.order == nominal * order; }))
                found.push_back({*line, nominal, order});
        }
    }
    return found;
}

}  // namespace tactus::signal
