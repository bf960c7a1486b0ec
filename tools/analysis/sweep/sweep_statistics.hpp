// SPDX-License-Identifier: Apache-2.0
// Statistics of a sweep's values over its axes, for figures.
#pragma once

#include "assets/sweep/sweep_file.hpp"
#include "tools/analysis/sweep/results.hpp"

#include <cstddef>
#include <vector>

namespace tactus::analysis {

/// All rows with the same levels of the figure's axes.
struct FigureCell {
    std::size_t x = 0, y = 0, series = 0, panel = 0;  ///< indices of levels; 0 for an axis that the figure lacks
    std::size_t count = 0;
    double value = 0.0;
    double low = 0.0, high = 0.0;  ///< 95 %; equal to the value for fewer than two rows
};

struct FigureData {
    sweep::FigureChoice choice;
    const sweep::Axis *x = nullptr, *y = nullptr, *series = nullptr, *panel = nullptr;
    std::vector<FigureCell> cells;  ///< by panel, series, y and x; only those with rows
    std::size_t left_out = 0;       ///< rows without a number, or with 'unless'
};

/// Mean: t interval. Median: interval of order statistics (binomial). Fraction: Wilson interval. A difference of two
/// columns is taken within each row, which pairs it by all that the two share. Throws Error for an axis of a design,
/// whose levels all differ, and for a value that is a text.
FigureData figure_data(const Results& results, const sweep::FigureChoice& choice);

}  // namespace tactus::analysis
