// SPDX-License-Identifier: Apache-2.0
// The score of an attempt as rows with limits, beside earlier attempts at the same task. No user interface.
#pragma once

#include "tools/analysis/training/score.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::window {

struct ScoreRow {
    std::string name, unit;
    double value = 0.0;
    std::optional<double> limit;
    enum class Better { less, more, neither } better = Better::less;
    std::string note;  ///< "injured, 2.1 mm³"
    bool is_bad = false;  ///< beyond its limit

    /// Within a fifth of its limit.
    bool is_close() const;
};

struct ScoreCard {
    std::string task;     ///< hash of the task: only attempts at the same one are compared
    std::string problem;  ///< why there is no score; empty: there is one
    std::vector<ScoreRow> rows;
    std::vector<std::string> notes;

    const ScoreRow* row(const std::string& name) const;
};

ScoreCard card_of(const analysis::ScoredRun& run);
/// Scores the results in a folder. Never throws: a card says why it has no score.
ScoreCard score_of(const std::filesystem::path& folder);

/// The row of the best of some attempts at the task of a card; null: there is none, or the row has no better side.
const ScoreRow* best_of(std::span<const ScoreCard> attempts, const ScoreCard& card, const ScoreRow& row);

/// "2.3 s", "8 mm³".
std::string value_text(const ScoreRow& row);
/// "8.2 of 10 N"; "1.3 mm, at least 1" where more is better; without a limit as value_text().
std::string value_beside_limit(const ScoreRow& row);

}  // namespace tactus::window
