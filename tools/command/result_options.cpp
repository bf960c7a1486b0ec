// SPDX-License-Identifier: Apache-2.0
#include "tools/command/result_options.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/report/blocks/pages.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::command {

namespace {

const report::ResultEntry::Picture* first_picture(const report::Result& result) {
    for (const report::ResultEntry& entry : result.entries) {
        if (const auto* picture = std::get_if<report::ResultEntry::Picture>(&entry.value)) return picture;
        if (const auto* children = std::get_if<report::ResultEntry::Children>(&entry.value))
            for (const report::Result& one : children->results)
                if (const auto* picture = first_picture(one)) return picture;
    }
    return nullptr;
}

void write_file(const report::Result& result, const std::filesystem::path& out, const FigureChoice& figure) {
    const std::string ending = out.extension().string();
    if (ending == ".txt") file::write_whole_file(out, report::text_of(result));
    else if (ending == ".json") file::write_whole_file(out, report::output_json(result).dump(2) + "\n");
    else if (ending == ".csv") file::write_whole_file(out, report::csv_of(result));
    else if (ending == ".html") file::write_whole_file(out, report::html_of(result));
    else if (ending == ".pdf") {
        const report::Pdf pdf = report::pdf_of(report::title_of(result), report::blocks_of(result));
        file::write_whole_file(out, pdf.bytes);
        if (!pdf.warning.empty()) say(stderr, fmt::format("warning: {}: {}\n", out.string(), pdf.warning));
    } else if (const auto* picture = first_picture(result)) {
        save_figure(picture->draw(), out, figure);
    } else {
        throw Error(out.string() + ": there is no figure of this result");
    }
}

}  // namespace

void add_result_options(VerbOptions& verb, ResultChoice& choice) {
    verb.add("-o,--out", choice.out,
             "file for the result, by its ending: .txt, .json, .csv, .html or .pdf, or .svg or .png of its figure; "
             "repeatable")
        .one_each();
    verb.flag("--quiet", choice.quiet, "print no result, only errors; for -o");
    add_figure_options(verb, choice.figure);
}

void check_result_files(const ResultChoice& choice, bool has_figure) {
    constexpr std::array texts{".txt", ".json", ".csv", ".html", ".pdf"};
    for (const std::filesystem::path& out : choice.out) {
        const std::string ending = out.extension().string();
        const bool is_image = ending == ".svg" || ending == ".png";
        if (is_image && !has_figure)
            throw Error(fmt::format("{}: this result has no figure; write it as .txt, .json, .csv, .html or .pdf",
                                    out.string()));
        if (!is_image && std::ranges::find(texts, ending) == texts.end())
            throw Error(fmt::format("{}: a result is written as .txt, .json, .csv, .html, .pdf{}", out.string(),
                                    has_figure ? ", .svg or .png" : ""));
    }
}

void write_result(const report::Result& result, const ResultChoice& choice, bool json) {
    for (const std::filesystem::path& out : choice.out) write_file(result, out, choice.figure);
    if (choice.quiet) return;
    say(stdout, json ? report::output_json(result).dump(2) + "\n" : report::text_of(result));
}

}  // namespace tactus::command
