// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/alignment.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tactus::signal {

namespace {

using Complex = std::complex<double>;

constexpr double floor_ratio = 1e-6;       // −60 dB
constexpr double search = 5e-3;            // s around the whitened peak
constexpr double longest_cycle = 0.05;     // s, of a machine: strokes repeat themselves less often
constexpr double chance = 1e-3;
// A Hann window correlates neighbouring bins: the effective number of bins is lower.
constexpr double hann_independence = 1.0 / 1.5;

/// Half-cosine fades at both ends: spectral leakage of the ends would correlate between any two records.
std::vector<double> windowed(std::span<const double> samples, std::size_t count) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i)
        out[i] =
            samples[i] * (0.5 - 0.5 * std::cos(2.0 * pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count)));
    return out;
}

/// Value at a lag in samples; negative lags are stored at the end.
double at(const std::vector<double>& circle, std::ptrdiff_t lag) {
    const auto size = static_cast<std::ptrdiff_t>(circle.size());
    return circle[static_cast<std::size_t>((lag % size + size) % size)];
}

/// Lag of the largest magnitude in [from, to].
std::ptrdiff_t peak_of(const std::vector<double>& circle, std::ptrdiff_t from, std::ptrdiff_t to) {
    std::ptrdiff_t best = from;
    for (std::ptrdiff_t lag = from; lag <= to; ++lag)
        if (std::abs(at(circle, lag)) > std::abs(at(circle, best))) best = lag;
    return best;
}

constexpr double min_overlap = 1.0;  // s, and a quarter of the shorter record

/// Odds and lags of one search for a delay.
struct DelaySearch {
    double rate, lowest, highest;  // Hz
    std::ptrdiff_t reach;          // samples to both sides
    double tests = 1.0;            // number of such searches; 0: the peak counts whatever its height
};

