// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/level_reference.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

double LevelReference::db(double mean_square) const {
    return 10.0 * std::log10(std::max(mean_square / (value * value), 1e-30));
}

LevelReference level_reference(const sound::Calibration& calibration) {
    if (calibration.known && calibration.is_acceleration) return {1e-6 / calibration.si, "1 µm/s²"};
    if (!calibration.known && calibration.unit == "full scale") return {1.0, "full scale"};
    return {1.0, "1 " + calibration.unit};
}

}  // namespace tactus::analysis
