// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/measured_plant.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::vibration {

double plant_delay(const FrequencyResponse& response) { return 2.0 / response.hz.back(); }

std::vector<float> impulse_response(const FrequencyResponse& response, double rate, std::size_t length) {
    if (response.hz.size() < 3) throw Error("a measured response needs at least 3 frequencies");
    const std::size_t size = std::bit_ceil(8 * length);
    const double step = rate / static_cast<double>(size), first = response.hz.front(), last = response.hz.back();
    const double delay = response.latency + plant_delay(response);
    std::vector<double> hz;
    for (std::size_t k = 1; k <= size / 2; ++k) hz.push_back(step * static_cast<double>(k));
    std::vector<std::complex<double>> half{0.0};
    for (const std::complex<double>& gain : interpolate(response, hz)) {
        const double f = hz[half.size() - 1];
        const double share = f < first        ? (f / first) * (f / first)
                             : f < last       ? 1.0
                             : f < 2.0 * last ? 0.5 + 0.5 * std::cos(pi * (f - last) / last)
                                              : 0.0;
        half.push_back(gain * std::polar(share, -2.0 * pi * f * delay));
    }
    half.back() = half.back().real();
    const std::vector<double> samples = signal::samples_of(half);
    double kept = 0.0, all = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        all += samples[i] * samples[i];
        if (i < length) kept += samples[i] * samples[i];
    }
    if (!(all > 0.0)) throw Error("the measured response is silent");
    if (all - kept > 0.01 * all)
        throw Error(
            fmt::format("{:.1f} % of the measured impulse response lie outside of its first {:.3g} ms: it rings too "
                        "long for a filter, or its phase is not causal",
                        100.0 * (1.0 - kept / all), 1e3 * static_cast<double>(length) / rate));
    return {samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(length)};
}

}  // namespace tactus::vibration
