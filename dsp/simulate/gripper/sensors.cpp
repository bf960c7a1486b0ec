// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/gripper/sensors.hpp"

#include <algorithm>

namespace tactus::simulate {

LineFit fit_line(std::span<const double> x, std::span<const double> y) noexcept {
    const std::size_t count = std::min(x.size(), y.size());
    LineFit fit{0.0, 0.0, 0.0, 0.0};
    if (count == 0) return fit;
    double mean_x = 0.0, mean_y = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        mean_x += x[i];
        mean_y += y[i];
    }
    mean_x /= static_cast<double>(count);
    mean_y /= static_cast<double>(count);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
        yy += (y[i] - mean_y) * (y[i] - mean_y);
    }
    fit.slope = xx > 0.0 ? xy / xx : 0.0;
    fit.offset = mean_y - fit.slope * mean_x;
    fit.r_squared = xx > 0.0 && yy > 0.0 ? xy * xy / (xx * yy) : 0.0;
    for (std::size_t i = 0; i < count; ++i)
        fit.worst_residual = std::max(fit.worst_residual, std::abs(y[i] - fit(x[i])));
    return fit;
}

}  // namespace tactus::simulate
