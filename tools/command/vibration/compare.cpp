// SPDX-License-Identifier: Apache-2.0
// tactus compare: judges whether two vibration records are equivalent, for two files or for folders.
#include "assets/file/json.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/stretch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/comparison_figure.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/comparison_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;
using analysis::ComparedPair;

struct CompareChoice {
    analysis::CompareSettings settings;
    fs::path thresholds;
    fs::path plot, table;                            // a figure, .csv
    ResultChoice result;
    std::string touch = "displacement", axes = "strongest";
    std::string time_column, column;                 // of CSV logs, for both files or for each: REFERENCE,OUTPUT
    std::string where;                               // rows of CSV logs
    std::string time_unit, band;                     // band: LOW:HIGH in Hz, of figures
    StretchChoice stretch;
    std::optional<int> skip_rows;
    std::optional<double> rate;                      // Hz, of logs without times
    int jobs = 0;                                    // pairs at a time, 0: one per core
};

/// One column name is for both files; of two, the first is for the reference and the second for the output.
table::LogSelection selection_for(const CompareChoice& choice, std::size_t file) {
    table::LogSelection selection;
    selection.time_column = choice.time_column;
    if (!choice.column.empty()) selection.columns = {choice.column};
    selection.list_entry = file;
    selection.time_unit = choice.time_unit;
    selection.where = choice.where;
    selection.skip_rows = choice.skip_rows;
    selection.rate = choice.rate;
    return selection;
}

/// Prints and writes; returns the exit code.
int finish(const CompareChoice& choice, const report::ComparedPairs& found) {
    if (!choice.table.empty()) table::save_csv(choice.table, report::comparison_table(found));
    write_result(report::comparison_fields().of(found), choice.result);
    const report::VerdictCounts counts = found.counts();
    return counts.bad > 0 ? bad_input : counts.failed > 0 ? answer_is_no : done;
}

int compare_one(const CompareChoice& choice, const analysis::CompareSettings& settings) {
    const ComparedPair pair = analysis::compare_files(settings);
    if (!choice.plot.empty()) save_figure(report::draw_comparison(pair), choice.plot, choice.result.figure);
    const std::string no_error;
    return finish(choice, {{&pair, 1}, {&no_error, 1}});
}

int compare_many(const CompareChoice& choice, const analysis::CompareSettings& settings) {
    const std::vector<analysis::PairedFiles> names = analysis::paired_files(settings.reference, settings.output);
    std::vector<ComparedPair> pairs(names.size());
    const std::vector<std::string> failures = run_batch(
        names.size(), choice.jobs, "pairs",
        [&](std::size_t i, const std::function<void(double)>&) {
            pairs[i].reference = names[i].reference;
            pairs[i].output = names[i].output;
            if (names[i].reference.empty())
                throw Error(fmt::format("{}: there is no reference with this name in {}", names[i].output.string(),
                                        settings.reference.string()));
            if (names[i].output.empty())
                throw Error(fmt::format("{}: there is no output with this name in {}", names[i].reference.string(),
                                        settings.output.string()));
            analysis::CompareSettings one = settings;
            one.reference = names[i].reference;
            one.output = names[i].output;
            pairs[i] = analysis::compare_files(one);
            if (choice.plot.empty()) return;
            const fs::path varied = fs::is_directory(settings.output) ? one.output : one.reference;
            save_figure(report::draw_comparison(pairs[i]), choice.plot / (varied.filename().string() + ".svg"), {});
        },
        choice.result.quiet);
    tell_failures(failures);
    return finish(choice, {pairs, failures});
}

int compare(const CompareChoice& choice) {
    const bool many = fs::is_directory(choice.settings.reference) || fs::is_directory(choice.settings.output);
    check_batch_output(choice.plot, {".svg", ".png", ".pdf"}, many);
    // Before the check of -o, which may be in it.
    if (many && !choice.plot.empty()) fs::create_directories(choice.plot);
    check_result_files(choice.result, {choice.settings.reference, choice.settings.output, choice.thresholds});
    analysis::CompareSettings settings = choice.settings;
    if (!choice.thresholds.empty()) settings.thresholds = table::load_thresholds(choice.thresholds);
    settings.touch = analysis::touch_of(choice.touch);
    settings.axes = choice.axes == "vector" ? analysis::Axes::vector : analysis::Axes::strongest;
    settings.logs = {selection_for(choice, 0), selection_for(choice, 1)};
    settings.stretches = {stretch_of(choice.stretch, 0), stretch_of(choice.stretch, 1)};
    if (!choice.band.empty()) settings.plotted = parse_band(choice.band, "--band");
    settings.pictures = !choice.plot.empty() || choice.result.shows_figures();
    return many ? compare_many(choice, settings) : compare_one(choice, settings);
}