/// The delay of `output`, of which as many samples as both have are used. `period` gets the distance in samples to the
/// highest other peak of at least half the height, by which strokes repeat themselves; 0: none, or those of a machine.
Alignment delay_between(std::span<const double> reference, std::span<const double> output, const DelaySearch& wanted,
                        std::ptrdiff_t* period = nullptr) {
    const double rate = wanted.rate, lowest = wanted.lowest, highest = wanted.highest;
    const std::size_t common = std::min(reference.size(), output.size());
    const std::ptrdiff_t reach = wanted.reach;
    Alignment found;
    if (common < 64 || reach < 1) return found;
    const std::size_t size = std::bit_ceil(common + static_cast<std::size_t>(reach) + 1);
    const double step = rate / static_cast<double>(size);
    const auto first = static_cast<std::size_t>(std::ceil(lowest / step));
    const auto end = std::min(size / 2, static_cast<std::size_t>(std::floor(highest / step))) + 1;
    if (first >= end) return found;

    std::vector<Complex> a = spectrum_of(windowed(reference, common), size);
    const std::vector<Complex> b = spectrum_of(windowed(output, common), size);
    double strongest_a = 0.0, strongest_b = 0.0, power_a = 0.0, power_b = 0.0;
    for (std::size_t k = first; k < end; ++k) {
        strongest_a = std::max(strongest_a, std::norm(a[k]));
        strongest_b = std::max(strongest_b, std::norm(b[k]));
        power_a += std::norm(a[k]);
        power_b += std::norm(b[k]);
    }
    if (!(power_a > 0.0 && power_b > 0.0)) return found;
    std::vector<Complex> white(a.size()), plain(a.size());
    double kept = 0.0;
    for (std::size_t k = first; k < end; ++k) {
        plain[k] = std::conj(a[k]) * b[k];
        if (std::norm(a[k]) < floor_ratio * strongest_a || std::norm(b[k]) < floor_ratio * strongest_b) continue;
        white[k] = plain[k] / std::abs(plain[k]);
        kept += 1.0;
    }
    // The kept bins are those of the padded transform; the degrees of freedom are those of the unpadded record.
    kept *= static_cast<double>(common) / static_cast<double>(size);
    if (kept < 2.0) return found;
    const std::vector<double> whitened = samples_of(white);
    const std::ptrdiff_t coarse = peak_of(whitened, -reach, reach);
    // Mean of cos over random phases: variance 1/2 per independent value. The transform's sum counts each bin twice.
    const double bins = kept * static_cast<double>(size) / static_cast<double>(common);
    const double height = std::abs(at(whitened, coarse)) * static_cast<double>(size) / (2.0 * bins);
    found.significance = height * std::sqrt(2.0 * kept * hann_independence);
    // Correlation peaks of a band are about 1/(2 × bandwidth) apart.
    const double trials = std::max(1.0, 4.0 * static_cast<double>(reach) / rate * (highest - lowest)) * wanted.tests;
    found.significant = wanted.tests == 0.0 || found.significance > std::sqrt(2.0 * std::log(2.0 * trials / chance));
    if (!found.significant) return found;

    const auto near = static_cast<std::ptrdiff_t>(std::ceil(search * rate));
    if (period) {
        // The higher of the peaks from `from` to `to` samples to both sides of the coarse one; its distance.
        const auto beside = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
            const auto clamped = [&](std::ptrdiff_t lag) { return std::clamp(lag, -reach, reach); };
            const std::ptrdiff_t left = peak_of(whitened, clamped(coarse - to), clamped(coarse - from)),
                                 right = peak_of(whitened, clamped(coarse + from), clamped(coarse + to));
            const std::ptrdiff_t other = std::abs(at(whitened, left)) > std::abs(at(whitened, right)) ? left : right;
            return std::abs(at(whitened, other)) < 0.5 * std::abs(at(whitened, coarse)) ? 0 : std::abs(other - coarse);
        };
        const auto slow = static_cast<std::ptrdiff_t>(std::ceil(longest_cycle * rate));
        *period = beside(near, slow) > 0 ? 0 : beside(slow, 2 * reach);
    }
    const std::vector<double> correlation = samples_of(plain);
    const std::ptrdiff_t lag = peak_of(correlation, std::max(coarse - near, -reach), std::min(coarse + near, reach));
    const double left = at(correlation, lag - 1), middle = at(correlation, lag), right = at(correlation, lag + 1);
    const double bend = left - 2.0 * middle + right;
    const double shift = bend != 0.0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0.0;
    found.delay = (static_cast<double>(lag) + shift) / rate;
    const double peak = middle - 0.25 * (left - right) * shift;
    found.correlation = std::clamp(peak * static_cast<double>(size) / (2.0 * std::sqrt(power_a * power_b)), -1.0, 1.0);
    return found;
}

/// Blocks of the output in windows of the reference of twice their length: finds an excerpt wherever it is, and records
/// that have a quarter in common. The delay is that of the most significant block.
Alignment delay_of_blocks(std::span<const double> reference, std::span<const double> output, DelaySearch wanted,
                          double longest) {
    const std::size_t shorter = std::min(reference.size(), output.size());
    const auto least = static_cast<std::size_t>(min_overlap * wanted.rate);
    if (shorter < least) return {};
    const std::size_t block = std::max(least, shorter / 4);
    wanted.reach = static_cast<std::ptrdiff_t>(block);
    const std::size_t windows = reference.size() / block, blocks = output.size() / block;
    wanted.tests = static_cast<double>(windows * blocks);
    Alignment best;
    std::vector<double> padded(2 * block);
    for (std::size_t i = 0; i < blocks; ++i) {
        // The block in the middle, so that it lies within the window at any delay between two windows.
        std::ranges::fill(padded, 0.0);
        // Faded: the leakage of lines that are cut would correlate with that of any other record.
        std::ranges::copy(windowed(output.subspan(i * block, block), block),
                          padded.begin() + static_cast<std::ptrdiff_t>(block / 2));
        for (std::size_t j = 0; j < windows; ++j) {
            const std::size_t from = std::min(j * block, reference.size() - std::min(reference.size(), 2 * block));
            if (from + 2 * block > reference.size()) continue;
            Alignment found = delay_between(reference.subspan(from, 2 * block), padded, wanted);
            found.delay +=
                (static_cast<double>(i * block) - static_cast<double>(block / 2) - static_cast<double>(from)) /
                wanted.rate;
            if (found.significant && std::abs(found.delay) <= longest && found.significance > best.significance)
                best = found;
        }
    }
    return best;
}

