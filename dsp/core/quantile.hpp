// SPDX-License-Identifier: Apache-2.0
// Quantiles from a histogram of fixed size.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tactus {

/// Counts of positive numbers from 1e-12 to 1e6 in classes 3.7 % wide.
class SizeCounts {
public:
    void add(double x) noexcept {
        ++total_;
        greatest_ = std::max(greatest_, x);
        const double at = x > 0.0 ? (std::log10(x) + 12.0) * per_decade : 0.0;
        // The comparison puts NaN in the last class.
        ++counts_[at < static_cast<double>(classes) ? static_cast<std::size_t>(std::max(at, 0.0)) : classes - 1];
    }
    /// Upper limit of the class that contains this quantile, at most the greatest number added; 0 without numbers.
    double quantile(double share) const noexcept {
        const double wanted = share * static_cast<double>(total_);
        std::uint64_t below = 0;
        for (std::size_t c = 0; c < classes; ++c) {
            below += counts_[c];
            if (below > 0 && static_cast<double>(below) >= wanted)
                return c == 0 ? 0.0
                              : std::min(greatest_, std::pow(10.0, static_cast<double>(c + 1) / per_decade - 12.0));
        }
        return greatest_;
    }
    double greatest() const noexcept { return greatest_; }
    std::uint64_t total() const noexcept { return total_; }

private:
    static constexpr double per_decade = 64.0;
    static constexpr std::size_t classes = 18 * 64;
    std::array<std::uint64_t, classes> counts_{};
    std::uint64_t total_ = 0;
    double greatest_ = 0.0;
};

}  // namespace tactus
