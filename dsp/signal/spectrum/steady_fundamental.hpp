// SPDX-License-Identifier: Apache-2.0
// Fundamental frequency of a steady vibration from the frequencies of its lines. The lines of the whole record are far
// narrower than those of short sections. A test of coincidences determines whether they are orders of one rate, and the
// rate is the least-squares fit of all orders to the samples.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

struct SteadyFundamental {
    double frequency = 0.0;  ///< Hz; 0: no line
    /// Hz, standard deviation: the Cramér–Rao bound of the orders in the measured noise. 0: unknown, because the lines
    /// are not sharp or their orders do not fit the samples.
    double deviation = 0.0;
    double periods = 0.0;  ///< in the record, or in the segment beyond which the lines are smeared
    std::size_t lines = 0;  ///< number of orders found
    std::size_t strong_lines = 0;  ///< of these, within 33 dB of the strongest
    int highest_order = 0;
    double score = 0.0;  ///< log-likelihood that the lines are orders, relative to chance
    double rival = 0.0;  ///< Hz: the best other rate; 0: none
    double rival_score = 0.0;
    double explained = 0.0;  ///< fraction of the power of all lines
    double between = 0.0;  ///< log-likelihood ratio of the strongest bin at an order of a half, third, … of the rate
    double foreign = 0.0;  ///< log-likelihood ratio to noise of the strongest other line that is not hum
    double margin_db = 0.0;  ///< level of the strongest order above the weakest detectable line
    /// 1: the strongest order is equally strong throughout the record; p: it is in a fraction p only. Measured in
    /// eighths of the record, or in pieces of 8 periods if there are at most 2 strong lines: lower for a ring that
    /// decays before the next strike, which is a line of finite width and no tone.
    double persistence = 0.0;
    bool is_persistent = false;  ///< the persistence is that of a tone
    double lowest = 0.0;  ///< Hz: lower rates are not resolved
    /// The rate is within `mains_range` of the mains, of twice or six times it, or of another order beside which there
    /// are orders of the mains. One record does not distinguish its orders from hum, however many they are: rectifiers
    /// make as many as a machine.
    bool is_at_mains = false;
    /// The rate may only combine hum with the orders of a machine, or may be a multiple of a fundamental whose line was
    /// taken for hum.
    bool may_combine_hum = false;
    /// Strong lines are orders of a fraction of the rate: it may be a multiple of one below the range that is searched.
    bool may_be_multiple = false;
    bool is_sharp = false;  ///< the lines are as narrow as the longest segment resolves
    /// Probability that the rate is correct, not a multiple or fraction of the true rate; see `FundamentalEstimate`. 0
    /// at an order of the mains.
    double confidence = 0.0;
    double confidence_without_hum = 0.0;  ///< the same if the lines at orders of the mains are a machine's
};

/// Estimates the fundamental of a steady record that comes in pieces, in constant memory (about 20 MB at most).
class SteadyFundamentalStream {
public:
    /// `frames`: length of the record; an estimate is enough. Rates are sought from `lowest` to `highest` Hz.
    /// Allocates.
    SteadyFundamentalStream(double rate, std::size_t frames, double lowest, double highest);

    void push(std::span<const double> samples);
    /// Marks a gap: no segment spans it.
    void gap();
    SteadyFundamental estimate() const;
    /// Estimates from the lines of the kept samples on a time axis on which a rate that varies along `course` is
    /// constant at its mean: `course` holds the rate (Hz, > 0) at the middle of each `interval` s; linear in between.
    /// Order tracking: a line test after it separates a rate from its half as well as for a steady machine. Allocates.
    SteadyFundamental estimate_along(std::span<const double> course, double interval) const;
    /// The same along the course of a strong line of the longest piece, by its phase: resolves faster changes of the
    /// rate than sections do. Other lines that become sharp with it are orders of the same machine; without any, the line
    /// must be as steady as a tone. No rate if no line can be followed. Allocates.
    SteadyFundamental estimate_straightened() const;

private:
    void push_thinned(std::span<const double> samples);
    std::span<const double> piece(std::size_t index) const;
    std::span<const double> longest_piece() const;
    double persistence(double frequency, double snr, std::size_t length) const;
    double top() const { return factor_ > 1 ? 0.38 * rate_ : 0.48 * rate_; }
    SteadyFundamental estimate_along(std::span<const double> samples, std::span<const double> course,
                                     double interval) const;

    double lowest_, highest_;
    std::size_t factor_;  // of the reduction of the sample rate
    double rate_;  // reduced
    std::vector<double> taps_, history_, thinned_;
    std::size_t phase_ = 0;
    std::vector<WelchStream<double>> levels_;  // longest segments first
    std::vector<double> kept_;  // the first samples
    std::vector<std::size_t> pieces_{0};  // where the pieces between gaps begin in `kept_`
};

}  // namespace tactus::signal
