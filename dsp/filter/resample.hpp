// SPDX-License-Identifier: Apache-2.0
// Sound at another sample rate, by a windowed sinc.
#pragma once

#include <span>
#include <vector>

namespace tactus {

/// `samples` taken at `from` Hz, as if taken at `to` Hz from time `start` (s, of the record's clock) on. Flat within
/// 0.01 dB up to 0.4 of the lower rate; what would fold back below that is 80 dB down. Outside of the record there is
/// silence. Exact ratios of small whole numbers are fastest. Throws Error for rates that are not positive. Allocates.
std::vector<double> resample(std::span<const float> samples, double from, double to, double start = 0.0);
std::vector<double> resample(std::span<const double> samples, double from, double to, double start = 0.0);

}  // namespace tactus
