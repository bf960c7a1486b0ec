// SPDX-License-Identifier: Apache-2.0
// Fractional-octave bands out of a power spectrum.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

namespace tactus::signal {

struct Band {
    double centre = 0.0, low = 0.0, high = 0.0;  ///< Hz
    double power = 0.0;                          ///< mean square in the band, unit²
};

/// One-third octaves with exact centres 10^(n/10) Hz (IEC 61260-1), from a density spectrum: bins count by the share of
/// their width inside the band. Bands narrower than two bins or reaching beyond the spectrum are left out.
std::vector<Band> third_octaves(const Spectrum& density);

/// Mean square between two frequencies (Hz) of a density with bin k at k × `df` Hz; a bin that straddles a border counts by
/// its share.
double band_power(std::span<const double> density, double df, double low, double high);
double band_power(const Spectrum& density, double low, double high);

}  // namespace tactus::signal
