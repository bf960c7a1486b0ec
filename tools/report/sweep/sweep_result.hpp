// SPDX-License-Identifier: Apache-2.0
// How far a sweep is, as a result.
#pragma once

#include "tools/analysis/sweep/results.hpp"
#include "tools/report/result/fields.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

struct SweepState {
    explicit SweepState(const analysis::Results& results);

    /// Of one worker after another, s; none without a finished point.
    std::optional<double> work_left() const;
    /// With the workers that wrote in the last minutes; none without them.
    std::optional<double> seconds_left() const;

    const analysis::Results* results;
    std::vector<analysis::Results::Failure> failures;
    std::optional<double> seconds_per_point;
    std::size_t workers;  ///< that wrote in the last minutes; 0 once nothing is left
};

const Fields<SweepState>& sweep_state_fields();

/// The words of a step (from 1) at a point, as a shell would read them; for repeating it by hand.
std::string point_text(const analysis::SweepFolder& folder, std::size_t index, int step = 1);

/// "3 s", "2.5 min", "4.1 h", "3.2 days".
std::string duration_text(double seconds);

}  // namespace tactus::report
