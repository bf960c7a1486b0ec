// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/whole_body.hpp"

#include <cmath>
#include <limits>

namespace tactus::signal {

namespace {

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

}  // namespace

double BodyAxisVibration::crest() const { return ratio(peak, rms); }

double BodyAxisVibration::running_ratio() const { return ratio(running, rms); }

double BodyAxisVibration::dose_ratio() const { return ratio(dose, rms * std::pow(seconds, 0.25)); }

bool BodyAxisVibration::has_shocks() const { return crest() > 9.0 || running_ratio() > 1.5 || dose_ratio() > 1.75; }

double BodyAxisVibration::dose_of(double duration) const {
    return seconds > 0.0 ? dose * std::pow(duration / seconds, 0.25) : 0.0;
}

double time_to_dose(double dose, const BodyAxisVibration& vibration, double k) {
    if (!(vibration.dose > 0.0)) return std::numeric_limits<double>::infinity();
    return vibration.seconds * std::pow(dose / (k * vibration.dose), 4.0);
}

}  // namespace tactus::signal
