// SPDX-License-Identifier: Apache-2.0
// Options of the verbs that report a result, and its output: text or JSON on standard output, and files by their ending.
#pragma once

#include "tools/command/figure_options.hpp"
#include "tools/report/result/result.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::command {

/// A file that a verb makes besides its result: a measured response, a filter.
struct Product {
    std::vector<std::string> endings;  ///< {".toml"}; empty: the verb makes none
    std::string about;  ///< "the filter"

    bool has(const std::filesystem::path& file) const;
};

enum class ResultFigure { none, some, styled };  ///< styled: in all styles

struct ResultChoice {
    std::vector<std::filesystem::path> out;
    bool quiet = false, json = false;
    FigureChoice figure;
    Product product;
    /// Endings of the formats of the result itself; set before add_result_options by a verb that has fewer.
    std::vector<std::string> formats{".txt", ".json", ".csv", ".html", ".pdf"};
    ResultFigure has_figure = ResultFigure::none;

    /// The files for the product.
    std::vector<std::filesystem::path> products() const;
    /// Whether one of the files shows figures.
    bool shows_figures() const;
};

/// -o, --quiet, --json; of a verb with a figure also the options of figures.
Option add_result_options(VerbOptions& verb, ResultChoice& choice, ResultFigure figure, Product product = {});

/// Whether `path` has the ending of a format of results or figures.
bool is_result_file(const std::filesystem::path& path);

/// Throws Error for a figure if there is none in this case, and for what file::check_outputs refuses. `sources`: the files that the verb reads or changes, of bones with or without "#NAME"; `others`: files that it writes besides those of -o. Called
/// before anything is read or changed.
void check_result_files(const ResultChoice& choice, const std::vector<std::filesystem::path>& sources,
                        const std::vector<std::filesystem::path>& others = {});

/// Draws what the files show, so that nothing is written when that fails; what was analysed need not live any longer, if
/// the result has no series. Throws Error.
void draw_pictures(report::Result& result, const ResultChoice& choice);

/// Writes the files but the product. Throws Error if one cannot be written.
void write_files(const report::Result& result, const ResultChoice& choice);

/// Writes the files but the product; then prints the result, unless quiet. Throws Error if a file cannot be written.
void write_result(const report::Result& result, const ResultChoice& choice);

}  // namespace tactus::command
