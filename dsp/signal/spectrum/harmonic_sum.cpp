// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/fundamental.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr int most_orders = 10;
constexpr double full_db = 30.0;         // an order so far above the noise counts fully
constexpr std::size_t around = 32;       // bins to each side for the noise
constexpr std::size_t most_lines = 32;   // strongest lines that candidates are made of
constexpr double neighbours = 0.03;
constexpr double least_spacing = 5.0;  // bins between orders: a line of a Hann window is four wide

struct Peak {
    double frequency, salience;  // Hz, 0 … 1
    double power;
};

/// Level of a bin of noise over the quantile that stands for it, exceeded by 1 % of bins (Wilson and Hilferty 1931).
double noise_peak_db(double segments) {
    const double part = 1.0 / (9.0 * std::max(1.0, segments));
    const double tail = std::pow(1.0 - part + 2.33 * std::sqrt(part), 3.0);
    const double low = std::pow(std::max(0.05, 1.0 - part - 0.52 * std::sqrt(part)), 3.0);
    return 10.0 * std::log10(tail / low);
}

/// Local maxima above the noise, by frequency.
std::vector<Peak> peaks_of(const Spectrum& spectrum, double lowest, double highest) {
    const std::vector<double>& p = spectrum.power;
    const double threshold = noise_peak_db(spectrum.effective_segments);
    std::vector<Peak> peaks;
    std::vector<double> bins;
    const double last_bin = std::min(highest / spectrum.df, static_cast<double>(p.size()) - 2.0);
    for (auto k = static_cast<std::size_t>(std::max(2.0, lowest / spectrum.df)); static_cast<double>(k) <= last_bin;
         ++k) {
        if (!(p[k] > p[k - 1] && p[k] >= p[k + 1])) continue;
        const std::size_t from = k > around ? std::max<std::size_t>(2, k - around) : 2;
        bins.assign(p.begin() + static_cast<std::ptrdiff_t>(from),
                    p.begin() + static_cast<std::ptrdiff_t>(std::min(p.size(), k + around + 1)));
        // The quantile below the median: many bins around may belong to lines.
        const auto quantile = bins.begin() + static_cast<std::ptrdiff_t>(bins.size() * 3 / 10);
        std::nth_element(bins.begin(), quantile, bins.end());
        // Side lobes of a window are no lines: the first is 31 dB below its line.
        const double least = 3e-4 * *std::max_element(bins.begin(), bins.end());
        const double level = 10.0 * std::log10(p[k] / std::max(*quantile, least));
        if (level <= threshold) continue;
        const bool above = p[k + 1] > p[k - 1];
        const double ratio = std::sqrt((above ? p[k + 1] : p[k - 1]) / p[k]);
        const double shift = std::clamp((2.0 * ratio - 1.0) / (ratio + 1.0), 0.0, 0.5);
        peaks.push_back({(static_cast<double>(k) + (above ? shift : -shift)) * spectrum.df,
                         std::min(1.0, (level - threshold) / (full_db - threshold)), p[k]});
    }
    // Lines far below the strongest are leakage or residue.
    double strongest = 0.0;
    for (const Peak& peak : peaks) strongest = std::max(strongest, peak.power);
    std::erase_if(peaks, [&](const Peak& peak) { return peak.power < 1e-6 * strongest; });
    return peaks;
}

/// The most salient peak within `reach` Hz; none: nullptr.
const Peak* peak_near(std::span<const Peak> peaks, double frequency, double reach) {
    auto at = std::lower_bound(peaks.begin(), peaks.end(), frequency - reach,
                               [](const Peak& peak, double f) { return peak.frequency < f; });
    const Peak* best = nullptr;
    for (; at != peaks.end() && at->frequency <= frequency + reach; ++at)
        if (!best || at->salience > best->salience) best = &*at;
    return best;
}

double reach_of(double place, double fundamental, double df) {
    return std::min(0.75 * df + 0.006 * place, 0.12 * fundamental);
}

