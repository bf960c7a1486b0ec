// SPDX-License-Identifier: Apache-2.0
// Statistics of a sweep's values over its axes, for figures.
#pragma once

#include "assets/sweep/sweep_file.hpp"
#include "tools/analysis/sweep/results.hpp"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// All rows with the same levels of the figure's axes.
struct FigureCell {
    std::size_t x = 0, y = 0, series = 0, panel = 0;  ///< indices of levels; 0 for an axis that the figure lacks
    std::size_t column = 0;  ///< index of FigureChoice::values
    std::size_t count = 0;
    double value = 0.0;
    /// 95 %. None from too few rows: a mean needs two, a median six (the extremes of five contain it in 93.75 % of cases).
    std::optional<std::pair<double, double>> interval;
};

struct FigureData {
    sweep::FigureChoice choice;
    const sweep::Axis *x = nullptr, *y = nullptr, *series = nullptr, *panel = nullptr;
    std::vector<FigureCell> cells;  ///< by panel, series, column, y and x; only those with rows
    std::size_t left_out = 0;  ///< values that are no number, or of rows with 'unless'

    /// Lines of a panel: levels of the series, or columns.
    std::size_t line_count() const { return series ? series->levels.size() : choice.values.size(); }
    static std::size_t line_of(const FigureCell& cell) { return cell.series + cell.column; }
};

/// 95 % interval of the median of sorted values, of order statistics (binomial, free of a distribution); nothing below six.
std::optional<std::pair<double, double>> median_interval(const std::vector<double>& sorted);

/// Mean: t interval. Median: median_interval(). Fraction: Wilson interval. A difference of two columns is
/// taken within each row, which pairs it by all that the two share; of two fractions: Newcombe's interval. Throws Error
/// for a figure that does not fit the sweep (figure_problem), for an axis of a design, whose levels all differ, and for a value that is a text.
FigureData figure_data(const Results& results, const sweep::FigureChoice& choice);

}  // namespace tactus::analysis
