// SPDX-License-Identifier: Apache-2.0
#include "tools/report/sweep/sweep_page.hpp"

#include "dsp/core/error.hpp"
#include "tools/counted.hpp"
#include "tools/report/figures/html_report.hpp"
#include "tools/report/sweep/sweep_figure.hpp"

#include <fmt/format.h>

#include <map>

namespace tactus::report {

namespace {

using html::escaped;

std::string failure_rows(const analysis::Results& results) {
    std::string out = "<h2>Failures</h2>\n<table><tr><th>reason</th><th class=\"n\">points</th><th>example</th></tr>\n";
    for (const analysis::Results::Failure& failure : results.failures())
        out += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td>point {}</td></tr>\n", escaped(failure.reason),
                           failure.count, failure.example + 1);
    return out + "</table>\n";
}

std::string level_cell(const sweep::Axis* axis, std::size_t level) {
    return axis ? fmt::format("<td>{}</td>", escaped(axis->levels[level].text)) : std::string();
}

std::string cell_rows(const analysis::FigureData& data) {
    std::string out = "<details><summary>numbers</summary><table><tr>";
    for (const sweep::Axis* axis : {data.panel, data.series, data.y, data.x})
        if (axis) out += fmt::format("<th>{}</th>", escaped(axis->name));
    if (data.choice.values.size() > 1) out += "<th>column</th>";
    out += "<th class=\"n\">n</th><th class=\"n\">value</th><th class=\"n\">95 %</th></tr>\n";
    for (const analysis::FigureCell& cell : data.cells)
        out += fmt::format(
            "<tr>{}{}{}{}{}<td class=\"n\">{}</td><td class=\"n\">{:.4g}</td><td class=\"n\">{}</td></tr>\n",
            level_cell(data.panel, cell.panel), level_cell(data.series, cell.series), level_cell(data.y, cell.y),
            level_cell(data.x, cell.x),
            data.choice.values.size() > 1 ? fmt::format("<td>{}</td>", escaped(data.choice.values[cell.column])) : "",
            cell.count, cell.value,
            cell.interval ? fmt::format("{:.4g} to {:.4g}", cell.interval->first, cell.interval->second) : "–");
    return out + "</table></details>\n";
}

std::string axis_rows(const sweep::Sweep& sweep) {
    std::string out = "<table><tr><th>axis</th><th class=\"n\">levels</th><th>first</th><th>last</th></tr>\n";
    for (const sweep::Axis& axis : sweep.axes)
        out += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td>{}</td><td>{}</td></tr>\n", escaped(axis.name),
                           axis.levels.size(), escaped(axis.levels.front().text), escaped(axis.levels.back().text));
    if (sweep.seeds.count > 1)
        out += fmt::format("<tr><td>seed</td><td class=\"n\">{}</td><td colspan=\"2\">{}</td></tr>\n",
                           sweep.seeds.count, sweep.seeds.is_independent ? "independent" : "the same at all levels");
    return out + "</table>\n";
}

std::string worker_rows(const analysis::Results& results) {
    struct Made {
        std::size_t points = 0;
        double seconds = 0.0, peak = 0.0;
    };
    std::map<std::string, Made> made;
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (results.state(i) == analysis::Results::State::unfinished) continue;
        const file::Json& worker = results.worker(i);
        const auto text = [&](const char* key) { return escaped(worker.value(key, std::string("unknown"))); };
        const sweep::Row row = results.row(i);
        // All elements of an array are one runner.
        const std::string runner = text("runner");
        Made& one = made[fmt::format("<td>{}</td><td>{}</td><td>{}, build {}</td><td>libc {}, {}, {}</td>",
                                     text("machine"), runner.substr(0, runner.find(' ')), text("version"),
                                     text("build"), text("libc"), text("vector"), text("cpu"))];
        ++one.points;
        one.seconds += row.seconds;
        one.peak = std::max(one.peak, row.peak);
    }
    std::string out =
        "<table><tr><th>machine</th><th>runner</th><th>program</th><th>libraries and processor</th><th "
        "class=\"n\">points</th><th class=\"n\">s per point</th><th class=\"n\">peak, MB</th></tr>\n";
    for (const auto& [cells, one] : made)
        out += fmt::format("<tr>{}<td class=\"n\">{}</td><td class=\"n\">{:.3g}</td><td class=\"n\">{:.0f}</td></tr>\n",
                           cells, one.points, one.seconds / static_cast<double>(one.points), one.peak * 1e-6);
    return out + "</table>\n";
}

}  // namespace

std::string sweep_page(const analysis::Results& results) {
    results.require_agreement();
    const sweep::Sweep& sweep = results.folder().sweep();
    std::string body = fmt::format("<p>{}</p>\n<p>{} of {} done, {} failed, {} to run; results {:016x}.</p>\n",
                                   escaped(sweep.about), results.done(), counted(results.size(), "point"),
                                   results.failed(), results.unfinished(), results.hash());
    if (results.failed() > 0) body += failure_rows(results);
    if (results.unfinished() > 0)
        body += "<p><b>Not all points are finished:</b> figures show those that are, in random order.</p>\n";
    body += "<h2>Axes</h2>\n" + axis_rows(sweep);
    if (!sweep.figures.empty()) body += "<h2>Figures</h2>\n";
    for (std::size_t f = 0; f < sweep.figures.size(); ++f) {
        const std::string mark{static_cast<char>('a' + f / 26), static_cast<char>('a' + f % 26)};
        try {
            const analysis::FigureData data = analysis::figure_data(results, sweep.figures[f]);
            body += html::drawing(draw_sweep(data), mark) + cell_rows(data);
        } catch (const Error& error) {
            body += fmt::format("<p>{}: {}</p>\n", escaped(sweep.figures[f].name), escaped(error.what()));
        }
    }
    body += "<h2>What ran it</h2>\n" + worker_rows(results);
    return html::page(sweep.title, body);
}

}  // namespace tactus::report
