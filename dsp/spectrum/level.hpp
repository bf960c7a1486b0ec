// SPDX-License-Identifier: Apache-2.0
// What a record is before any spectrum: mean, level, peak, and whether it was cut at full scale.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace tactus {

class Level {
public:
    void push(std::span<const double> samples) noexcept {
        for (const double x : samples) {
            ++count_;
            // Welford's recurrence: no loss when a large offset lies under a small vibration.
            const double from_mean = x - mean_;
            mean_ += from_mean / static_cast<double>(count_);
            squares_ += from_mean * (x - mean_);
            low_ = count_ == 1 || x < low_ ? (low_run_ = low_clipped_ = 0, x) : low_;
            high_ = count_ == 1 || x > high_ ? (high_run_ = high_clipped_ = 0, x) : high_;
            at_limit(x == low_, low_run_, low_clipped_);
            at_limit(x == high_, high_run_, high_clipped_);
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
    /// Samples in runs of three or more at the highest or lowest value: a wave cut off. 0 for a constant record.
    std::size_t clipped() const noexcept { return high_ > low_ ? low_clipped_ + high_clipped_ : 0; }

private:
    static void at_limit(bool is_there, std::size_t& run, std::size_t& clipped) noexcept {
        run = is_there ? run + 1 : 0;
        if (run == 3) clipped += 3;
        else if (run > 3) ++clipped;
    }

    std::size_t count_ = 0, low_run_ = 0, high_run_ = 0, low_clipped_ = 0, high_clipped_ = 0;
    double mean_ = 0.0, squares_ = 0.0, low_ = 0.0, high_ = 0.0;
};

}  // namespace tactus
