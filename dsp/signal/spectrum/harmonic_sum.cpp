// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/harmonic_sum.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr int max_orders = 10;
constexpr double full_db = 30.0;         // an order so far above the noise counts fully
constexpr std::size_t max_lines = 32;   // strongest lines that candidates are made of
constexpr double neighbours = 0.03;
constexpr double min_spacing = 5.0;  // bins between orders: a line of a Hann window is four wide

/// Level of a bin of noise over the quantile that stands for it, exceeded by 1 % of bins (Wilson and Hilferty 1931).
double noise_peak_db(double segments) {
    const double part = 1.0 / (9.0 * std::max(1.0, segments));
    const double tail = std::pow(1.0 - part + 2.33 * std::sqrt(part), 3.0);
    const double low = std::pow(std::max(0.05, 1.0 - part - 0.52 * std::sqrt(part)), 3.0);
    return 10.0 * std::log10(tail / low);
}

double reach_of(double place, double fundamental, double df) {
    return std::min(0.75 * df + 0.006 * place, 0.12 * fundamental);
}

}  // namespace

HarmonicSummer::HarmonicSummer(std::size_t bins) {
    peaks_.reserve(bins / 2 + 1);
    strongest_.reserve(bins / 2 + 1);
    combs_.reserve(max_lines * max_orders);
    found_.reserve(max_lines * max_orders);
}

/// Local maxima above the noise, by frequency.
void HarmonicSummer::find_peaks(const Spectrum& spectrum, double lowest, double highest) noexcept {
    const std::vector<double>& p = spectrum.power;
    const double threshold = noise_peak_db(spectrum.effective_segments);
    peaks_.clear();
    const double ratio_at_threshold = std::pow(10.0, 0.1 * threshold) * (1.0 - 1e-9);
    const double last_bin = std::min(highest / spectrum.df, static_cast<double>(p.size()) - 2.0);
    for (auto k = static_cast<std::size_t>(std::max(2.0, lowest / spectrum.df)); static_cast<double>(k) <= last_bin;
         ++k) {
        if (!(p[k] > p[k - 1] && p[k] >= p[k + 1])) continue;
        const std::size_t from = k > around ? std::max<std::size_t>(2, k - around) : 2;
        const std::span<double> bins(noise_.data(), std::min(p.size(), k + around + 1) - from);
        // The quantile below the median: many bins around may belong to lines. Most maxima are excluded by counting
        // the bins below the level that the quantile must not exceed.
        const std::size_t rank = bins.size() * 3 / 10;
        const double most = p[k] / ratio_at_threshold;
        std::size_t below = 0;
        for (std::size_t i = from; i < from + bins.size(); ++i) below += static_cast<std::size_t>(p[i] < most);
        if (below <= rank) continue;
        std::copy_n(p.begin() + static_cast<std::ptrdiff_t>(from), bins.size(), bins.begin());
        const auto quantile = bins.begin() + static_cast<std::ptrdiff_t>(rank);
        std::nth_element(bins.begin(), quantile, bins.end());
        // Side lobes of a window are no lines: the first is 31 dB below its line.
        const double least = 3e-4 * *std::max_element(bins.begin(), bins.end());
        const double level = 10.0 * std::log10(p[k] / std::max(*quantile, least));
        if (level <= threshold) continue;
        const bool above = p[k + 1] > p[k - 1];
        const double ratio = std::sqrt((above ? p[k + 1] : p[k - 1]) / p[k]);
        const double shift = std::clamp((2.0 * ratio - 1.0) / (ratio + 1.0), 0.0, 0.5);
        peaks_.push_back({(static_cast<double>(k) + (above ? shift : -shift)) * spectrum.df,
                          std::min(1.0, (level - threshold) / (full_db - threshold)), p[k]});
    }
    // Lines far below the strongest are leakage or residue.
    double strongest = 0.0;
    for (const Peak& peak : peaks_) strongest = std::max(strongest, peak.power);
    std::erase_if(peaks_, [&](const Peak& peak) { return peak.power < 1e-6 * strongest; });
}

