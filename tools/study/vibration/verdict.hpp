// SPDX-License-Identifier: Apache-2.0
// Whether the scores of a comparison reach the thresholds, and what they say to a person.
#pragma once

#include "assets/table/thresholds.hpp"
#include "dsp/signal/spectrum/comparison.hpp"

#include <string>
#include <vector>

namespace tactus::study {

struct Judged {
    std::string name;   ///< of the score, as in the JSON
    double value = 0.0, limit = 0.0;
    bool at_least = false, passed = true;
    std::string about;  ///< what it says, in words
};

struct Verdict {
    std::vector<Judged> scores;                 ///< those that have a threshold and a value
    std::vector<std::string> not_judged;        ///< those with a threshold but no value
    std::vector<signal::SpectralLine> added, missing;           ///< lines that count against it

    bool passed() const;
    std::vector<std::string> failed() const;
};

Verdict judge(const signal::Comparison& comparison, double level_gap_db, const table::Thresholds& thresholds);

/// "hum of the mains (50 Hz × 3)", "order 2" of that fundamental, or nothing.
std::string name_of_line(double hz, double fundamental_hz);

}  // namespace tactus::study
