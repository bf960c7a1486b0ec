// SPDX-License-Identifier: Apache-2.0
// tactus sweep plot: a figure over the results, of the sweep file or chosen here.
#include "dsp/core/error.hpp"
#include "tools/command/figure_options.hpp"
#include "tools/command/options.hpp"
#include "tools/command/sweep/sweep_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/sweep/sweep_figure.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace tactus::command {

namespace {

struct SweepPlotChoice {
    std::filesystem::path folder;
    std::string out, figure, statistic = "mean";
    sweep::FigureChoice own;
    FigureChoice picture;
};

sweep::FigureChoice figure_of(const SweepPlotChoice& choice, const sweep::Sweep& sweep) {
    if (choice.own.values.empty()) {
        std::vector<std::string> names;
        for (const sweep::FigureChoice& figure : sweep.figures) names.push_back(figure.name);
        if (names.empty())
            throw Error(
                "the sweep states no figure; choose one with --value COLUMN --x AXIS, and --y, --series, --panel");
        if (choice.figure.empty()) return sweep.figures.front();
        const auto found = std::ranges::find(sweep.figures, choice.figure, &sweep::FigureChoice::name);
        if (found == sweep.figures.end())
            throw Error(
                fmt::format("the sweep has no figure '{}'{}", choice.figure, did_you_mean(choice.figure, names)));
        return *found;
    }
    sweep::FigureChoice figure = choice.own;
    if (figure.x.empty()) throw Error("--value needs --x AXIS");
    figure.kind = figure.y.empty() ? sweep::FigureChoice::Kind::lines : sweep::FigureChoice::Kind::heat;
    figure.statistic = sweep::statistic_of(choice.statistic);
    return figure;
}

int sweep_plot(const SweepPlotChoice& choice) {
    const analysis::SweepFolder folder(choice.folder, run::library_folder());
    const analysis::Results results(folder);
    results.require_agreement();
    const analysis::FigureData data = analysis::figure_data(results, figure_of(choice, folder.sweep()));
    save_figure(report::draw_sweep(data), choice.out, choice.picture);
    if (results.done() < results.size())
        say(stderr,
            fmt::format("tactus: {} of {} points are done; the figure shows those\n", results.done(), results.size()));
    return done;
}

Action declare_sweep_plot(VerbOptions& verb) {
    const auto choice = std::make_shared<SweepPlotChoice>();
    verb.add("folder", choice->folder, "folder of a sweep").required();
    verb.output("-o,--out", choice->out, {{".svg", ".png", ".pdf"}}, "figure, .svg, .png or .pdf").required();
    add_figure_options(verb, choice->picture);
    const Option figure = verb.add("--figure", choice->figure, "figure of the sweep file; default: its first");
    Option value =
        verb.add("--value", choice->own.values,
                 "column of the results, for a figure of its own; several, separated by ',', are a line each");
    value.separated_by(',').excludes(figure);
    verb.add("--minus", choice->own.minus, "column that is subtracted within each row; one for each value")
        .separated_by(',')
        .needs(value);
    verb.add("--x", choice->own.x, "axis across").needs(value);
    verb.add("--y", choice->own.y, "axis upwards: a heat map").needs(value);
    verb.add("--series", choice->own.series, "axis with a line for each level").needs(value);
    verb.add("--panel", choice->own.panel, "axis with a panel for each level").needs(value);
    verb.add("--statistic", choice->statistic,
             "over all other axes and seeds: mean (t interval), median (order statistics) or fraction of values that "
             "are not 0 (Wilson interval)")
        .one_of(sweep::statistic_names())
        .needs(value)
        .shows_default();
    verb.add("--unit", choice->own.unit, "of the column, for the axis").needs(value);
    verb.flag("--log", choice->own.is_log, "logarithmic axis or colours of the values").needs(value);
    return [choice] { return sweep_plot(*choice); };
}

}  // namespace

Verb sweep_plot_verb() {
    return {"plot", "a figure over the results of a sweep: lines with intervals, or a heat map, in panels",
            declare_sweep_plot};
}

}  // namespace tactus::command
