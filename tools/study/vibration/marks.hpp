// SPDX-License-Identifier: Apache-2.0
// Marked frequencies, such as those of a bearing or of teeth, and the levels that a spectrum has there.
#pragma once

#include "dsp/signal/spectrum/lines.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::study {

struct Mark {
    double frequency = 0.0;  ///< Hz
    std::string label;
    int harmonics = 1;  ///< how many multiples are marked, the first included

    static constexpr int most_harmonics = 50;
};

/// "118.9:BPFI", "118.9 Hz:BPFI:5": frequency, in Hz without a unit; label; number of harmonics. Throws Error.
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
    double within = 0.0;        ///< Hz: how far from the mark the strongest bin was sought
    signal::SpectralLine line;  ///< what was found there, a line or noise
    bool is_line = false;       ///< it is a line above the noise
    std::optional<signal::SpectralLine> nearest;  ///< the nearest line of the whole spectrum, whatever its distance
};

/// The levels at the places that are within the spectrum (Hann, density). A line counts as at the mark within one and a
/// half bins.
std::vector<MarkLevel> levels_at(const signal::Spectrum& spectrum, std::span<const MarkPlace> places);

}  // namespace tactus::study
