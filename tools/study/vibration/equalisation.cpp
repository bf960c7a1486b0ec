// SPDX-License-Identifier: Apache-2.0
#include "tools/study/vibration/equalisation.hpp"

#include "assets/sound/response_file.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/filter/fir.hpp"
#include "dsp/signal/filter/resample.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::study {

namespace {

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

Flatness flatness(const vibration::FrequencyResponse& response, const vibration::Equaliser& equaliser,
                  double drive_limit) {
    Flatness result;
    for (int n = 0; n <= 40; ++n) {
        const double hz = std::pow(10.0, n / 10.0);
        if (hz < 0.99 * equaliser.lowest || hz > 1.01 * equaliser.highest) continue;
        const double plant = std::abs(vibration::interpolate(response, std::span(&hz, 1)).front());
        const double filter = std::abs(equaliser.gain(hz));
        result.before_db = std::max(result.before_db, std::abs(decibel(plant / equaliser.mean_gain)));
        result.after_db = std::max(result.after_db, std::abs(decibel(plant * filter / equaliser.mean_gain)));
        if (decibel(filter) > result.boost_db) result.boost_db = decibel(filter), result.boost_hz = hz;
        result.bands.push_back({hz, decibel(filter), drive_limit * plant});
    }
    return result;
}

/// The drive signal of the recording, without and with the equaliser.
Programme play(const EqualiseSettings& settings, const vibration::Equaliser& equaliser, double limit) {
    const sound::Sound sound = sound::load_sound(settings.signal);
    const std::vector<double> samples = signal::resample(sound::mix_to_mono(sound), sound.rate, equaliser.rate);
    std::vector<double> plain, equalised;
    signal::Fir fir(equaliser.taps);
    const double volts = settings.volts * settings.scale;
    for (const double x : samples) {
        plain.push_back(volts * x);
        equalised.push_back(volts * static_cast<double>(fir(static_cast<float>(x))));
    }
    return {vibration::headroom(plain, equaliser.rate, limit), vibration::headroom(equalised, equaliser.rate, limit)};
}

}  // namespace

Equalisation equalise(const EqualiseSettings& settings) {
    Equalisation made;
    made.actuator = &vibration::find_actuator(settings.actuator);
    if (!(settings.volts != 0.0 && std::isfinite(settings.volts) && settings.scale > 0.0 &&
          std::isfinite(settings.scale)))
        throw Error("--volts and --scale must be numbers other than 0");
    const sound::ResponseFile file = sound::load_response(settings.response);
    const vibration::FrequencyResponse& response = file.identified.response;
    made.title = file.title;
    made.unit = file.unit;
    made.equaliser = vibration::design_equaliser(response, settings.design);
    made.equaliser.unit = file.unit;
    made.limit = vibration::voltage_within(made.actuator->voltage_limit, made.actuator->current_limit,
                                           made.actuator->resistance);
    made.flat = flatness(response, made.equaliser, made.limit / std::abs(settings.volts));
    if (!settings.signal.empty()) made.programme = play(settings, made.equaliser, made.limit);
    return made;
}

}  // namespace tactus::study
