// SPDX-License-Identifier: Apache-2.0
#include "tools/window/training/score_card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

namespace tactus::window {

namespace {

constexpr double mm = 1e3;
using Better = ScoreRow::Better;

void add_warnings(ScoreCard& card, const analysis::ScoredRun& run) {
    using training::Warning;
    const auto applies = [&](Warning warning) {
        const training::TaskLimits& limits = run.task.limits;
        switch (warning) {
            case Warning::too_near: return !run.task.spared.empty();
            case Warning::over_force: return limits.force.has_value();
            case Warning::over_time: return limits.time.has_value();
            case Warning::over_heat: return limits.heat.has_value();
            default: return true;
        }
    };
    for (std::size_t w = 0; w < training::warning_count; ++w) {
        if (!applies(static_cast<Warning>(w))) continue;
        const double seconds = run.score.warnings_s[w];
        card.rows.push_back({fmt::format("! {}", training::warning_words[w]), "s", seconds, std::nullopt, Better::less,
                             seconds > 0.0 ? "" : "never", seconds > 0.0});
    }
}

}  // namespace

bool ScoreRow::is_close() const {
    if (!limit || is_bad) return false;
    return better == Better::more ? value < 1.2 * *limit : value > 0.8 * *limit;
}

const ScoreRow* ScoreCard::row(const std::string& name) const {
    const auto found = std::ranges::find(rows, name, &ScoreRow::name);
    return found == rows.end() ? nullptr : &*found;
}

ScoreCard card_of(const analysis::ScoredRun& run) {
    const analysis::Score& s = run.score;
    const training::TaskLimits& limits = run.task.limits;
    ScoreCard card;
    card.task = fmt::format("{:016x}", run.task.hash);
    const auto add = [&](const std::string& name, const char* unit, double value,
                         std::optional<double> limit = std::nullopt, Better better = Better::less) {
        card.rows.push_back({name, unit, value, limit, better, {}, limit && value > *limit});
    };
    add("time", "s", s.seconds, limits.time);
    add("force on the hand", "N", run.max_N * s.device_scale, limits.force);
    if (s.device_scale != 1.0) add("force of the blade", "N", run.max_N, std::nullopt, Better::neither);
    if (s.heat_s) add("heat", "s", *s.heat_s, limits.heat);
    const std::vector<training::PlannedCut>& cuts = run.task.cuts;
    for (std::size_t n = 0; n < std::min(cuts.size(), s.cuts.size()); ++n)
        if (s.cuts[n].max_mm)
            add(cuts.size() == 1 ? "from the plan" : fmt::format("from the plan, cut {}", cuts[n].name), "mm",
                *s.cuts[n].max_mm, mm * cuts[n].tolerance);
    add("cut too much", "mm³", s.over_mm3);
    add("cut too little", "mm³", s.under_mm3);
    for (std::size_t i = 0; i < s.spared.size(); ++i) {
        const analysis::SparedScore& spared = s.spared[i];
        const double margin = i < run.task.spared.size() ? mm * run.task.spared[i].margin : 0.0;
        ScoreRow row{spared.name, "mm", spared.closest_mm, margin, Better::more, {}, spared.closest_mm < margin};
        if (spared.injured_mm3 > 0.0) {
            row.note = fmt::format("injured, {:.1f} mm³", spared.injured_mm3);
            row.is_bad = true;
        }
        card.rows.push_back(std::move(row));
    }
    add_warnings(card, run);
    const auto severed = std::ranges::count_if(run.severances, &training::Severance::severed);
    if (run.severances.size() > 1)
        card.notes.push_back(fmt::format("{} of {} cuts go through the bone", severed, run.severances.size()));
    else if (severed > 0) card.notes.push_back("the bone is sawn through");
    if (s.shown_share && *s.shown_share < analysis::complete_share)
        card.notes.push_back(
            fmt::format("forces were rendered for only {:.0f} % of the contact time: do not compare this attempt with "
                        "others",
                        std::floor(100.0 * *s.shown_share)));
    card.notes.push_back("the scores are not validated");
    return card;
}

ScoreCard score_of(const std::filesystem::path& folder) {
    try {
        return card_of(analysis::score_run(folder));
    } catch (const std::exception& error) {
        ScoreCard card;
        card.problem = std::string("no score: ") + error.what();
        return card;
    }
}

const ScoreRow* best_of(std::span<const ScoreCard> attempts, const ScoreCard& card, const ScoreRow& row) {
    const ScoreRow* best = nullptr;
    if (row.better == Better::neither) return best;
    for (const ScoreCard& attempt : attempts) {
        if (attempt.task != card.task) continue;
        const ScoreRow* other = attempt.row(row.name);
        if (!other) continue;
        const bool is_better =
            !best || (row.better == Better::less ? other->value < best->value : other->value > best->value);
        if (is_better) best = other;
    }
    return best;
}

std::string value_text(const ScoreRow& row) {
    return fmt::format("{:.{}f} {}", row.value, std::abs(row.value) < 100.0 ? 1 : 0, row.unit);
}

std::string value_beside_limit(const ScoreRow& row) {
    if (!row.limit) return value_text(row);
    if (row.better == ScoreRow::Better::more) return fmt::format("{}, at least {:.3g}", value_text(row), *row.limit);
    return fmt::format("{:.1f} of {:.3g} {}", row.value, *row.limit, row.unit);
}

}  // namespace tactus::window
