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
    void push(std::span<const double> samples) noexcept {
        for (const double x : samples) {
            ++count_;
            // Welford's recurrence: stays accurate for a small vibration on a large offset.
            const double from_mean = x - mean_;
            mean_ += from_mean / static_cast<double>(count_);
            squares_ += from_mean * (x - mean_);
            if (const double step = std::fabs(x - last_); count_ > 1 && step > 0.0)
                quantum_ = std::fmin(quantum_, step);
            if (count_ == 1 || x < low_) low_ = x, at_low_ = {};
            if (count_ == 1 || x > high_) high_ = x, at_high_ = {};
            // Coarse quantisation makes short runs at a wave's top, not much longer than on the step before.
            const std::size_t needed = quantum_ > 1e-3 * (high_ - low_) ? 6 * dwell_ + 1 : 3;
            at_low_.take(x == low_, needed);
            at_high_.take(x == high_, needed);
            dwell_ = count_ > 1 && x == last_ ? dwell_ + 1 : 1;
            last_ = x;
        }
    }

    std::size_t count() const noexcept { return count_; }
    double mean() const noexcept { return mean_; }
    /// Root mean square about the mean.
    double rms() const noexcept { return count_ ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0; }
    /// Largest distance from the mean.
    double peak() const noexcept { return count_ ? std::fmax(high_ - mean_, mean_ - low_) : 0.0; }
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
    std::size_t count_ = 0, dwell_ = 1;  // samples; length of the present run of equal ones
    Limit at_low_, at_high_;
    double last_ = 0.0, quantum_ = std::numeric_limits<double>::infinity();
    double mean_ = 0.0, squares_ = 0.0, low_ = 0.0, high_ = 0.0;
};

}  // namespace tactus::signal
