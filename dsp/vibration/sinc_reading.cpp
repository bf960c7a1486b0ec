// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/sinc_reading.hpp"

#include "dsp/core/constants.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tactus::vibration {

namespace {

constexpr int taps = reading_taps;

/// Interpolation kernel with one row of taps per fraction of a sample, so that a row is contiguous.
struct ReadingTable {
    static constexpr int steps = 512;
    std::vector<float> rows = std::vector<float>((steps + 1) * taps);

    ReadingTable() {
        const SincKernel kernel{reading_half};
        for (int row = 0; row <= steps; ++row)
            for (int tap = 0; tap < taps; ++tap)
                rows[static_cast<std::size_t>(row * taps + tap)] =
                    static_cast<float>(kernel(static_cast<double>(row) / steps - (tap + 1 - reading_half)));
    }
    /// `samples`: 16 of them; x in [0, 1] lies between the eighth and the ninth.
    double operator()(const float* samples, double x) const noexcept {
        const double position = x * steps;
        const int row = std::min(static_cast<int>(position), steps - 1);
        const auto part = static_cast<float>(position - row);
        const float* const here = rows.data() + row * taps;
        const float* const next = here + taps;
        // Four parallel sums, for vector units.
        float lanes[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int tap = 0; tap < taps; tap += 4)
            for (int lane = 0; lane < 4; ++lane) {
                const int i = tap + lane;
                lanes[lane] += samples[i] * (here[i] + part * (next[i] - here[i]));
            }
        return static_cast<double>((lanes[0] + lanes[1]) + (lanes[2] + lanes[3]));
    }
};

const ReadingTable reading;

}  // namespace

SincKernel::SincKernel(int crossings) : half(crossings), table(static_cast<std::size_t>(crossings * steps + 2)) {
    for (std::size_t i = 0; i + 2 < table.size(); ++i) {
        const double x = static_cast<double>(i) / steps, w = pi * x / half;
        const double window = 0.42 + 0.5 * std::cos(w) + 0.08 * std::cos(2.0 * w);
        table[i] = (i == 0 ? 1.0 : std::sin(pi * x) / (pi * x)) * window;
    }
}

double read_between(const float* samples, double x) noexcept { return reading(samples, x); }

}  // namespace tactus::vibration
