// SPDX-License-Identifier: Apache-2.0
#include "tools/window/training/score_words.hpp"

#include "tools/analysis/training/score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

namespace tactus::window {

namespace {

std::string score_words(const analysis::ScoredRun& run) {
    const analysis::Score& s = run.score;
    std::string text = fmt::format("removed {:.0f} mm³ in {:.1f} s; force {:.1f} N mean, {:.1f} N at most\n",
                                   run.removed_mm3, s.seconds, s.mean_N, run.max_N);
    const auto severed = std::ranges::count_if(run.severances, &training::Severance::severed);
    if (run.severances.size() > 1)
        text += fmt::format("{} of {} cuts go through the bone\n", severed, run.severances.size());
    else if (severed > 0) text += "the bone is sawn through\n";
    if (s.rms_mm && s.max_mm)
        text += fmt::format("cut {:.2f} mm rms from the plan, {:.2f} mm at most\n", *s.rms_mm, *s.max_mm);
    text += fmt::format("cut too much: {:.1f} mm³; too little: {:.1f} mm³\n", s.over_mm3, s.under_mm3);
    for (const analysis::SparedScore& spared : s.spared)
        text += spared.injured_mm3 > 0.0
                    ? fmt::format("{}: injured, {:.1f} mm³\n", spared.name, spared.injured_mm3)
                    : fmt::format("{}: spared, nearest {:.1f} mm\n", spared.name, spared.closest_mm);
    if (s.over_limit_Ns > 0.0) text += fmt::format("above the limit of force: {:.2f} N s\n", s.over_limit_Ns);
    if (s.shown_share && *s.shown_share < analysis::complete_share)
        text += fmt::format(
            "the bone was felt in only {:.0f} % of the time of contact, as forces were away: do not "
            "compare this attempt with others\n",
            std::floor(100.0 * *s.shown_share));
    return text + "the scores are not validated";
}

}  // namespace

std::string score_of(const std::filesystem::path& folder) {
    try {
        return score_words(analysis::score_run(folder));
    } catch (const std::exception& error) {
        return std::string("no score: ") + error.what();
    }
}

}  // namespace tactus::window
