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
    std::vector<double> sizes;
    for (std::size_t k = begin; k < end; ++k) sizes.push_back(std::abs(cepstrum.value[k]));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    const double threshold = 5.0 * 1.4826 * *middle;
    for (std::size_t k = begin; k < end; ++k) {
        const double value = cepstrum.value[k];
        if (value > threshold && value >= cepstrum.value[k - 1] && value > cepstrum.value[k + 1])
            peaks.push_back({cepstrum.quefrency(k), value});
    }
    // A family has peaks at all multiples of its quefrency; the first of them states its spacing.
    const std::vector<CepstralPeak> all = peaks;
    std::erase_if(peaks, [&](const CepstralPeak& peak) {
        return std::ranges::any_of(all, [&](const CepstralPeak& first) {
            const double multiple = std::round(peak.quefrency / first.quefrency);
            return multiple >= 2.0 && first.value > 0.5 * peak.value &&
                   std::abs(peak.quefrency - multiple * first.quefrency) <= multiple * cepstrum.step;
        });
    });
    std::ranges::stable_sort(peaks, std::greater<>(), &CepstralPeak::value);
    if (peaks.size() > count) peaks.resize(count);
    return peaks;
}

}  // namespace tactus::signal
