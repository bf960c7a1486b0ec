// SPDX-License-Identifier: Apache-2.0
// Shape of the distribution of a record's values.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace tactus::signal {

/// Central moments about a mean that is known beforehand, which costs no division per sample and stays accurate for a
/// small vibration on a large offset.
class Moments {
public:
    void push(std::span<const double> samples, double mean) noexcept {
        for (const double x : samples) {
            const double d = x - mean, square = d * d;
            second_ += square;
            third_ += square * d;
            fourth_ += square * square;
        }
        count_ += samples.size();
    }
    /// m3 / m2^1.5, biased as scipy.stats.skew: 0 of a symmetrical distribution; 0 for a constant record.
    double skewness() const noexcept {
        return second_ > 0.0 ? third_ / second_ * std::sqrt(static_cast<double>(count_) / second_) : 0.0;
    }
    /// m4 / m2² (Pearson, not the excess): 3 of Gaussian noise, 1.5 of a sine, more with impacts; 0 for a constant record.
    double kurtosis() const noexcept {
        return second_ > 0.0 ? fourth_ / second_ * (static_cast<double>(count_) / second_) : 0.0;
    }

private:
    std::size_t count_ = 0;
    double second_ = 0.0, third_ = 0.0, fourth_ = 0.0;
};

}  // namespace tactus::signal
