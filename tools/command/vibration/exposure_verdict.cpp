// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/exposure_verdict.hpp"

#include "dsp/core/readable.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::command {

const char* verdict_name(analysis::ExposureVerdict verdict) {
    switch (verdict) {
        case analysis::ExposureVerdict::below_action: return "below_action";
        case analysis::ExposureVerdict::above_action: return "above_action";
        case analysis::ExposureVerdict::above_limit: return "above_limit";
        case analysis::ExposureVerdict::at_least_above_action: return "at_least_above_action";
        case analysis::ExposureVerdict::cannot_be_judged: break;
    }
    return "cannot_be_judged";
}

std::string verdict_text(const std::string& what, const char* unit, double value, const signal::ExposureLimits& limits,
                         bool is_lower_bound) {
    const std::string begin =
        fmt::format("{} {}{} {}: ", what, is_lower_bound ? "at least " : "", plain(value, 3), unit);
    switch (analysis::judge_exposure(value, limits, is_lower_bound)) {
        case analysis::ExposureVerdict::below_action:
            return begin + fmt::format("below the action value, {:g}", limits.action);
        case analysis::ExposureVerdict::above_action:
            return begin + fmt::format("above the action value, {:g}", limits.action);
        case analysis::ExposureVerdict::above_limit:
            return begin + fmt::format("above the limit value, {:g}", limits.limit);
        case analysis::ExposureVerdict::at_least_above_action:
            return begin +
                   fmt::format("above the action value, {:g}; whether the limit value, {:g}, is kept cannot be judged",
                               limits.action, limits.limit);
        case analysis::ExposureVerdict::cannot_be_judged: break;
    }
    return begin + "cannot be judged; axes, frequencies or peaks are missing in the record";
}

file::Json minutes_json(double seconds) {
    return std::isfinite(seconds) ? file::Json(seconds / 60.0) : file::Json(nullptr);
}

std::string reached_text(double seconds, bool is_lower_bound) {
    if (seconds > 86400.0) return is_lower_bound ? "cannot be judged" : "not within a day";
    return fmt::format("after {}{:.0f} min", is_lower_bound ? "at most " : "", seconds / 60.0);
}

}  // namespace tactus::command
