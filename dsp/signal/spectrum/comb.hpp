// SPDX-License-Identifier: Apache-2.0
// The rate of a machine from the lines of its spectrum: the comb that explains most of them with fewest teeth missing.
#pragma once

#include "dsp/signal/spectrum/lines.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus::signal {

struct CombFit {
    double frequency = 0.0;   ///< Hz; 0: no line was found
    double explained = 0.0;   ///< share of the lines' amplitude that lies on the comb, less what chance explains
    double complete = 0.0;    ///< share of the comb's low teeth that are there
    double score() const { return explained * complete; }
};

struct Comb {
    static constexpr std::size_t most_rivals = 3;

    CombFit best;
    std::array<CombFit, most_rivals> rivals{};  ///< best first: no neighbours of the best
    std::size_t rival_count = 0;
    /// 0 … 1: the score of the best, halved when a rival does as well.
    double confidence = 0.0;

    std::span<const CombFit> others() const { return {rivals.data(), rival_count}; }
};

/// Fits combs with fundamentals from `lowest` to `highest` Hz. A comb and its subharmonic explain the same lines; the
/// subharmonic has more teeth missing, so it wins only when lines between speak for it. Wait-free, allocates nothing.
Comb fit_comb(const Spectrum& spectrum, double lowest, double highest) noexcept;

/// The same of a record at `rate` Hz that is in memory, by its spectrum in segments of the suggested length. No comb when
/// the record has fewer than two of them. Allocates.
Comb fit_comb(std::span<const float> record, double rate, double lowest, double highest);

/// From this confidence on a rate is taken for the machine's; noise stays far below.
inline constexpr double sure_of_comb = 0.3;

}  // namespace tactus::signal
