// SPDX-License-Identifier: Apache-2.0
// Spectral lines: frequency between the bins, power, and significance above noise.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::signal {

struct SpectralLine {
    double frequency = 0.0;  ///< Hz
    double power = 0.0;      ///< mean square, unit²: half the squared amplitude
    double snr_db = 0.0;  ///< peak over the median of the bins 4 to 16 away on both sides
};

/// All of these take a Hann spectrum (density scaling): the ratio of two neighbouring bins of a Hann window gives the
/// exact frequency of a steady tone between them (Grandke 1983).

/// The line with its peak at bin `k`, which must not be an end of the spectrum.
SpectralLine line_at(const Spectrum& spectrum, std::size_t k);

/// The strongest line within `reach` Hz of `frequency`; the peak may be at an end of that range. Power 0 when the range
/// is outside the spectrum.
SpectralLine line_near(const Spectrum& spectrum, double frequency, double reach);

/// SNR (dB) that a bin of noise exceeds with probability 1e-6: 10 dB for long records, more for few segments.
double detection_threshold_db(const Spectrum& spectrum);

/// Whether bin `k` is a local maximum.
bool is_top(const Spectrum& spectrum, std::size_t k) noexcept;

/// Calls use(SpectralLine) for each result of `find_lines`; does not allocate.
template <class Use>
void each_line(const Spectrum& spectrum, double lowest, double highest, double snr_db, const Use& use) {
    const double threshold = std::max(snr_db, detection_threshold_db(spectrum));
    for (std::size_t k = 2; k + 1 < spectrum.power.size(); ++k) {
        const double frequency = spectrum.frequency(k);
        if (frequency < lowest || frequency > highest || !is_top(spectrum, k)) continue;
        const SpectralLine line = line_at(spectrum, k);
        if (line.snr_db >= threshold) use(line);
    }
}

/// Peaks above `detection_threshold_db` (or `snr_db` if higher) between `lowest` and `highest` Hz, in order of
/// frequency.
std::vector<SpectralLine> find_lines(const Spectrum& spectrum, double lowest, double highest, double snr_db = 10.0);

struct Harmonic : SpectralLine {
    int order = 1;
    bool present = false;  ///< SNR of at least 6 dB and within 1.5 bins of order × fundamental
};

/// Orders 1 … `orders` of `fundamental`, up to the end of the spectrum.
std::vector<Harmonic> harmonic_table(const Spectrum& spectrum, double fundamental, int orders);

/// Total harmonic distortion: rms of the present orders from 2 on over that of order 1 (IEC 61000-4-7, THD of the
/// fundamental). None without a present first order.
std::optional<double> total_harmonic_distortion(std::span<const Harmonic> table);

struct HumLine : SpectralLine {
    int mains = 50;  ///< 50 or 60 Hz
    int order = 1;
};

/// Mains hum: narrow lines that `fit_mains` finds to be orders of one frequency, and no orders of `fundamental` (0:
/// unknown) unless that is the mains frequency itself.
std::vector<HumLine> find_hum(const Spectrum& spectrum, double fundamental);

}  // namespace tactus::signal
