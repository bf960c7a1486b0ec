// SPDX-License-Identifier: Apache-2.0
// One recording of a saw with its conditions.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::vibration {

/// One mono recording of a saw at a steady rate. The samples are needed during `prepare` only.
struct SawRecording {
    std::span<const float> samples;
    double sample_rate = 48000.0;         ///< Hz
    double reciprocation_rate = 0.0;  ///< strokes per second, Hz; refined within ±2 % from the sound
    double load = 0.0;  ///< thrust on the blade, N; ignored in free air
    bool cutting = false;  ///< in bone, else in free air
    double gain = 1.0;  ///< output per unit of sample: m/s² per full scale when calibrated
    std::size_t loop_begin = 0;  ///< samples to use: [begin, end); end 0 means all
    std::size_t loop_end = 0;
    double density = 0.0;  ///< of the bone, kg/m³; 0: unknown

    /// Returns the samples to use. Throws Error if there are none, or if a value is not positive and finite.
    std::span<const float> part() const;
};

}  // namespace tactus::vibration
