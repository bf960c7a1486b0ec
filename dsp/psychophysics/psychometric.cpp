// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/psychometric.hpp"

#include "dsp/statistics/distributions.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::psychophysics {

double Psychometric::core(double x) const {
    const double z = slope * (x - threshold);
    switch (form) {
        case Form::logistic: return 1.0 / (1.0 + std::exp(-z));
        case Form::weibull: return -std::expm1(-std::exp(std::numbers::ln10 * z));
        case Form::normal: return statistics::normal_cdf(z);
    }
    return 0.0;
}

double Psychometric::level_of(double p) const {
    const double f = (p - guess) / (1.0 - guess - lapse);
    if (!(f > 0.0 && f < 1.0)) return std::numeric_limits<double>::quiet_NaN();
    switch (form) {
        case Form::logistic: return threshold + std::log(f / (1.0 - f)) / slope;
        case Form::weibull: return threshold + std::log10(-std::log1p(-f)) / slope;
        case Form::normal: return threshold + statistics::normal_quantile(f) / slope;
    }
    return 0.0;
}

std::vector<double> usual_slopes(Form form, double scale) {
    const auto width_of = [](Form one) {
        const Psychometric unit{one, 0.0, 1.0, 0.0, 0.0};
        return unit.level_of(0.75) - unit.level_of(0.25);
    };
    std::vector<double> slopes{1.0, 2.0, 3.5, 5.0};  // exponents of a Weibull function
    for (double& slope : slopes) slope *= width_of(form) / (width_of(Form::weibull) * scale);
    return slopes;
}

}  // namespace tactus::psychophysics
