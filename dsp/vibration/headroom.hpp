// SPDX-License-Identifier: Apache-2.0
// What the limits of an actuator leave of a vibration that is to be played.
#pragma once

#include <span>
#include <vector>

namespace tactus::vibration {

struct BandLoss {
    double hz = 0.0;       ///< true centre of the third-octave band
    double lost_db = 0.0;  ///< level that the limit takes away, at least 0
};

struct Headroom {
    double peak = 0.0;              ///< greatest drive asked for, V
    double headroom_db = 0.0;       ///< limit over peak; below 0 the limit cuts
    double limited_fraction = 0.0;  ///< share of the samples that are cut
    std::vector<BandLoss> losses;   ///< bands from 40 Hz to 1 kHz within 30 dB of the strongest that lose 0.1 dB
};

/// Drives an amplifier that cuts hard at ±`limit` V with `drive` (V, at `rate` Hz). Allocates.
Headroom headroom(std::span<const double> drive, double rate, double limit);

/// Greatest voltage that the limits allow: the amplifier's, or that which drives the greatest current through the coil.
double voltage_within(double voltage_limit, double current_limit, double resistance);

}  // namespace tactus::vibration
