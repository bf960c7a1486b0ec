// SPDX-License-Identifier: Apache-2.0
#include "assets/file/whole_file.hpp"
#include "devices/display/png.hpp"
#include "tools/command/batch.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/picture/report/rig_figures.hpp"
#include "tools/study/grippers/rig_series.hpp"
#include "tools/study/grippers/rig_study.hpp"
#include "tools/command/terminal.hpp"
#include "tools/study/workers.hpp"

#include <fmt/format.h>

namespace tactus {

namespace {

RigReport simulate(const RigChoice& choice, const RigMatrix& matrix) {
    LiveLine line;
    std::string series;
    const auto keep = [&](const RigCell& cell, const RigSeries& measured) {
        if (choice.keep_series) series += rig_series_csv(cell, measured, series.empty());
    };
    const auto progress = [&](int done_cells, int of) {
        line.show(progress_bar(static_cast<std::size_t>(done_cells), static_cast<std::size_t>(of), "cells"));
    };
    RigReport report = study_rig(choice, matrix, on_threads(choice.threads), progress, keep);
    line.clear();
    if (choice.keep_series) write_whole_file(choice.out / "series.csv", series);
    report.title = "Test rig: " + choice.patch;
    report.source =
        fmt::format("{} motors, {} objects, {} rates and {} amplitudes on simulated grippers.", matrix.motors.size(),
                    matrix.objects.size(), matrix.rates.size(), matrix.amplitudes.size());
    return report;
}

RigReport recorded(const RigChoice& choice) {
    std::vector<std::string> notes;
    RigReport report = study_rig_series(load_rig_series(choice.patch, notes));
    report.title = "Test rig: " + std::filesystem::path(choice.patch).filename().string();
    report.source = fmt::format("{} records as they were measured.", report.rows.size());
    report.notes = std::move(notes);
    return report;
}

}  // namespace

int rig_verb(const RigChoice& choice) {
    const bool is_record = choice.patch.ends_with(".csv");
    if (is_record && !choice.matrix.empty()) throw Error("a record says itself what was tried; leave --matrix out");
    RigMatrix matrix;
    if (!choice.matrix.empty()) matrix = load_rig_matrix(choice.matrix);
    make_output_folder(choice.out);
    RigReport report;
    if (is_record) report = recorded(choice);
    else report = simulate(choice, matrix);
    const std::string json = rig_json(report);
    write_whole_file(choice.out / "rig.json", json);
    write_whole_file(choice.out / "rig.csv", rig_csv(report));
    write_whole_file(choice.out / "report.html", rig_html(report));
    write_png(draw_rig_errors(report).image(), (choice.out / "errors.png").string());
    if (!report.crossover.empty())
        write_png(draw_rig_crossover(report).image(), (choice.out / "crossover.png").string());
    fmt::print("{}", choice.json ? json : rig_text(report));
    return done;
}

}  // namespace tactus
