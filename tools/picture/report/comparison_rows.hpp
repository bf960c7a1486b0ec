// SPDX-License-Identifier: Apache-2.0
// Many comparisons, a row each.
#pragma once

#include "tools/study/vibration/comparison.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus {

// `failures`: what went wrong with each pair, empty where nothing did; none at all when nothing did anywhere. A pair
// that failed has its two names only.

/// What tells the pairs apart: the output, or the reference when all share one output.
std::string pair_name(const ComparedPair& pair, std::span<const ComparedPair> all);

/// For people, with a heading.
std::string comparison_rows(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures);
/// CSV.
std::string comparison_table(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures);
/// HTML.
std::string comparison_summary(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures);

/// The heading of, and the cells of one pair in an HTML table: verdict, spectral distance, cosine, worst order, worst
/// band, level, what it fails by. `failure`: why there is nothing to compare, or empty.
extern const std::string score_heading;
std::string score_cells(const ComparedPair& pair, const std::string& failure);

}  // namespace tactus
