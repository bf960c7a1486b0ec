// SPDX-License-Identifier: Apache-2.0
// Effect of an actuator's limits on a vibration.
#pragma once

#include <span>
#include <vector>

namespace tactus::vibration {

struct BandLoss {
    double hz = 0.0;       ///< true centre of the third-octave band
    double lost_db = 0.0;  ///< level that the limit removes, at least 0
};

struct Headroom {
    double peak = 0.0;  ///< peak of the commanded drive, V
    double headroom_db = 0.0;  ///< limit over peak; negative: the limit clips
    double limited_fraction = 0.0;  ///< fraction of clipped samples
    std::vector<BandLoss> losses;   ///< bands from 40 Hz to 1 kHz within 30 dB of the strongest that lose 0.1 dB
};

/// Clips `drive` (V, at `rate` Hz) at ±`limit` V and measures the loss. Allocates.
Headroom headroom(std::span<const double> drive, double rate, double limit);

/// Highest permitted voltage: the amplifier's limit, or that of the coil's current limit.
double voltage_within(double voltage_limit, double current_limit, double resistance);

}  // namespace tactus::vibration
