// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/hand_arm.hpp"

#include <cmath>
#include <limits>

namespace tactus::signal {

double vibration_total(std::span<const double> axes) {
    double sum = 0.0;
    for (const double a : axes) sum += a * a;
    return std::sqrt(sum);
}

double daily_exposure(std::span<const HandArmOperation> operations) {
    double sum = 0.0;
    for (const HandArmOperation& one : operations) sum += one.acceleration * one.acceleration * one.duration;
    return std::sqrt(sum / reference_day);
}

double time_to_reach(double value, double acceleration) {
    if (!(acceleration > 0.0)) return std::numeric_limits<double>::infinity();
    return reference_day * value * value / (acceleration * acceleration);
}

double years_to_white_fingers(double a8) { return 31.8 * std::pow(a8, -1.06); }

}  // namespace tactus::signal
