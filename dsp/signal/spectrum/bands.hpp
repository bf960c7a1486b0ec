// SPDX-License-Identifier: Apache-2.0
// Fractional-octave bands of a power spectrum.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

namespace tactus::signal {

struct Band {
    double centre = 0.0, low = 0.0, high = 0.0;  ///< Hz
    double power = 0.0;                          ///< mean square in the band, unit²
    double leakage_db = 0.0;  ///< by how much the window may have raised or lowered the level; at most max_leakage_db
};
inline constexpr double max_leakage_db = 60.0;

/// One-third octaves with exact centres 10^(n/10) Hz (IEC 61260-1), from a density spectrum: bins are weighted by the
/// fraction of their width inside the band. Omits bands narrower than two bins or beyond the spectrum.
std::vector<Band> third_octaves(const Spectrum& density);

/// Sets the leakage of the bands of a spectrum by Hann windows. The measured spectrum is the true one smeared by the window; what smearing
/// it once more changes in a band estimates what the first time did ("twicing", Tukey 1977). A line within two bins of a border may lie on
/// either side of it: its power counts as leakage, too. Allocates.
void estimate_leakage(std::vector<Band>& bands, const Spectrum& density);

/// Mean square between two frequencies (Hz) of a density with bin k at k × `df` Hz; a bin on a border is weighted by
/// its fraction.
double band_power(std::span<const double> density, double df, double low, double high);
double band_power(const Spectrum& density, double low, double high);

}  // namespace tactus::signal
