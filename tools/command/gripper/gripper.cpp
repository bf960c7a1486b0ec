// SPDX-License-Identifier: Apache-2.0
// tactus gripper: measures how faithfully a gripper renders objects on the test rig.
#include "assets/table/csv_file.hpp"
#include "tools/analysis/gripper/rig_series.hpp"
#include "tools/analysis/gripper/rig_study.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/rig_figures.hpp"
#include "tools/report/gripper/rig_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct RigChoice {
    run::PatchChoice patch;  // or a CSV record of a rig
    std::filesystem::path matrix, out;
    int threads = 0;           // 0: one per core
    FigureChoice figure;
    bool keep_series = false;  // write the samples to series.csv
    bool json = false, quiet = false;
};

analysis::RigReport simulate(const RigChoice& choice, const analysis::RigMatrix& matrix) {
    Progress shown(choice.quiet);
    std::string series;
    const auto keep = [&](const analysis::RigCell& cell, const control::RigSeries& measured) {
        if (choice.keep_series) series += analysis::rig_series_csv(cell, measured, series.empty());
    };
    const auto progress = [&](int done_cells, int of) {
        shown.show(static_cast<double>(done_cells) / of, fmt::format("{} of {} cells", done_cells, of));
    };
    analysis::RigReport report =
        analysis::study_rig(choice.patch, matrix, analysis::on_threads(choice.threads), progress, keep);
    shown.clear();
    if (choice.keep_series) table::save_csv(choice.out / "series.csv", series);
    report.title = "Test rig: " + choice.patch.patch;
    report.source =
        fmt::format("{} motors, {} objects, {} rates and {} amplitudes on simulated grippers.", matrix.motors.size(),
                    matrix.objects.size(), matrix.rates.size(), matrix.amplitudes.size());
    return report;
}

analysis::RigReport recorded(const RigChoice& choice) {
    std::vector<std::string> notes;
    analysis::RigReport report = analysis::study_rig_series(analysis::load_rig_series(choice.patch.patch, notes));
    report.title = "Test rig: " + std::filesystem::path(choice.patch.patch).filename().string();
    report.source = fmt::format("{} measured records.", report.rows.size());
    report.notes = std::move(notes);
    return report;
}

int judge(const RigChoice& choice) {
    const bool is_record = choice.patch.patch.ends_with(".csv");
    if (is_record && !choice.matrix.empty()) throw Error("a record contains its own conditions; leave out --matrix");
    analysis::RigMatrix matrix;
    if (!choice.matrix.empty()) matrix = analysis::load_rig_matrix(choice.matrix);
    run::make_output_folder(choice.out);
    analysis::RigReport report;
    if (is_record) report = recorded(choice);
    else report = simulate(choice, matrix);
    const report::Result result = report::rig_fields().of(report);
    table::save_csv(choice.out / "rig.csv", report::rig_table(report));
    save_figure(report::draw_rig_errors(report), choice.out / "errors.png", choice.figure);
    if (!report.crossover.empty())
        save_figure(report::draw_rig_crossover(report), choice.out / "crossover.png", choice.figure);
    ResultChoice printed;
    printed.out = {choice.out / "rig.json", choice.out / "report.html", choice.out / "report.pdf"};
    printed.quiet = choice.quiet;
    printed.json = choice.json;
    write_result(result, printed);
    return done;
}

Action declare_gripper(VerbOptions& verb) {
    const auto choice = std::make_shared<RigChoice>();
    add_patch_options(verb, choice->patch);
    verb.find("patch").about("patch with a gripper on a test rig, such as gripper-wqsm, or a CSV record of a real one");
    verb.add("--matrix", choice->matrix, "TOML file with the test matrix (default: the matrix of Olsson 2015)");
    verb.output("-o,--out", choice->out, OutputFormat::folder(),
                "folder for report.html, report.pdf, rig.json, rig.csv and the figures")
        .required();
    verb.add("--jobs", choice->threads, "cells at a time, 0: one per core").range(0, 64);
    verb.old("--threads", "--jobs");
    verb.flag("--series", choice->keep_series,
              "also write all samples to series.csv, a record that this verb can read");
    add_figure_options(verb, choice->figure);
    verb.flag("--json", choice->json, "print the result as JSON");
    verb.flag("--quiet", choice->quiet, "print no result, only errors");
    return [choice] { return judge(*choice); };
}

}  // namespace

Verb gripper_verb() {
    return {.name = "gripper",
            .about =
                "measure how faithfully a gripper renders objects: motors, objects, rates and amplitudes on a test rig",
            .add = declare_gripper,
            .old_name = "rig",
            .schema = [] { return report::schema_of_output({report::rig_fields().schema()}); }};
}

}  // namespace tactus::command
