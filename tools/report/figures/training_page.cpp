// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/training_page.hpp"

#include "dsp/core/error.hpp"
#include "tools/report/figures/html_report.hpp"
#include "tools/report/figures/training_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

std::string shown(const std::optional<double>& value) { return value ? fmt::format("{:.3g}", *value) : "–"; }

std::string name_of(const analysis::ScoredRun& run) {
    return run.trainee.empty() ? run.name : fmt::format("{} ({})", run.trainee, run.name);
}

const analysis::ReferenceMeasure* find(std::span<const analysis::ReferenceMeasure> group, const std::string& name) {
    const auto found = std::ranges::find(group, name, &analysis::ReferenceMeasure::measure);
    return found == group.end() || found->values.empty() ? nullptr : &*found;
}

std::string table_of_runs(std::span<const analysis::ScoredRun> runs,
                          std::span<const analysis::ReferenceMeasure> group) {
    std::string out = "<table><tr><th>measure</th>";
    for (std::size_t n = 0; n < runs.size(); ++n) out += fmt::format("<th class=\"n\">{}</th>", n + 1);
    if (!group.empty())
        out += "<th class=\"n\">percentile of the last</th><th class=\"n\">reference, mean ± sd (n)</th>";
    out += "</tr>\n";
    for (const analysis::Measure& measure : analysis::measures()) {
        out += fmt::format("<tr><td>{}</td>", html::escaped(measure.label));
        for (const analysis::ScoredRun& run : runs)
            out += fmt::format("<td class=\"n\">{}</td>", shown(measure.of(run.score)));
        if (!group.empty()) {
            const analysis::ReferenceMeasure* reference = find(group, measure.name);
            if (!reference) out += "<td class=\"n\">–</td><td class=\"n\">–</td>";
            else
                out += fmt::format("<td class=\"n\">{}</td><td class=\"n\">{:.3g} ± {} ({})</td>",
                                   shown(analysis::percentile(measure, measure.of(runs.back().score), *reference)),
                                   reference->mean, shown(reference->deviation), reference->values.size());
        }
        out += "</tr>\n";
    }
    return out + "</table>\n";
}

std::string list_of_runs(std::span<const analysis::ScoredRun> runs) {
    if (runs.size() == 1) return fmt::format("<p>{}</p>\n", html::escaped(name_of(runs.front())));
    std::string out = "<ol>";
    for (const analysis::ScoredRun& run : runs)
        out += fmt::format("<li>{}: {}</li>", html::escaped(run.task.title), html::escaped(name_of(run)));
    return out + "</ol>\n";
}

std::string spared_table(const analysis::ScoredRun& run) {
    if (run.score.spared.empty()) return {};
    std::string out =
        "<table><tr><th>structure</th><th class=\"n\">injured, mm³</th><th class=\"n\">nearest, mm</th></tr>\n";
    for (const analysis::SparedScore& s : run.score.spared)
        out += fmt::format("<tr><td>{}</td><td class=\"n {}\">{:.3g}</td><td class=\"n\">{:.2f}</td></tr>\n",
                           html::escaped(s.name), s.injured_mm3 > 0.0 ? "fail" : "pass", s.injured_mm3, s.closest_mm);
    return out + "</table>\n";
}

std::string pictures(const analysis::ScoredRun& run) {
    try {
        std::string out;
        for (std::size_t n = 0; n < run.task.cuts.size(); ++n) {
            const training::PlannedCut& cut = run.task.cuts[n];
            const std::string name = run.task.cuts.size() > 1 ? fmt::format("Cut {}. ", html::escaped(cut.name)) : "";
            out +=
                "<div class=\"two\">\n" +
                html::picture(draw_cut_bone(run, n), name + "The bone; blue: the planned cut; red: what to spare") +
                html::picture(draw_cut_face(run, n),
                              fmt::format("{}Opened along the cut. Its wall: white as planned, blue and red {:.2g} mm "
                                          "or more to either side; dark: not cut",
                                          name, 2e3 * cut.tolerance)) +
                "</div>\n";
        }
        return out;
    } catch (const Error& error) {
        return fmt::format("<p class=\"small\">No pictures of the bone: {}</p>\n", html::escaped(error.what()));
    }
}

/// One panel per measure that has at least two values, for the task of the last run.
std::string curves(std::span<const analysis::ScoredRun> runs, std::span<const analysis::ReferenceMeasure> group) {
    std::vector<analysis::LearningCurve> all;
    for (analysis::LearningCurve& curve : analysis::learning_curves(runs)) {
        const auto values = std::ranges::count_if(curve.values, [](const auto& v) { return v.has_value(); });
        if (curve.task == runs.back().task.title && values > 1) all.push_back(std::move(curve));
    }
    if (all.empty()) return {};
    constexpr int columns = 3;
    const auto rows = static_cast<double>((all.size() + columns - 1) / columns);
    display::Figure figure(930.0, 10.0 + 190.0 * rows);
    for (std::size_t n = 0; n < all.size(); ++n) {
        std::vector<display::FigurePoint> points;
        double high = 1e-9, low = 0.0;
        for (std::size_t k = 0; k < all[n].values.size(); ++k) {
            if (!all[n].values[k]) continue;
            points.push_back({static_cast<double>(k + 1), *all[n].values[k]});
            high = std::max(high, points.back().y);
            low = std::min(low, points.back().y);
        }
        const analysis::ReferenceMeasure* reference = find(group, all[n].measure);
        if (reference) high = std::max(high, reference->mean + reference->deviation.value_or(0.0));
        const auto column = static_cast<double>(n % columns), row = static_cast<double>(n / columns);
        const Axes axes{figure,
                        50.0 + 310.0 * column,
                        24.0 + 190.0 * row,
                        240.0,
                        120.0,
                        {0.5, static_cast<double>(all[n].values.size()) + 0.5, false},
                        {low, 1.1 * high, false}};
        axes.draw(all[n].measure, "attempt", "");
        axes.curve(points, curve_colours[0], 0.0, true);
        if (!reference) continue;
        axes.level(reference->mean, curve_colours[2], "reference");
        if (!reference->deviation) continue;
        axes.level(reference->mean + *reference->deviation, axis_soft, "");
        axes.level(reference->mean - *reference->deviation, axis_soft, "");
    }
    return "<h2>Learning curve</h2>\n" + html::drawing(figure, "learn");
}

}  // namespace

std::string training_page(std::span<const analysis::ScoredRun> runs,
                          std::span<const analysis::ReferenceMeasure> reference) {
    const analysis::ScoredRun& last = runs.back();
    std::string body =
        "<p class=\"fail\"><b>These scores are not validated.</b> They describe one attempt in a simulation; they do "
        "not "
        "say how well anybody operates.</p>\n" +
        list_of_runs(runs);
    if (!last.task.about.empty()) body += fmt::format("<p>{}</p>\n", html::escaped(last.task.about));
    if (runs.size() > 1) body += fmt::format("<h2>Attempt {}</h2>\n", runs.size());
    body += pictures(last) + spared_table(last) + html::drawing(draw_attempt(last), "attempt");
    body += "<h2>Scores</h2>\n" + table_of_runs(runs, reference);
    body += fmt::format(
        "<p class=\"small\">Removed: {:.1f} mm³. Largest force: {:.1f} N. Greater is worse, except for the nearest "
        "distance; for mean force and strokes neither is. Percentile: percent of the reference group that did worse. "
        "What each measure is: docs/reference/scores.md.</p>\n",
        last.removed_mm3, last.max_N);
    if (runs.size() > 1) body += curves(runs, reference);
    return html::page(last.task.title, body);
}

}  // namespace tactus::report
