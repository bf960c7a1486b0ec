// SPDX-License-Identifier: Apache-2.0
// The level of a vibration over time, and its statistics, which distinguish an impact from a noise with random phases
// and an equal mean spectrum.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::signal {

/// Band-limited powers of frames of 20 ms, 16 bytes each.
class Course {
public:
    /// `rate`, and the band from `lowest` to `highest`, in Hz.
    Course(double rate, double lowest, double highest);

    void push(std::span<const double> samples);

    struct Frame {
        double square = 0.0, fourth = 0.0;  ///< means of the second and fourth power
    };
    std::span<const Frame> frames() const noexcept { return frames_; }

private:
    std::array<Biquad, 4> sections_;
    std::size_t length_, held_ = 0;
    Frame sum_;
    std::vector<Frame> frames_;
};

/// Kurtosis, spread of the level and depth of modulation in three bands of a course.
struct CourseStatistics {
    static constexpr std::array<const char*, 5> names{"kurtosis", "spread of the level", "modulation 0.5 to 2 Hz",
                                                      "modulation 2 to 8 Hz", "modulation 8 to 20 Hz"};
    std::array<double, 5> values{};  ///< ln of the kurtosis, dB, ln of the depths

    /// Allocates.
    explicit CourseStatistics(std::span<const Course::Frame> frames);
    double kurtosis() const;
};

struct StatisticsDifference {
    double deviation = 0.0;  ///< the largest difference relative to its tolerance
    std::string worst;       ///< name of that statistic
};

/// Difference of two separate takes. Tolerance of a statistic: a constant plus twice the difference between the halves
/// of the steadier take. Empty for a take below 1 s.
std::optional<StatisticsDifference> statistics_difference(std::span<const Course::Frame> reference,
                                                          std::span<const Course::Frame> output);

/// Difference of two aligned takes, dB: rms of the difference of their levels over time, of equal mean power, in frames
/// within 30 dB of the loudest. None when they have less than 10 frames in common.
std::optional<double> course_difference_db(std::span<const Course::Frame> reference,
                                           std::span<const Course::Frame> output);

}  // namespace tactus::signal
