// SPDX-License-Identifier: Apache-2.0
// Statistics of a record in the time domain: mean, level, peak and clipping.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace tactus::signal {

class Level {
public:
    /// The result does not depend on how a record is cut into pieces.
    void push(std::span<const double> samples) noexcept;

    std::size_t count() const noexcept { return count_; }
    double mean() const noexcept { return merged().mean; }
    /// Root mean square about the mean.
    double rms() const noexcept { return count_ ? std::sqrt(merged().squares / static_cast<double>(count_)) : 0.0; }
    /// Largest distance from the mean.
    double peak() const noexcept { return count_ ? std::fmax(high_ - mean(), mean() - low_) : 0.0; }
    /// Largest distance from zero.
    double largest() const noexcept { return std::fmax(std::fabs(high_), std::fabs(low_)); }
    double crest() const noexcept { return rms() > 0.0 ? peak() / rms() : 0.0; }
    /// Clipped samples: those in runs of three or more at the maximum or minimum. Runs at the top of a coarsely
    /// quantised wave do not count unless they are much longer than the run before. 0 for a constant record.
    std::size_t clipped() const noexcept { return high_ > low_ ? at_low_.clipped + at_high_.clipped : 0; }

private:
    struct Limit {
        std::size_t run = 0, needed = 3, clipped = 0;

        void take(bool is_there, std::size_t needed_now) noexcept {
            run = is_there ? run + 1 : 0;
            if (run == 1) needed = std::max<std::size_t>(3, needed_now);
            if (run == needed) clipped += needed;
            else if (run > needed) ++clipped;
        }
    };
    /// Mean of samples, and the sum of their squared distances from it.
    struct Spread {
        double mean = 0.0, squares = 0.0;
    };
    static constexpr std::size_t block = 256;  // samples

    Spread merged() const noexcept;
    void follow_limits(std::span<const double> samples) noexcept;
    bool stays_inside(std::span<const double> samples) noexcept;

    std::size_t count_ = 0, dwell_ = 1;  // samples; length of the present run of equal ones
    Limit at_low_, at_high_;
    double last_ = 0.0, quantum_ = std::numeric_limits<double>::infinity();
    double low_ = 0.0, high_ = 0.0;
    Spread whole_;  // of all whole blocks
    // Of the samples of the last block that are there: differences from its first one.
    double first_ = 0.0, sum_ = 0.0, sum_of_squares_ = 0.0;
};

}  // namespace tactus::signal