/// The alignment at a delay of about `lag` samples, by what both records have in common there; not significant if that is
/// too short.
Alignment aligned_at(std::span<const double> reference, std::span<const double> output, std::ptrdiff_t lag,
                     DelaySearch wanted) {
    const auto from_reference = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, -lag)),
               from_output = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, lag));
    if (from_reference >= reference.size() || from_output >= output.size()) return {};
    const double shorter = static_cast<double>(std::min(reference.size(), output.size()));
    const std::span<const double> r = reference.subspan(from_reference), d = output.subspan(from_output);
    const std::size_t overlap = std::min(r.size(), d.size());
    if (static_cast<double>(overlap) < std::min(shorter, std::max(min_overlap * wanted.rate, 0.25 * shorter)))
        return {};
    wanted.reach = static_cast<std::ptrdiff_t>(std::ceil(search * wanted.rate));
    wanted.tests = 0.0;
    Alignment fine = delay_between(r.first(overlap), d.first(overlap), wanted);
    fine.delay += static_cast<double>(lag) / wanted.rate;
    return fine;
}

}  // namespace

Alignment align_takes(std::span<const double> reference, std::span<const double> output, double rate, double lowest,
                      double highest, double longest) {
    constexpr std::ptrdiff_t max_periods = 16;
    const double shorter = static_cast<double>(std::min(reference.size(), output.size()));
    DelaySearch wanted{rate, lowest, highest,
                       static_cast<std::ptrdiff_t>(std::min(std::round(longest * rate), 0.5 * shorter))};
    std::ptrdiff_t period = 0;
    Alignment found = delay_between(reference, output, wanted, &period);
    if (!found.significant) found = delay_of_blocks(reference, output, wanted, longest);
    if (!found.significant) found = delay_of_blocks(output, reference, wanted, longest), found.delay = -found.delay;
    if (!found.significant) return found;
    // Again on what both have in common, by which the correlation is normalised. Of what repeats itself, with strokes of
    // its own, the delay with the best correlation counts, not the one at which both fades meet.
    const auto first = static_cast<std::ptrdiff_t>(std::llround(found.delay * rate));
    const Alignment fine = aligned_at(reference, output, first, wanted);
    if (!fine.significant) return {};
    found.delay = fine.delay;
    found.correlation = fine.correlation;
    // Both fades hide what differs at the ends: what a correlation lacks counts. The nearest of equal ones has the longest
    // overlap.
    const auto missing = [](const Alignment& one) { return std::max(1e-9, 1.0 - std::abs(one.correlation)); };
    for (std::ptrdiff_t k = 1; k <= max_periods && period > 0; ++k)
        for (const std::ptrdiff_t lag : {first - k * period, first + k * period}) {
            if (std::abs(lag) > wanted.reach) continue;
            const Alignment other = aligned_at(reference, output, lag, wanted);
            if (!other.significant || !(missing(other) < 0.9 * missing(found))) continue;
            found.delay = other.delay;
            found.correlation = other.correlation;
        }
    return found;
}

std::size_t stretch_of_loop(std::span<const double> loop, std::span<const double> part, double rate, double lowest,
                            double highest) {
    const std::size_t size = loop.size() / 2 * 2;
    if (size < 2 || part.empty()) return 0;
    const std::vector<Complex> a = spectrum_of(loop.first(size), size),
                               b = spectrum_of(part.first(std::min(part.size(), size)), size);
    std::vector<Complex> product(a.size());
    for (std::size_t k = 1; k < a.size(); ++k) {
        const double f = rate * static_cast<double>(k) / static_cast<double>(size);
        if (f < lowest || f > highest) continue;
        const Complex both = a[k] * std::conj(b[k]);
        if (std::abs(both) > 0.0) product[k] = both / std::sqrt(std::abs(both));
    }
    const std::vector<double> correlation = samples_of(product);
    const auto alike = [](double x, double y) { return std::abs(x) < std::abs(y); };
    return static_cast<std::size_t>(std::max_element(correlation.begin(), correlation.end(), alike) -
                                    correlation.begin());
}

}  // namespace tactus::signal
