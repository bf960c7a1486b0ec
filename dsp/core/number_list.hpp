// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dsp/core/error.hpp"

#include <string>
#include <vector>

namespace tactus {

/// "0 0, 1 2.5" → {{0, 0}, {1, 2.5}}: rows by commas, numbers by blanks. Throws Error at `where` for what is no finite
/// number.
std::vector<std::vector<double>> rows_of_numbers(const std::string& text, const SourceLocation& where);

}  // namespace tactus
