// SPDX-License-Identifier: Apache-2.0
// Root mean square of the loudest of consecutive sections.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tactus::signal {

class LoudestRms {
public:
    /// `section`: samples, at least 1.
    explicit LoudestRms(std::size_t section = 1) : section_(std::max<std::size_t>(1, section)) {}

    void operator()(double x) noexcept {
        squares_ += x * x;
        if (++held_ < section_) return;
        most_ = std::max(most_, squares_);
        squares_ = 0.0;
        held_ = 0;
    }
    /// Over whole sections; 0 before the first.
    double value() const noexcept { return std::sqrt(most_ / static_cast<double>(section_)); }

private:
    std::size_t section_, held_ = 0;
    double squares_ = 0.0, most_ = 0.0;
};

}  // namespace tactus::signal
