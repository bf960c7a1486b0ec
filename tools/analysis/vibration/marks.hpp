// SPDX-License-Identifier: Apache-2.0
// Marked frequencies, such as those of a bearing or of teeth, and the levels of a spectrum at them.
#pragma once

#include "dsp/signal/spectrum/lines.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

struct Mark {
    double frequency = 0.0;  ///< Hz
    std::string label;
    int harmonics = 1;  ///< number of multiples, including the first

    static constexpr int max_harmonics = 50;
};

/// Parses "118.9:BPFI" or "118.9 Hz:BPFI:5": frequency, in Hz without a unit; label; number of harmonics. Throws Error.
Mark parse_mark(const std::string& text);

/// One marked frequency.
struct MarkPlace {
    std::string label;
    int harmonic = 1;
    double frequency = 0.0;  ///< Hz

    std::string name() const;  ///< "BPFI", "BPFI ×2"
};

/// All multiples of all marks, by mark.
std::vector<MarkPlace> places_of(std::span<const Mark> marks);

struct MarkLevel {
    MarkPlace place;
    double within = 0.0;  ///< Hz: search range of the strongest bin around the mark
    signal::SpectralLine line;  ///< the result, a line or noise
    bool is_line = false;  ///< true if it is a line above the noise
    std::optional<signal::SpectralLine> nearest;  ///< the nearest line of the whole spectrum, at any distance
};

/// Returns the levels at the frequencies that are within the spectrum (Hann, density). A line within one and a half
/// bins belongs to the mark.
std::vector<MarkLevel> levels_at(const signal::Spectrum& spectrum, std::span<const MarkPlace> places);

}  // namespace tactus::analysis
