// SPDX-License-Identifier: Apache-2.0
// Rms velocity within a frequency band, from an acceleration.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Integrating a power spectrum over a band is wrong beside its lower limit: part of the lobe of a line lies outside the
/// band, and 1/ω² changes within the lobe. Each bin of a Hann section is therefore assigned to the frequency at the
/// centre of its energy (reassignment: Auger and Flandrin 1995), which is that of the line for the whole lobe. A line
/// counts fully or not at all, and is divided by its own ω². Exact for lines that are 4 bins (at most 2 Hz) or more apart.
class BandVelocity {
public:
    /// Limits in Hz, low > 0. `frames`: length of the record. Sections have the largest power of two within it and 4 s.
    BandVelocity(double low, double high, double rate, std::size_t frames);

    /// Acceleration in m/s². Allocates.
    void push(std::span<const double> samples);
    /// Marks a gap: no section spans it.
    void gap() { waiting_.clear(); }
    /// m/s, mean over the half-overlapping sections. 0 without a whole section.
    double rms() const;
    /// False if no section was complete, or if the sections are too short for the lower limit.
    bool is_resolved() const;

private:
    double low_, high_, rate_;
    std::size_t section_;
    std::vector<double> waiting_;
    double sum_ = 0.0;  // m²/s²
    std::size_t sections_ = 0;
};

}  // namespace tactus::signal
