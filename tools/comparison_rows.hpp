// SPDX-License-Identifier: Apache-2.0
// Many comparisons, a row each.
#pragma once

#include "tools/compared_pair.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus {

// `failures`: what went wrong with each pair, empty where nothing did; none at all when nothing did anywhere. A pair
// that failed has its two names only.

/// For people, with a heading.
std::string comparison_rows(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures);
/// CSV.
std::string comparison_table(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures);
/// HTML.
std::string comparison_summary(std::span<const ComparedPair> pairs, const std::vector<std::string>& failures);

}  // namespace tactus
