// SPDX-License-Identifier: Apache-2.0
// Judges the scores of a comparison against thresholds, with an explanation.
#pragma once

#include "assets/table/thresholds.hpp"
#include "dsp/signal/spectrum/comparison.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

struct Judged {
    std::string name;   ///< name of the score, as in the JSON
    double value = 0.0, limit = 0.0;
    bool at_least = false, passed = true;
    std::string about;               ///< explanation of the score, with its band
    double lowest = 0.0, highest = 0.0;  ///< Hz: the band of the score
};

struct Verdict {
    std::vector<Judged> scores;                 ///< scores with a threshold and a value
    std::vector<std::string> not_judged;        ///< scores with a threshold but without a value
    std::vector<signal::SpectralLine> added, missing;           ///< lines that cause a failure

    std::string time;  ///< the temporal property that passed: "course over time", "statistics"; empty: none
    double lowest = 0.0, highest = 0.0;  ///< Hz: the band that was judged

    bool passed() const;
    /// False if nothing speaks against it but that no line or band stands above the noise of both.
    bool is_judged() const;
    /// The verdict with its scope, such as "Same mean spectrum and course over time, 40 to 1000 Hz".
    std::string words() const;
    std::vector<std::string> failed() const;
};

Verdict judge(const signal::Comparison& comparison, double level_gap_db, const table::Thresholds& thresholds);

/// Frequency of the mains whose hum is among the lines of a record: 50 or 60 Hz, whichever has more of them; 0 if none
/// is one of its first three orders.
int mains_of(std::span<const signal::SpectralLine> lines);

/// "order 2" of the fundamental, "mains hum, 3 × 50 Hz" of mains of `mains_hz`, or "". 0: unknown.
std::string name_of_line(double hz, double fundamental_hz, int mains_hz);

/// Names the lines of a comparison that the reference has, and those that only the output has.
class LineNames {
public:
    explicit LineNames(const signal::Comparison& comparison);

    std::string of_reference(double hz) const { return name_of_line(hz, reference_hz_, reference_mains_); }
    std::string of_output(double hz) const { return name_of_line(hz, output_hz_, output_mains_); }

private:
    double reference_hz_, output_hz_;
    int reference_mains_, output_mains_;
};

}  // namespace tactus::analysis
