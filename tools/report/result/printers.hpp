// SPDX-License-Identifier: Apache-2.0
// Results as text, JSON, HTML, PDF, CSV.
#pragma once

#include "assets/file/json.hpp"
#include "tools/report/blocks/report_block.hpp"
#include "tools/report/result/result.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::report {

inline constexpr int result_version = 1;

/// Text of a terminal: title, warnings, values, tables, children.
std::string text_of(const Result& result);

/// The values with a key. Pictures have none.
file::Json json_of(const Result& result);

/// The same as the output of a verb: with its version.
file::Json output_json(const Result& result);

/// The title of a page: its own, that of its only section, or the number of its sections.
std::string title_of(const Result& result);

/// Blocks of a page, for HTML and PDF.
std::vector<ReportBlock> blocks_of(const Result& result);

/// A self-contained HTML file.
std::string html_of(const Result& result);

/// CSV with the columns path, value and unit, a row for each value: "channels.0.orders.2.rms,0.0123,m/s^2".
std::string csv_of(const Result& result);

/// CSV with these columns, a line for each row; cells of members that a row does not have are empty.
std::string csv_table(const std::vector<std::string>& columns, const std::vector<file::Json>& rows);

/// The JSON Schema of the output of a verb, which has one of these kinds of results.
file::Json schema_of_output(std::vector<file::Json> kinds);

}  // namespace tactus::report
