// SPDX-License-Identifier: Apache-2.0
// Options of the verbs that report a result, and its output: text or JSON on standard output, and files by their ending.
#pragma once

#include "tools/command/figure_options.hpp"
#include "tools/report/result/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::command {

struct ResultChoice {
    std::vector<std::filesystem::path> out;
    bool quiet = false;
    FigureChoice figure;
};

/// -o, --quiet, --dpi.
void add_result_options(VerbOptions& verb, ResultChoice& choice);

/// Throws Error for a file whose ending no format has, and for a figure if the verb draws none; call before the analysis.
void check_result_files(const ResultChoice& choice, bool has_figure);

/// Writes the files; then prints the result, unless quiet. `json`: as JSON. Throws Error if a file cannot be written.
void write_result(const report::Result& result, const ResultChoice& choice, bool json);

}  // namespace tactus::command
