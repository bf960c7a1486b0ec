// SPDX-License-Identifier: Apache-2.0
// Octave and third-octave filters of IEC 61260-1:2014, class 1, base ten.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Butterworth band-pass of sixth order (three sections), −3 dB at both edges, gain 1 at their geometric mean after the
/// bilinear transform. Meets the limits of class 1 up to an upper edge of `highest_edge` times the rate; nearer to half
/// the rate the bilinear transform makes its lower side too flat.
class OctaveFilter {
public:
    static constexpr double highest_edge = 0.24;

    /// Edges and rate in Hz. Throws Error unless 0 < low < high < rate / 2.
    OctaveFilter(double low, double high, double rate);
    double operator()(double x) noexcept { return sections_[2](sections_[1](sections_[0](x))); }
    std::complex<double> response(double frequency) const;
    void reset() noexcept;

private:
    double rate_;
    std::array<Biquad, 3> sections_;
};

struct FilteredBand {
    double centre = 0.0, low = 0.0, high = 0.0;  ///< Hz, exact
    double power = 0.0;  ///< mean square, unit²
    double deviation_db = 0.0;  ///< standard deviation of the level, of noise
};

/// Filters a record into bands of one octave or a third, and averages the squares over the whole record. Bands begin at
/// 1 Hz, or where bandwidth times duration is at least 4, and end at `OctaveFilter::highest_edge`.
class OctaveBank {
public:
    /// `per_octave`: 1 or 3. Allocates. Throws Error for a rate that is not above 0.
    OctaveBank(int per_octave, double rate, std::size_t frames);
    void push(std::span<const double> samples);
    /// Call before a gap, so that no filter state carries over.
    void gap();
    std::vector<FilteredBand> bands() const;

private:
    struct Lane {
        FilteredBand band;
        OctaveFilter filter;
    };
    std::vector<Lane> lanes_;
    std::size_t count_ = 0;
    double rate_;
};

}  // namespace tactus::signal
