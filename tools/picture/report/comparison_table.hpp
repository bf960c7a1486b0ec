// SPDX-License-Identifier: Apache-2.0
// Many comparisons as an HTML table, a row each.
#pragma once

#include "tools/study/vibration/comparison.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::picture {

/// `failures`: what went wrong with each pair, empty where nothing did; none at all when nothing did anywhere. A pair that
/// failed has its two names only.
std::string comparison_summary(std::span<const study::ComparedPair> pairs, const std::vector<std::string>& failures);

/// The heading of, and the cells of one pair in an HTML table: verdict, spectral distance, cosine, worst order, worst
/// band, level, what it fails by. `failure`: why there is nothing to compare, or empty.
extern const std::string score_heading;
std::string score_cells(const study::ComparedPair& pair, const std::string& failure);

}  // namespace tactus::picture
