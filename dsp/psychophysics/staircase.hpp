// SPDX-License-Identifier: Apache-2.0
// Staircases: the level falls after correct answers and rises after wrong ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::psychophysics {

struct StaircaseRule {
    /// transformed: `down` correct answers in a row lower the level, one wrong answer raises it (Levitt 1971).
    /// weighted: each correct answer lowers it by `step_down`, each wrong one raises it by `step_up` (Kaernbach 1991).
    enum class Kind : std::uint8_t { transformed, weighted } kind = Kind::transformed;
    int down = 2;
    double start = 0.0;
    double step_up = 0.1, step_down = 0.1;  ///< in units of the level
    /// Steps are this many times larger until the first reversal; each reversal halves the factor, down to 1. The staircase comes
    /// back sooner from a run of lucky guesses than with the final step alone.
    double first_factor = 4.0;
    double min = -1.0, max = 1.0;
    int reversals = 12;  ///< it ends there
    int max_trials = 200;

    /// Probability of a correct answer about which the level settles. transformed: p^down = step_up/(step_up + step_down);
    /// weighted: p = step_up/(step_up + step_down).
    double target() const;
};

class Staircase {
public:
    /// Throws Error for steps that are not positive, a start outside of [min, max], `down` below 1.
    explicit Staircase(const StaircaseRule& rule);

    double level() const { return level_; }
    void answer(bool correct);
    bool is_done() const {
        return reversals_.size() >= static_cast<std::size_t>(rule_.reversals) || trials_ >= rule_.max_trials;
    }
    int trials() const { return trials_; }
    const std::vector<double>& reversals() const { return reversals_; }  ///< levels

private:
    void move(int direction);

    StaircaseRule rule_;
    double level_;
    int correct_in_a_row_ = 0, direction_ = 0, trials_ = 0;
    std::vector<double> reversals_;
};

}  // namespace tactus::psychophysics
