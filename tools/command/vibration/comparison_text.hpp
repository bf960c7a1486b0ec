// SPDX-License-Identifier: Apache-2.0
// Comparisons as text, JSON and CSV.
#pragma once

#include "tools/study/vibration/comparison.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::command {

std::string comparison_json(const study::ComparedPair& pair);
/// On standard output.
void print(const study::ComparedPair& pair);

/// What the threshold of touch is a threshold of, by its name.
signal::ThresholdUnit touch_of(const std::string& name);

// A row for each of many. `failures`: what went wrong with each pair, empty where nothing did; none at all when nothing
// did anywhere. A pair that failed has its two names only.

/// For people, with a heading.
std::string comparison_rows(std::span<const study::ComparedPair> pairs, const std::vector<std::string>& failures);
/// CSV.
std::string comparison_table(std::span<const study::ComparedPair> pairs, const std::vector<std::string>& failures);

}  // namespace tactus::command