/// The most salient peak within `reach` Hz; none: nullptr.
const HarmonicSummer::Peak* HarmonicSummer::peak_near(double frequency, double reach) const noexcept {
    auto at = std::lower_bound(peaks_.begin(), peaks_.end(), frequency - reach,
                               [](const Peak& peak, double f) { return peak.frequency < f; });
    const Peak* best = nullptr;
    for (; at != peaks_.end() && at->frequency <= frequency + reach; ++at)
        if (!best || at->salience > best->salience) best = &*at;
    return best;
}

HarmonicSummer::Comb HarmonicSummer::comb_of(double total, double frequency, double df, double top) const noexcept {
    Comb out{frequency, 0.0, 0.0};
    for (int round = 0; round < 2; ++round) {
        const int orders = std::clamp(static_cast<int>(top / out.frequency), 1, max_orders);
        double sum = 0.0, weights = 0.0, until_last = 0.0, products = 0.0, squares = 0.0;
        for (int k = 1; k <= orders; ++k) {
            const double place = k * out.frequency, weight = 1.0 / std::sqrt(k);
            weights += weight;
            const Peak* const peak = peak_near(place, reach_of(place, out.frequency, df));
            if (!peak) continue;
            sum += weight * peak->salience;
            until_last = weights;
            products += peak->salience * k * peak->frequency;
            squares += peak->salience * k * k;
        }
        if (!(squares > 0.0)) return out;
        double explained = 0.0, chance = 0.0;
        for (const Peak& peak : peaks_) {
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

std::span<const HarmonicSum> HarmonicSummer::operator()(const Spectrum& spectrum, double lowest, double highest,
                                                        std::size_t most) noexcept {
    if (spectrum.power.size() < 8) return {};
    const double top = std::min(max_orders * highest, spectrum.df * static_cast<double>(spectrum.power.size() - 2));
    find_peaks(spectrum, std::max(0.7 * lowest, 2.0 * spectrum.df), top);
    strongest_.assign(peaks_.begin(), peaks_.end());
    std::ranges::sort(strongest_, [](const Peak& a, const Peak& b) { return a.salience > b.salience; });
    double total = 0.0, greatest = 1e-9;
    for (const Peak& peak : peaks_) total += peak.salience;
    combs_.clear();
    for (const Peak& line : std::span(strongest_).first(std::min(strongest_.size(), max_lines)))
        for (int order = 1; order <= max_orders; ++order) {
            const double f = line.frequency / order;
            if (f < lowest || f > highest || f < min_spacing * spectrum.df) continue;
            const Comb one = comb_of(total, f, spectrum.df, top);
            if (!(one.share > 0.0) || one.frequency < lowest || one.frequency > highest) continue;
            combs_.push_back(one);
            greatest = std::max(greatest, one.share);
        }
    // Multiples of the fundamental explain fewer lines than it does, submultiples have missing orders. Lines of other
    // origin lower all shares alike.
    found_.clear();
    for (const Comb& one : combs_) {
        const double relative = one.share / greatest;
        found_.push_back({one.frequency, std::min(1.0, one.filled * relative * relative * std::sqrt(one.share))});
    }
    std::ranges::sort(found_, [](const HarmonicSum& a, const HarmonicSum& b) {
        return a.score != b.score ? a.score > b.score : a.frequency > b.frequency;
    });
    std::size_t count = 0;
    for (const HarmonicSum& one : found_) {
        if (count == std::min(most, max_sums)) break;
        const std::span<const HarmonicSum> better(best_.data(), count);
        if (std::ranges::none_of(better, [&](const HarmonicSum& other) {
                return std::abs(one.frequency / other.frequency - 1.0) < neighbours;
            }))
            best_[count++] = one;
    }
    return {best_.data(), count};
}

std::vector<HarmonicSum> harmonic_sums(const Spectrum& spectrum, double lowest, double highest, std::size_t most) {
    HarmonicSummer summer(spectrum.power.size());
    const std::span<const HarmonicSum> sums = summer(spectrum, lowest, highest, most);
    return {sums.begin(), sums.end()};
}

double confidence_in(std::span<const HarmonicSum> sums) noexcept {
    if (sums.empty()) return 0.0;
    const double rival = sums.size() > 1 ? sums[1].score / std::max(sums[0].score, 1e-9) : 0.0;
    return sums[0].score * (1.0 - 0.5 * rival);
}

}  // namespace tactus::signal
