// SPDX-License-Identifier: Apache-2.0
// Fundamental frequency of a vibration, the one estimator of all analyses: harmonic sums of short sections, joined to a path over time, beside the harmonic sum of
// the spectrum of the whole record.
#pragma once

#include "dsp/signal/spectrum/harmonic_sum.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::signal {

/// Hz: the range that is searched unless a caller knows better.
inline constexpr double lowest_fundamental = 20.0, highest_fundamental = 500.0;

struct FundamentalEstimate {
    double frequency = 0.0;  ///< Hz; 0: not periodic
    double confidence = 0.0;  ///< 0 … 1; uncertain below `certain`
    bool steady = false;  ///< constant rate; otherwise `frequency` is the median of its path
    double low = 0.0, high = 0.0;  ///< Hz: the middle 80 % of the path
    std::vector<HarmonicSum> rivals;  ///< other rates that explain the lines nearly as well

    static constexpr double certain =
        0.25;  // of 200 noisy saws, 97 % of the right ones reach it and none of the wrong ones
    static constexpr double heard = 0.16;  // below it, there is no fundamental
    bool is_certain() const { return frequency > 0.0 && confidence >= certain; }
};

/// Estimates the fundamental of a record that comes in pieces, in a memory of about 100 bytes per half second.
class FundamentalStream {
public:
    /// `frames`: length of the record; an estimate is enough.
    FundamentalStream(double rate, std::size_t frames, double lowest = lowest_fundamental,
                      double highest = highest_fundamental);

    void push(std::span<const double> samples);
    /// Marks a gap: no section spans it.
    void gap();
    FundamentalEstimate estimate() const;

private:
    static constexpr std::size_t most_candidates = 6;
    struct Section {
        std::array<HarmonicSum, most_candidates> candidates{};
        std::size_t count = 0;
    };
    struct Path {
        std::vector<HarmonicSum> points;  // one per section; frequency 0: none
        double score = 0.0;
    };
    void end_section();
    Path best_path() const;

    double lowest_, highest_;
    WelchStream<double> whole_, section_, fresh_section_;
    std::size_t section_length_, in_section_ = 0;
    std::vector<Section> sections_;
    std::array<double, 8> movement_{};  // squared differences in the eighths of a section
    double last_ = 0.0;
};

/// The same for a record in memory.
FundamentalEstimate find_fundamental(std::span<const double> record, double rate, double lowest = lowest_fundamental,
                                     double highest = highest_fundamental);
FundamentalEstimate find_fundamental(std::span<const float> record, double rate, double lowest = lowest_fundamental,
                                     double highest = highest_fundamental);

}  // namespace tactus::signal
