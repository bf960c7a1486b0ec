// SPDX-License-Identifier: Apache-2.0
// A comparison as an HTML page: verdict, figure, tables and methods.
#pragma once

#include "tools/analysis/vibration/comparison.hpp"

#include <string>

namespace tactus::report {

/// A complete page.
std::string comparison_page(const analysis::ComparedPair& pair);

/// Its parts, for pages with several comparisons: figure and tables; methods.
std::string comparison_section(const analysis::ComparedPair& pair, const std::string& mark);
std::string comparison_method(const analysis::ComparedPair& pair);

}  // namespace tactus::report
