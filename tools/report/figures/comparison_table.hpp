// SPDX-License-Identifier: Apache-2.0
// Many comparisons as an HTML table, one row each.
#pragma once

#include "tools/analysis/vibration/comparison.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::report {

/// `failures`: the error of each pair, empty for success; may be empty altogether. A failed pair has its two names
/// only.
std::string comparison_summary(std::span<const analysis::ComparedPair> pairs, const std::vector<std::string>& failures);

/// Heading and cells of one pair in an HTML table: verdict, spectral distance, cosine, worst order, worst band, level,
/// failed scores. `failure`: why the pair could not be compared, or empty.
extern const std::string score_heading;
std::string score_cells(const analysis::ComparedPair& pair, const std::string& failure);

}  // namespace tactus::report
