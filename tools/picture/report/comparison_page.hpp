// SPDX-License-Identifier: Apache-2.0
// A comparison as an HTML page: verdict, figure, tables and methods.
#pragma once

#include "tools/study/vibration/comparison.hpp"

#include <string>

namespace tactus::picture {

/// A complete page.
std::string comparison_page(const study::ComparedPair& pair);

/// Its parts, for pages with several comparisons: figure and tables; methods.
std::string comparison_section(const study::ComparedPair& pair, const std::string& mark);
std::string comparison_method(const study::ComparedPair& pair);

}  // namespace tactus::picture
