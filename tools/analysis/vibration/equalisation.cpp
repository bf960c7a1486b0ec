// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/equalisation.hpp"

#include "assets/sound/response_file.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/filter/fir.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

namespace {

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

/// Gain of actuator and filter over frequency. The grid is 16 times finer than the filter resolves, and includes the
/// frequencies of the response, between which that has no extremes.
struct GainGrid {
    std::vector<double> hz, plant, filter;

    GainGrid(const vibration::FrequencyResponse& response, const vibration::Equaliser& equaliser) {
        const std::vector<double> taps(equaliser.taps.begin(), equaliser.taps.end());
        const std::size_t size = std::bit_ceil(16 * taps.size());
        const std::vector<std::complex<double>> transform = signal::spectrum_of(taps, size);
        std::vector<std::pair<double, double>> gains;
        for (std::size_t k = 1; k < transform.size(); ++k)
            gains.emplace_back(static_cast<double>(k) * equaliser.rate / static_cast<double>(size),
                               std::abs(transform[k]));
        for (const double f : response.hz)
            if (f < 0.5 * equaliser.rate) gains.emplace_back(f, std::abs(equaliser.gain(f)));
        for (const double f : {equaliser.lowest, equaliser.highest}) gains.emplace_back(f, std::abs(equaliser.gain(f)));
        std::ranges::sort(gains);
        for (const auto& [f, gain] : gains) hz.push_back(f), filter.push_back(gain);
        for (const std::complex<double>& gain : vibration::interpolate(response, hz)) plant.push_back(std::abs(gain));
    }
};

Flatness flatness(const vibration::FrequencyResponse& response, const vibration::Equaliser& equaliser,
                  double drive_limit) {
    const GainGrid grid(response, equaliser);
    Flatness result;
    for (int n = 0; n <= 40; ++n) {
        const double centre = std::pow(10.0, n / 10.0);
        if (centre >= 0.99 * equaliser.lowest && centre <= 1.01 * equaliser.highest)
            result.bands.push_back({centre, -400.0, std::numeric_limits<double>::infinity()});
    }
    for (std::size_t i = 0; i < grid.hz.size(); ++i) {
        const double hz = grid.hz[i], plant = grid.plant[i], filter = decibel(grid.filter[i]);
        if (filter > result.boost_db) result.boost_db = filter, result.boost_hz = hz;
        if (hz < equaliser.lowest || hz > equaliser.highest) continue;
        const double before = std::abs(decibel(plant / equaliser.mean_gain));
        const double after = std::abs(decibel(plant / equaliser.mean_gain) + filter);
        result.before_db = std::max(result.before_db, before);
        if (after > result.after_db) result.after_db = after, result.after_hz = hz;
        if (const double loudest = drive_limit * plant; loudest < result.loudest) {
            result.loudest = loudest;
            result.loudest_hz = hz;
        }
        for (Flatness::Band& band : result.bands) {
            if (std::abs(std::log10(hz / band.hz)) > 0.05) continue;
            band.filter_db = std::max(band.filter_db, filter);
            band.loudest = std::min(band.loudest, drive_limit * plant);
        }
    }
    return result;
}

/// The drive signal of the recording, without and with the equaliser.
Programme play(const EqualiseSettings& settings, const vibration::Equaliser& equaliser, double limit,
               std::vector<std::string>& notes) {
    const sound::Sound sound = sound::load_sound(settings.signal);
    if (!sound.note.empty()) notes.push_back(fmt::format("{}: {}", settings.signal.string(), sound.note));
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
    if (!settings.signal.empty()) made.programme = play(settings, made.equaliser, made.limit, made.notes);
    return made;
}

}  // namespace tactus::analysis
