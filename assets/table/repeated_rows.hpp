// SPDX-License-Identifier: Apache-2.0
// Rows of a log that state the row before them once more, as loggers write them that send a packet twice.
#pragma once

#include "assets/table/sample_log.hpp"

#include <cstddef>

namespace tactus::table {

/// Leaves out the rows whose time and chosen values are those of the row before. They are no samples: taken as such they
/// make the clock of the log too fast. A clock coarser than the samples has equal times as well, with values that differ;
/// and a signal at rest, or one of few levels, has equal values at different times. Rows are therefore left out only if 95 %
/// of the equal times have equal values, and at most 10 % of the different times. Returns the number of rows left out.
std::size_t leave_out_repeated_rows(SampleLog& log);

}  // namespace tactus::table