Action declare_compare(VerbOptions& verb) {
    const auto choice = std::make_shared<CompareChoice>();
    analysis::CompareSettings& settings = choice->settings;
    verb.add("reference", settings.reference, "sound file or CSV log of the reference vibration, or a folder")
        .required();
    verb.add("output", settings.output,
             "sound file or CSV log of the output vibration, or a folder: files are paired by name")
        .required();
    verb.add("--thresholds", choice->thresholds,
             "TOML file with the thresholds; keys and defaults: docs/reference/tables.md");
    verb.output("--plot", choice->plot, OutputFormat::file_or_folder({".svg", ".png", ".pdf"}),
                "a figure, .svg, .png or .pdf; for folders: a folder of SVG files");
    add_result_options(verb, choice->result, ResultFigure::some);
    verb.old("--report", "--out");
    verb.add("--band", choice->band,
             "plotted range, Hz (default: 20 Hz to half the sample rate of the slower record, at most 4 kHz); what is "
             "judged stays the same")
        .value_name("LOW:HIGH");
    verb.output("--table", choice->table, {{".csv"}}, "a row per pair, CSV");
    verb.add("--jobs", choice->jobs, "pairs at a time, 0: one per core").range(0, 256);
    verb.add("--reference-scale", settings.reference_scale, "units per full scale, such as m/s^2").shows_default();
    verb.add("--output-scale", settings.output_scale, "scale of the output, in the same unit").shows_default();
    verb.add("--channel", settings.channel, "channel of both files, from 1; 0: the mean of all").range(0, 1024);
    verb.add("--axes", choice->axes,
             "of several channels: the strongest of the reference and the same of the output, or vector: the root sum "
             "of squares of the spectra of all")
        .shows_default()
        .one_of({"strongest", "vector"});
    verb.add("--time-column", choice->time_column,
             "time column of CSV logs: name or number, for both files or for each as REFERENCE,OUTPUT");
    verb.add("--column", choice->column,
             "compared column of CSV logs: name or number, for both files or for each as REFERENCE,OUTPUT; a name that "
             "contains a comma is stated alone or in double quotes");
    verb.add("--time-unit", choice->time_unit, "unit of time in CSV logs: s, ms, us or ns")
        .one_of({"s", "ms", "us", "ns"});
    verb.add("--where", choice->where,
             "of CSV logs only the rows with this value, such as SENSOR=2, for tables with several sensors");
    verb.add("--skip-rows", choice->skip_rows, "lines before the header of CSV logs (default: found)")
        .range(0, 1 << 30);
    verb.add("--sample-rate,--rate", choice->rate, "rate of CSV logs without times, such as \"3.2 kHz\"")
        .unit("Hz")
        .range(1e-6, 1e9);
    add_stretch_options(verb, choice->stretch, StretchOf::both);
    verb.add("--actuator", settings.actuator, "report the level gap of this actuator at its limits; needs m/s^2");
    verb.add("--mass", settings.mass, "moving mass of the actuator, kg").unit("kg").shows_default();
    verb.add("--touch", choice->touch, "quantity of the threshold of touch")
        .shows_default()
        .one_of({"displacement", "acceleration", "none"});
    verb.add("--max-delay", settings.longest_delay,
             "greatest delay searched, s (default: any at which 1 s and a quarter of the shorter record overlap)")
        .unit("s")
        .range(0.001, 100.0);
    return [choice] { return compare(*choice); };
}

}  // namespace

Verb compare_verb() {
    return {.name = "compare",
            .about = "judge whether two vibrations are equivalent; exit code 0: yes, 1: no",
            .add = declare_compare,
            .schema = [] { return report::schema_of_output({report::comparison_fields().schema()}); }};
}

}  // namespace tactus::command
