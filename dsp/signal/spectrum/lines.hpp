// SPDX-License-Identifier: Apache-2.0
// Lines in a spectrum: where each lies between the bins, how strong it is, and how sure that it is no noise.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tactus::signal {

struct SpectralLine {
    double frequency = 0.0;  ///< Hz
    double power = 0.0;      ///< mean square, unit²: half the squared amplitude
    double snr_db = 0.0;     ///< its top over the median of the bins 4 to 16 away on both sides
};

/// All of these take a Hann spectrum (density scaling): the ratio of two neighbouring bins of a Hann window tells exactly
/// where between them a steady tone lies (Grandke 1983).

/// The line whose top is at bin `k`. `k` must be no end of the spectrum.
SpectralLine line_at(const Spectrum& spectrum, std::size_t k);

/// The strongest line within `reach` Hz of `frequency`; the top may be an end of that range. Power 0 when the range
/// lies outside the spectrum.
SpectralLine line_near(const Spectrum& spectrum, double frequency, double reach);

/// SNR (dB) that a bin of noise passes once in a million: 10 dB for long records, more for few segments.
double detection_threshold_db(const Spectrum& spectrum);

/// Whether bin `k` stands above its neighbours.
bool is_top(const Spectrum& spectrum, std::size_t k) noexcept;

/// Calls use(SpectralLine) for what `find_lines` finds; allocates nothing.
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

/// Tops that pass `detection_threshold_db` (or `snr_db` where that is more) between `lowest` and `highest` Hz, in order
/// of frequency.
std::vector<SpectralLine> find_lines(const Spectrum& spectrum, double lowest, double highest, double snr_db = 10.0);

struct Harmonic : SpectralLine {
    int order = 1;
    bool present = false;  ///< SNR of at least 6 dB and a place within a bin and a half of order × fundamental
};

/// Orders 1 … `orders` of `fundamental`, as far as the spectrum goes.
std::vector<Harmonic> harmonic_table(const Spectrum& spectrum, double fundamental, int orders);

struct HumLine : SpectralLine {
    int mains = 50;  ///< 50 or 60 Hz
    int order = 1;
};

/// Lines of the mains: at m·50 or m·60 Hz (m = 1 … 10) within half a bin and 0.2 % of it, narrow, and no order of `fundamental`
/// (0: none known) unless that is itself the mains. A family counts only with one of its first three.
std::vector<HumLine> find_hum(const Spectrum& spectrum, double fundamental);

}  // namespace tactus::signal
