// SPDX-License-Identifier: Apache-2.0
// Comparisons as text, JSON and CSV.
#pragma once

#include "tools/analysis/vibration/comparison.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tactus::command {

/// How many comparisons passed, failed, or could not be made.
struct VerdictCounts {
    std::size_t passed = 0, failed = 0, bad = 0;
};

std::string comparison_json(const analysis::ComparedPair& pair);
/// Prints on standard output.
void print(const analysis::ComparedPair& pair);

/// The quantity of the threshold of touch, by name.
signal::ThresholdUnit touch_of(const std::string& name);

// One row per pair. `failures`: the error of each pair, empty for success; may be empty altogether. A failed pair has
// its two names only.

/// A text table with a heading.
std::string comparison_rows(std::span<const analysis::ComparedPair> pairs, const std::vector<std::string>& failures);
/// A CSV table.
std::string comparison_table(std::span<const analysis::ComparedPair> pairs, const std::vector<std::string>& failures);

}  // namespace tactus::command
