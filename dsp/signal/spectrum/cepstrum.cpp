// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/cepstrum.hpp"

#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace tactus::signal {

Cepstrum real_cepstrum(const Spectrum& spectrum) {
    Cepstrum out;
    const std::size_t bins = spectrum.power.size();
    const double strongest = bins > 0 ? std::ranges::max(spectrum.power) : 0.0;
    if (bins < 3 || !(strongest > 0.0)) return out;
    std::vector<std::complex<double>> logarithm;
    for (const double power : spectrum.power) logarithm.emplace_back(std::log(std::max(power, 1e-20 * strongest)));
    out.value = samples_of(logarithm);
    out.step = 1.0 / (spectrum.df * static_cast<double>(out.value.size()));
    out.value.resize(bins);
    return out;
}

std::vector<CepstralPeak> cepstral_peaks(const Cepstrum& cepstrum, std::size_t count) {
    std::vector<CepstralPeak> peaks;
    const std::size_t begin = 8, end = cepstrum.value.size() / 2;
    if (end < begin + 16) return peaks;
    constexpr int reach = 6;
    const auto squared_envelope = [&](std::size_t k) {
        double sum = 0.0;
        for (int i = 1 - reach; i < reach; ++i) {
            const double value = cepstrum.value[static_cast<std::size_t>(static_cast<int>(k) + i)];
            sum += (reach - std::abs(i)) * value * value;
        }
        return sum / reach;  // of one peak alone: its square
    };
    std::vector<double> squared(end + 1, 0.0);
    for (std::size_t k = begin - 1; k <= end; ++k) squared[k] = squared_envelope(k);
    std::vector<double> sorted(squared.begin() + begin, squared.begin() + static_cast<std::ptrdiff_t>(end));
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double threshold = 6.25 * *middle;
    for (std::size_t k = begin; k < end; ++k) {
        const double before = squared[k - 1], at = squared[k], after = squared[k + 1];
        if (!(at > threshold && at >= before && at > after)) continue;
        const double shift = 0.5 * (before - after) / (before - 2.0 * at + after);
        peaks.push_back({(static_cast<double>(k) + shift) * cepstrum.step, std::sqrt(at)});
    }
    // A family has peaks at all multiples of its quefrency; the first of them states its spacing.
    const std::vector<CepstralPeak> all = peaks;
    std::erase_if(peaks, [&](const CepstralPeak& peak) {
        return std::ranges::any_of(all, [&](const CepstralPeak& first) {
            const double multiple = std::round(peak.quefrency / first.quefrency);
            return multiple >= 2.0 && first.value > 0.5 * peak.value &&
                   std::abs(peak.quefrency - multiple * first.quefrency) <= 1.5 * multiple * cepstrum.step;
        });
    });
    std::ranges::stable_sort(peaks, std::greater<>(), &CepstralPeak::value);
    if (peaks.size() > count) peaks.resize(count);
    return peaks;
}

}  // namespace tactus::signal
