// SPDX-License-Identifier: Apache-2.0
// Rms velocity within a frequency band, from an acceleration.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Integrating a power spectrum over a band is wrong beside its lower limit: part of the lobe of a line lies outside
/// the band, and 1/ω² changes within the lobe. Each bin of a section is therefore assigned to the frequency at the
/// centre of its energy (reassignment: Auger and Flandrin 1995), which is that of the line for the whole lobe. A line
/// counts fully or not at all, and is divided by its own ω². Exact for lines that are 4 bins (at most 5 Hz for a limit
/// of 10 Hz) or more apart; the band is 0.5 % wider than its limits, so that a line at a limit counts.
///
/// Sections of 8 to 16 periods of the lower limit overlap by 75 %, where the squares of Hann windows add up to a
/// constant. The windows of the first and the last section of a piece fill this sum up to 2 periods from its ends.
/// Every sample counts equally except in those, so an event has its energy wherever it is.
class BandVelocity {
public:
    /// Limits and sample rate in Hz, low > 0.
    BandVelocity(double low, double high, double rate);

    /// Acceleration in m/s², continuing the piece. Allocates.
    void push(std::span<const double> samples);
    /// Ends a piece: at a gap, which no section spans, and at the end of the record. Pieces below 4 periods of the
    /// lower limit (`min_piece`) are too short and do not count.
    void end_piece();
    /// m/s, of the pieces that ended; 0 without any.
    double rms() const;
    /// Fraction of the samples of the pieces that ended which the windows cover.
    double coverage() const;
    /// False if no piece was long enough.
    bool is_resolved() const { return weight_ > 0.0; }
    /// s
    double min_piece() const { return min_periods / low_; }

private:
    static constexpr double min_periods = 4.0, taper_periods = 2.0;

    void add_inner(std::span<const double> samples);
    void add_windowed(std::span<const double> samples, std::span<const double> window);
    void taper(std::span<double> window, bool at_start, bool at_end) const;
    std::vector<double> rest_from(std::size_t first, std::size_t size) const;

    double low_, high_, rate_;
    std::size_t section_;
    std::vector<double> squares_;  // of a Hann window
    std::vector<double> waiting_;  // from the start of the last section on
    bool has_section_ = false;  // of this piece
    double sum_ = 0.0;  // m²/s², windowed
    double weight_ = 0.0;  // sum of the squares of all windows
    double pending_ = 0.0, samples_ = 0.0;  // of this piece; of those that ended
};

}  // namespace tactus::signal
