// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/saw_recording.hpp"

#include "dsp/core/error.hpp"

#include <cmath>

namespace tactus::vibration {

std::span<const float> SawRecording::part() const {
    const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
    const std::size_t end = loop_end == 0 ? samples.size() : loop_end;
    if (!positive(sample_rate) || !positive(reciprocation_rate) || !std::isfinite(gain) || !std::isfinite(load) ||
        !(std::isfinite(density) && density >= 0.0) || end > samples.size() || loop_begin >= end)
        throw Error("a recording of a saw needs samples, a sample rate and a rate of reciprocation above 0");
    return samples.subspan(loop_begin, end - loop_begin);
}

}  // namespace tactus::vibration
