// SPDX-License-Identifier: Apache-2.0
// Judges the scores of a comparison against thresholds, with an explanation.
#pragma once

#include "assets/table/thresholds.hpp"
#include "dsp/signal/spectrum/comparison.hpp"
#include "dsp/signal/spectrum/mains.hpp"

#include <optional>
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

/// The mains whose hum is among the lines of a record: of 50 or 60 Hz, whichever has more of them. Orders of
/// `fundamental_hz` (0: none) are a machine's.
std::optional<signal::MainsComb> mains_of(std::span<const signal::SpectralLine> lines, double fundamental_hz);

/// "order 2 of 50 Hz, or mains hum": a rate at the mains, of a machine or of hum.
std::string uncertain_order(int order, double hz);

/// Rates after which the lines of a record are named, Hz; 0: none.
struct RecordRates {
    double fundamental_hz = 0.0;
    double hum_hz = 0.0;  ///< a rate that may be a machine's or hum
    std::optional<signal::MainsComb> mains;

    /// "order 2" of the fundamental, "order 2 of 50 Hz, or mains hum" of a rate that may be hum, "mains hum, 3 × 50 Hz"
    /// beside a machine of another rate, or "". Without a fundamental nothing shows that an order of the mains is hum.
    std::string name_of(double hz) const;
};

/// Names the lines of a comparison that the reference has, and those that only the output has.
class LineNames {
public:
    explicit LineNames(const signal::Comparison& comparison);

    std::string of_reference(double hz) const { return reference_.name_of(hz); }
    std::string of_output(double hz) const { return output_.name_of(hz); }

private:
    RecordRates reference_, output_;
};

}  // namespace tactus::analysis
