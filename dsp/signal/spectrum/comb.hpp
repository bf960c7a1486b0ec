// SPDX-License-Identifier: Apache-2.0
// Fundamental frequency of a live spectrum, without memory of its own: the comb that explains most lines with the fewest
// missing teeth. Records are analysed by `find_fundamental`.
#pragma once

#include "dsp/signal/spectrum/lines.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus::signal {

struct CombFit {
    double frequency = 0.0;  ///< Hz; 0: no line was found
    double explained = 0.0;  ///< share of the lines' amplitude on the comb, minus the share expected by chance
    double complete = 0.0;  ///< share of the comb's low teeth that are present
    double score() const { return explained * complete; }
};

struct Comb {
    static constexpr std::size_t most_rivals = 3;

    CombFit best;
    std::array<CombFit, most_rivals> rivals{};  ///< best first, without neighbours of the best
    std::size_t rival_count = 0;
    /// 0 … 1: the score of the best, halved when a rival is as good.
    double confidence = 0.0;

    std::span<const CombFit> others() const { return {rivals.data(), rival_count}; }
};

/// Fits combs with fundamentals from `lowest` to `highest` Hz. A comb and its subharmonic explain the same lines; the
/// subharmonic has more missing teeth and wins only when there are lines in between. Wait-free, does not allocate.
Comb fit_comb(const Spectrum& spectrum, double lowest, double highest) noexcept;

}  // namespace tactus::signal
