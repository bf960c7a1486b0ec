// SPDX-License-Identifier: Apache-2.0
#include "tools/command/result_options.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/outputs.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/report/blocks/pages.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace tactus::command {

namespace {

/// The first picture that can be drawn: a figure without data has no function to draw it.
const report::ResultEntry::Picture* first_picture(const report::Result& result) {
    for (const report::ResultEntry& entry : result.entries) {
        if (const auto* picture = std::get_if<report::ResultEntry::Picture>(&entry.value); picture && picture->draw)
            return picture;
        if (const auto* children = std::get_if<report::ResultEntry::Children>(&entry.value))
            for (const report::Result& one : children->results)
                if (const auto* picture = first_picture(one)) return picture;
    }
    return nullptr;
}

void write_file(const report::Result& result, const std::filesystem::path& out, const ResultChoice& choice) {
    const std::string ending = out.extension().string();
    if (choice.product.has(out)) return;
    if (ending == ".txt") file::write_whole_file(out, report::text_of(result));
    else if (ending == ".json") file::write_whole_file(out, report::output_json(result).dump(2) + "\n");
    else if (ending == ".csv") table::save_csv(out, report::csv_of(result));
    else if (ending == ".html") file::write_whole_file(out, report::html_of(result));
    else if (ending == ".pdf") {
        const report::Pdf pdf = report::pdf_of(report::title_of(result), report::blocks_of(result));
        file::write_whole_file(out, pdf.bytes);
        if (!pdf.warning.empty()) say(stderr, fmt::format("warning: {}: {}\n", out.string(), pdf.warning));
    } else if (const auto* picture = first_picture(result)) {
        save_figure(picture->draw(choice.figure.figure_style()), out, choice.figure);
    } else {
        throw Error(out.string() + ": there is no figure of this result");
    }
}

/// ".txt, .json, .csv, .html or .pdf" of the formats of a result.
std::string endings_of(const ResultChoice& choice) {
    std::vector<std::string> all = choice.formats;
    std::erase_if(all, [&](const std::string& ending) { return choice.product.has("x" + ending); });
    const std::string last = all.back();
    all.pop_back();
    return fmt::format("{} or {}", fmt::join(all, ", "), last);
}

/// Of the product first, which is why the verb was called.
std::vector<std::string> all_endings(const ResultChoice& choice) {
    std::vector<std::string> all = choice.product.endings;
    for (const std::string& ending : choice.formats)
        if (std::ranges::find(all, ending) == all.end()) all.push_back(ending);
    if (choice.has_figure != ResultFigure::none) all.insert(all.end(), {".svg", ".png"});
    return all;
}

}  // namespace

Option add_result_options(VerbOptions& verb, ResultChoice& choice, ResultFigure figure, Product product) {
    choice.product = std::move(product);
    choice.has_figure = figure;
    const bool has_figure = figure != ResultFigure::none;
    std::string about = fmt::format("file for the result, by its ending: {}", endings_of(choice));
    if (has_figure) about += ", or .svg or .png of its figure";
    if (!choice.product.endings.empty())
        about += fmt::format("; {}: {}", fmt::join(choice.product.endings, ", "), choice.product.about);
    const Option out = verb.output("-o,--out", choice.out, {all_endings(choice)}, about + "; repeatable").one_each();
    verb.flag("--json", choice.json, "as JSON");
    verb.flag("--quiet", choice.quiet, "print no result, only errors; for -o");
    if (has_figure)
        add_figure_options(verb, choice.figure,
                           figure == ResultFigure::styled ? FigureStyles::all : FigureStyles::screen);
    return out;
}

bool Product::has(const std::filesystem::path& file) const {
    return std::ranges::any_of(endings,
                               [&](const std::string& ending) { return file.filename().string().ends_with(ending); });
}

std::vector<std::filesystem::path> ResultChoice::products() const {
    std::vector<std::filesystem::path> all;
    for (const std::filesystem::path& path : out)
        if (product.has(path)) all.push_back(path);
    return all;
}

bool ResultChoice::shows_figures() const {
    return std::ranges::any_of(out, [](const std::filesystem::path& path) {
        return path.extension() == ".html" || report::is_figure_file(path);
    });
}

bool is_result_file(const std::filesystem::path& path) {
    const std::vector<std::string> formats = ResultChoice().formats;
    return report::is_figure_file(path) || std::ranges::find(formats, path.extension().string()) != formats.end();
}

void check_result_files(const ResultChoice& choice, const std::vector<std::filesystem::path>& sources,
                        const std::vector<std::filesystem::path>& others) {
    std::vector<std::filesystem::path> files, outputs = choice.out;
    for (const std::filesystem::path& source : sources) files.push_back(bone::file_of_bone(source));
    outputs.insert(outputs.end(), others.begin(), others.end());
    file::check_outputs(files, outputs);
    if (choice.has_figure != ResultFigure::none) return;
    for (const std::filesystem::path& out : choice.out)
        if (const std::string ending = out.extension().string();
            (ending == ".svg" || ending == ".png") && !choice.product.has(out))
            throw Error(fmt::format("{}: this result has no figure; write it as {}", out.string(), endings_of(choice)));
}

void draw_pictures(report::Result& result, const ResultChoice& choice) {
    try {
        report::settle_pictures(result, choice.shows_figures());
    } catch (const Error& error) {
        throw Error(fmt::format("the pictures cannot be made: {}", error.what()));
    }
}

void write_files(const report::Result& result, const ResultChoice& choice) {
    for (const std::filesystem::path& out : choice.out) write_file(result, out, choice);
}

void write_result(const report::Result& result, const ResultChoice& choice) {
    write_files(result, choice);
    if (choice.quiet) return;
    say(stdout, choice.json ? report::output_json(result).dump(2) + "\n" : report::text_of(result));
}

}  // namespace tactus::command
