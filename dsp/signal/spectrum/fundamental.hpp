// SPDX-License-Identifier: Apache-2.0
// Fundamental frequency of a vibration; all analyses use this estimator. If the lines of the whole record are steady,
// they determine it; otherwise harmonic sums of short sections, joined to a path over time.
#pragma once

#include "dsp/signal/spectrum/harmonic_sum.hpp"
#include "dsp/signal/spectrum/steady_fundamental.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::signal {

/// Default search range, Hz.
inline constexpr double lowest_fundamental = 5.0, highest_fundamental = 1000.0;

struct FundamentalEstimate {
    double frequency = 0.0;  ///< Hz; 0: not periodic
    /// 0 … 1. For a steady rate, the probability that it is correct; for a path, the mean score of its sections.
    double confidence = 0.0;
    /// True only if the error rate is at most about 1 % of machines. Never true if the record does not resolve half of
    /// the rate.
    bool certain = false;
    /// Uncertain only because the rate is an order of the mains: hum, or a machine.
    bool may_be_hum = false;
    bool steady = false;  ///< constant rate; otherwise `frequency` is the median of its path
    double low = 0.0, high = 0.0;  ///< Hz: the middle 80 % of the path
    /// Hz: standard deviation of a steady rate (Cramér–Rao bound in the measured noise); 0: unknown, as for lines that
    /// are wider than the record resolves.
    double deviation = 0.0;
    double periods = 0.0;  ///< number of periods in the record
    std::vector<HarmonicSum> rivals;  ///< other rates that explain the lines nearly as well

    static constexpr double sure = 0.97;  ///< min confidence of a certain steady rate
    /// Min confidence of a certain path of at least four sections; and of a path that varies by more than 10 % and
    /// whose straightened record has the same rate.
    static constexpr double path = 0.32, wide_path = 0.25;
    static constexpr double heard = 0.16;  ///< below it, there is no fundamental
    bool is_certain() const { return frequency > 0.0 && certain; }
};

/// Estimates the fundamental of a record that comes in pieces. Memory: about 100 bytes per half second, in addition to
/// that of the steady lines.
class FundamentalStream {
public:
    /// `frames`: length of the record; an estimate is enough.
    FundamentalStream(double rate, std::size_t frames, double lowest = lowest_fundamental,
                      double highest = highest_fundamental);

    void push(std::span<const double> samples);
    /// Marks a gap: no section spans it.
    void gap();
    FundamentalEstimate estimate() const;
    /// Density of the whole record (Hann, `suggested_segment`, half overlap, mean), of which the estimate is made.
    /// Allocates.
    Spectrum spectrum() const { return whole_.spectrum(); }

private:
    static constexpr std::size_t max_candidates = 6;
    struct Section {
        std::array<HarmonicSum, max_candidates> candidates{};
        std::size_t count = 0;
    };
    struct Path {
        std::vector<HarmonicSum> points;  // one per section; frequency 0: none
        double score = 0.0;
    };
    void end_section();
    Path best_path() const;
    FundamentalEstimate along(const Path& path) const;
    SteadyFundamental resolved_lines() const;
    SteadyFundamental lines_along(const Path& path, double median) const;

    double lowest_, highest_, highest_moving_, rate_;
    std::size_t pushed_ = 0;
    SteadyFundamentalStream steady_;
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
