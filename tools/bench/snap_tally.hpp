// SPDX-License-Identifier: Apache-2.0
// How often a method brought two fragments together, how well, and how long it took.
#pragma once

#include "dsp/core/clock.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fit.hpp"
#include "tools/bench/snap_cases.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::bench {

constexpr double success = 0.5e-3;  // m, rms over the whole fragment

inline double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Results of a method over all trials of a case and start.
struct Tally {
    std::vector<double> error, angle, time;
    int failures_flagged = 0, failures = 0, alarms = 0, judged = 0;

    void add(const FracturePair& pair, const Pose& pose, double seconds) {
        error.push_back(pair.error(pose));
        angle.push_back(glm::length(rotation_between(pair.truth.orientation, pose.orientation)) / degree);
        time.push_back(seconds);
    }
    void judge(fit::FitVerdict verdict) {
        ++judged;
        const bool failed = !(error.back() < success), flagged = verdict != fit::FitVerdict::fit;
        failures += failed;
        failures_flagged += failed && flagged;
        alarms += !failed && flagged;
    }
    double share() const {
        const auto good = std::ranges::count_if(error, [](double e) { return e < success; });
        return error.empty() ? 0.0 : static_cast<double>(good) / static_cast<double>(error.size());
    }
};

using Tallies = std::map<std::string, Tally>;

struct TimedFit {
    fit::Fit fit;
    double seconds = 0.0;

    TimedFit(const FracturePair& pair, const Pose& start, fit::FitMode mode) {
        const std::int64_t begin = thread_ns();
        fit = fit::find_fit(pair.moving, pair.fixed, start, mode);
        seconds = 1e-9 * static_cast<double>(thread_ns() - begin);
    }
};

}  // namespace tactus::bench