struct Comb {
    double frequency = 0.0;
    double filled = 0.0;  ///< mean salience of the orders up to the last one there is
    double share = 0.0;   ///< of all lines that are orders, less what would be by chance
};

Comb comb_of(std::span<const Peak> peaks, double total, double frequency, double df, double top) {
    Comb out{frequency, 0.0, 0.0};
    for (int round = 0; round < 2; ++round) {
        const int orders = std::clamp(static_cast<int>(top / out.frequency), 1, most_orders);
        double sum = 0.0, weights = 0.0, until_last = 0.0, products = 0.0, squares = 0.0;
        for (int k = 1; k <= orders; ++k) {
            const double place = k * out.frequency, weight = 1.0 / std::sqrt(k);
            weights += weight;
            const Peak* const peak = peak_near(peaks, place, reach_of(place, out.frequency, df));
            if (!peak) continue;
            sum += weight * peak->salience;
            until_last = weights;
            products += peak->salience * k * peak->frequency;
            squares += peak->salience * k * k;
        }
        if (!(squares > 0.0)) return out;
        double explained = 0.0, chance = 0.0;
        for (const Peak& peak : peaks) {
            const double place = std::max(1.0, std::round(peak.frequency / out.frequency)) * out.frequency;
            const double reach = reach_of(place, out.frequency, df);
            if (std::abs(peak.frequency - place) <= reach) explained += peak.salience;
            chance += peak.salience * 2.0 * reach / out.frequency;
        }
        out.share = std::clamp((explained - chance) / std::max(total - chance, 1e-9), 0.0, 1.0);
        out.filled = sum / until_last;
        out.frequency = products / squares;
    }
    return out;
}

}  // namespace

std::vector<HarmonicSum> harmonic_sums(const Spectrum& spectrum, double lowest, double highest, std::size_t most) {
    std::vector<HarmonicSum> found, best;
    if (spectrum.power.size() < 8) return best;
    const double top = std::min(most_orders * highest, spectrum.df * static_cast<double>(spectrum.power.size() - 2));
    const std::vector<Peak> peaks = peaks_of(spectrum, std::max(0.7 * lowest, 2.0 * spectrum.df), top);
    std::vector<Peak> strongest = peaks;
    std::ranges::sort(strongest, [](const Peak& a, const Peak& b) { return a.salience > b.salience; });
    if (strongest.size() > most_lines) strongest.resize(most_lines);
    double total = 0.0, greatest = 1e-9;
    for (const Peak& peak : peaks) total += peak.salience;
    std::vector<Comb> combs;
    for (const Peak& line : strongest)
        for (int order = 1; order <= most_orders; ++order) {
            const double f = line.frequency / order;
            if (f < lowest || f > highest || f < least_spacing * spectrum.df) continue;
            const Comb one = comb_of(peaks, total, f, spectrum.df, top);
            if (!(one.share > 0.0) || one.frequency < lowest || one.frequency > highest) continue;
            combs.push_back(one);
            greatest = std::max(greatest, one.share);
        }
    // Multiples of the fundamental explain fewer lines than it does, submultiples have missing orders. Lines of other
    // origin lower all shares alike.
    for (const Comb& one : combs) {
        const double relative = one.share / greatest;
        found.push_back({one.frequency, std::min(1.0, one.filled * relative * relative * std::sqrt(one.share))});
    }
    std::ranges::sort(found, [](const HarmonicSum& a, const HarmonicSum& b) {
        return a.score != b.score ? a.score > b.score : a.frequency > b.frequency;
    });
    for (const HarmonicSum& one : found) {
        if (best.size() == most) break;
        if (std::ranges::none_of(best, [&](const HarmonicSum& other) {
                return std::abs(one.frequency / other.frequency - 1.0) < neighbours;
            }))
            best.push_back(one);
    }
    return best;
}

}  // namespace tactus::signal
