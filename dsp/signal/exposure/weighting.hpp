// SPDX-License-Identifier: Apache-2.0
// Frequency weightings of human vibration (ISO 8041-1:2017, table 3), and the measures of a weighted record: rms, peak,
// running rms and dose. Accelerations in m/s², frequencies in Hz, times in s.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Product of formulas (1) to (4) of ISO 8041-1: Butterworth band limits at `low` and `high`, the transition from
/// acceleration to velocity at `transition`, and a step up from `step_zero` to `step_pole`.
struct Weighting {
    const char* name;
    double low, high;
    double transition, transition_q;
    double gain = 1.0;
    double step_zero = 0.0, step_zero_q = 1.0, step_pole = 0.0, step_pole_q = 1.0;  ///< 0 Hz: no step
    double lowest = 0.0, highest = 0.0;  ///< limits of the one-third octave bands of the weighted value

    bool has_step() const { return step_zero > 0.0; }
    /// Complex gain; 1 means unweighted.
    std::complex<double> operator()(double frequency) const;
};

/// Hand and arm, every direction (ISO 5349-1): bands 6.3 Hz to 1250 Hz.
inline constexpr Weighting weighting_h{
    "Wh", 6.309573444801933, 1258.9254117941673, 15.915494309189535, 0.64, 1.0, 0.0, 1.0, 0.0,
    1.0,  5.623413251903491, 1412.5375446227544};
/// Whole body, vertical (ISO 2631-1): bands 0.5 Hz to 80 Hz.
inline constexpr Weighting weighting_k{
    "Wk", 0.4, 100.0, 12.5, 0.63, 1.0, 2.37, 0.91, 3.35, 0.91, 0.4466835921509631, 89.12509381337456};
/// Whole body, horizontal (ISO 2631-1).
inline constexpr Weighting weighting_d{
    "Wd", 0.4, 100.0, 2.0, 0.63, 1.0, 0.0, 1.0, 0.0, 1.0, 0.4466835921509631, 89.12509381337456};
/// Whole body, vertical, comfort in trains (ISO 2631-4).
inline constexpr Weighting weighting_b{
    "Wb", 0.4, 100.0, 16.0, 0.55, 1.024, 2.5, 0.9, 4.0, 0.95, 0.4466835921509631, 89.12509381337456};

/// A weighting as a filter of up to four sections. Gain within 0.5 % of the definition in its bands for rates of at least
/// 16 times `high`; Wh within 0.1 % from 44.1 kHz on, 3 % at 8 kHz.
class WeightingFilter {
public:
    /// Throws Error when the rate is not above 0 Hz.
    WeightingFilter(const Weighting& weighting, double rate);
    double operator()(double x) noexcept { return sections_[3](sections_[2](sections_[1](sections_[0](x)))); }
    std::complex<double> response(double frequency) const;

private:
    double rate_;
    std::array<Biquad, 4> sections_;
};

/// Root mean square of a weighted record, by two methods that agree: the filter above, with zero state at the start of
/// each piece, and the Fourier transform of the pieces with the definition. Both include the decay of the weighting
/// after the end. The transform processes at most 2^21 samples at a time. Peak, running rms and dose come from the
/// filter.
class WeightedRecord {
public:
    /// `mean`: of the whole record. It is removed, because it is no vibration and its onset would excite the weighting.
    WeightedRecord(const Weighting& weighting, double rate, double mean);

    void push(std::span<const double> samples);
    /// Call before a gap, and at the end of the record.
    void end_piece();
    double by_transform() const;
    double by_filter() const;
    double peak() const { return peak_; }
    /// Maximum transient vibration value, MTVV: the largest rms over 1 s (ISO 2631-1, formulas 2 and 4); for a shorter
    /// piece, the rms of all of it.
    double max_running_rms() const { return max_running_; }
    /// Vibration dose value, VDV = (∫ a⁴ dt)^¼ in m/s^1.75 (ISO 2631-1, formula 5).
    double dose() const;
    double seconds() const { return static_cast<double>(count_) / rate_; }

private:
    static constexpr std::size_t longest_block = std::size_t{1} << 21;
    void filter(double x);
    void transform();
    std::size_t tail() const;

    Weighting weighting_;
    double rate_, mean_;
    WeightingFilter filter_;
    std::vector<double> held_;
    std::vector<double> second_;  // squares of the last second
    double running_ = 0.0, max_running_ = 0.0, peak_ = 0.0, fourth_ = 0.0;
    std::size_t count_ = 0, in_piece_ = 0, filtered_in_piece_ = 0;
    double transformed_ = 0.0, filtered_ = 0.0;
};

}  // namespace tactus::signal
