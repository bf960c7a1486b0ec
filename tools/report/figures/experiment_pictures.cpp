// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/experiment_pictures.hpp"

#include "dsp/core/units.hpp"
#include "tools/report/figures/axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

using experiment::Protocol;

/// Unit of levels, with its factor to SI.
struct LevelUnit {
    double factor = 1.0;
    std::string name;
};
LevelUnit level_unit_of(const Protocol& protocol) {
    const std::string name = protocol.stimulus->level_unit();
    return {parse_unit(name).factor,
            name.empty() && protocol.stimulus->is_relative ? "fraction of the standard" : name};
}

std::string level_label(const LevelUnit& unit) { return unit.name.empty() ? "level" : "level, " + unit.name; }

/// Legend of the conditions.
void draw_legend(display::Figure& figure, const Protocol& protocol) {
    double legend = 10.0;
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const display::Colour colour = curve_colours[i % curve_colours.size()];
        figure.rectangle(legend, 6.0, 10.0, 10.0, colour);
        figure.text({legend + 14.0, 15.0}, protocol.conditions[i].name, 11.0, axis_ink);
        legend += 30.0 + 7.0 * static_cast<double>(protocol.conditions[i].name.size());
    }
}

constexpr double panel_width = 220.0, panel_height = 150.0;
constexpr std::size_t panels_across = 4, max_panels = 24;

display::Figure panels_for(std::size_t subjects) {
    const std::size_t rows = (std::min(subjects, max_panels) + panels_across - 1) / panels_across;
    return {panels_across * panel_width + 20.0, static_cast<double>(rows) * (panel_height + 60.0) + 30.0};
}

Axes panel_of(display::Figure& figure, std::size_t subject, const Scale& across, const Scale& up) {
    return {figure,
            50.0 + panel_width * static_cast<double>(subject % panels_across),
            45.0 + (panel_height + 60.0) * static_cast<double>(subject / panels_across),
            panel_width - 60.0,
            panel_height,
            across,
            up};
}

std::string title_of(const analysis::AnalysedSubject& subject) {
    return subject.entry.pseudonym + (subject.excluded.empty() ? "" : " (excluded)");
}

/// The middle of a mark, and half of its side.
void draw_dot(display::Figure& figure, const display::FigurePoint& at, double half, const display::Colour& colour) {
    figure.rectangle(at.x - half, at.y - half, 2.0 * half, 2.0 * half, colour);
}

}  // namespace

display::Figure draw_psychometric(const analysis::ExperimentAnalysis& analysis) {
    const Protocol& protocol = analysis.protocol;
    const experiment::Stimulus& stimulus = *protocol.stimulus;
    const LevelUnit unit = level_unit_of(protocol);
    display::Figure figure = panels_for(analysis.subjects.size());
    draw_legend(figure, protocol);
    for (std::size_t s = 0; s < std::min(analysis.subjects.size(), max_panels); ++s) {
        const analysis::AnalysedSubject& subject = analysis.subjects[s];
        const Axes axes =
            panel_of(figure, s, {stimulus.min / unit.factor, stimulus.max / unit.factor, stimulus.is_log},
                     {0.0, 1.0, false, 0.25});
        axes.draw(title_of(subject), level_label(unit),
                  protocol.response.kind == experiment::ResponseKind::choice ? "correct" : "yes");
        for (std::size_t c = 0; c < subject.thresholds.size(); ++c) {
            const analysis::SubjectThreshold& one = subject.thresholds[c];
            const display::Colour colour = curve_colours[c % curve_colours.size()];
            for (const psychophysics::LevelCount& count : one.counts) {
                const display::FigurePoint at =
                    axes.at(stimulus.level_at(count.level) / unit.factor, count.correct / count.trials);
                // The area of a dot is that of its trials.
                draw_dot(figure, at, std::min(7.0, std::sqrt(count.trials)),
                         {colour.red, colour.green, colour.blue, 0.45});
            }
            if (!one.fit) continue;
            std::vector<display::FigurePoint> curve;
            const double low = stimulus.axis(stimulus.min), high_ = stimulus.axis(stimulus.max);
            for (int i = 0; i <= 80; ++i) {
                const double axis = low + (high_ - low) * i / 80.0;
                curve.push_back({stimulus.level_at(axis) / unit.factor, one.fit->function.at(axis)});
            }
            axes.curve(curve, colour, one.threshold ? 0.0 : 3.0, false);
        }
    }
    return figure;
}

display::Figure draw_matches(const analysis::ExperimentAnalysis& analysis) {
    const Protocol& protocol = analysis.protocol;
    const experiment::Stimulus& stimulus = *protocol.stimulus;
    const LevelUnit unit = level_unit_of(protocol);
    display::Figure figure = panels_for(analysis.subjects.size());
    draw_legend(figure, protocol);
    const double n = static_cast<double>(protocol.conditions.size());
    for (std::size_t s = 0; s < std::min(analysis.subjects.size(), max_panels); ++s) {
        const analysis::AnalysedSubject& subject = analysis.subjects[s];
        const Axes axes =
            panel_of(figure, s, {0.5, n + 0.5, false, 1000.0},
                     {stimulus.min / unit.factor, stimulus.max / unit.factor, stimulus.is_log});
        axes.draw(title_of(subject), "began below | began above", s % panels_across == 0 ? level_label(unit) : "");
        for (std::size_t c = 0; c < subject.thresholds.size(); ++c) {
            const analysis::SubjectThreshold& one = subject.thresholds[c];
            const display::Colour colour = curve_colours[c % curve_colours.size()];
            const double x = static_cast<double>(c) + 1.0;
            for (const experiment::TrialRecord& trial : subject.records) {
                if (trial.condition != one.condition || !trial.match || !trial.marked.empty() ||
                    trial.phase == experiment::Phase::practice)
                    continue;
                draw_dot(figure,
                         axes.at(x + (protocol.begins_above(trial.level) ? 0.2 : -0.2), *trial.match / unit.factor), 2.5,
                         {colour.red, colour.green, colour.blue, 0.5});
            }
            if (!one.threshold || !one.interval) continue;
            const double low = std::clamp(one.interval->low, stimulus.min, stimulus.max),
                         high = std::clamp(one.interval->high, stimulus.min, stimulus.max);
            figure.line({axes.at(x, low / unit.factor), axes.at(x, high / unit.factor)}, colour, 1.5);
            draw_dot(figure, axes.at(x, *one.threshold / unit.factor), 3.5, colour);
        }
    }
    return figure;
}

display::Figure draw_group(const analysis::ExperimentAnalysis& analysis, const std::string& task,
                           const std::string& measure) {
    const std::string unit_name = analysis::unit_of(analysis.protocol, task, measure);
    const double factor = parse_unit(unit_name).factor;
    const std::string unit =
        unit_name.empty() && analysis.protocol.is_psychophysics() ? level_unit_of(analysis.protocol).name : unit_name;
    std::vector<const analysis::GroupValue*> groups;
    bool is_log = false;
    for (const analysis::GroupValue& group : analysis.groups)
        if (group.task == task && group.measure == measure) {
            groups.push_back(&group);
            is_log = group.is_log;
        }
    std::vector<std::pair<std::size_t, double>> dots;
    double low = 1e300, high = -1e300;
    for (const analysis::AnalysedSubject& subject : analysis.subjects) {
        if (!subject.excluded.empty()) continue;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const auto value =
                analysis::value_of(analysis.protocol, subject, task, measure, groups[g]->condition);
            if (!value) continue;
            dots.emplace_back(g, (is_log ? std::exp(*value) : *value) / factor);
            low = std::min(low, dots.back().second);
            high = std::max(high, dots.back().second);
        }
    }
    if (dots.empty()) {
        low = is_log ? 0.1 : 0.0;
        high = 1.0;
    }
    const double pad = is_log ? 1.3 : 0.1 * std::max(high - low, 1e-9);
    const double n = static_cast<double>(groups.size());
    display::Figure figure(std::max(320.0, 110.0 + 110.0 * n), 260.0);
    const Scale up = is_log ? Scale{low / pad, high * pad, true} : Scale{low - pad, high + pad, false};
    const Axes axes{figure, 60.0, 30.0, std::max(240.0, 110.0 * n), 190.0, {0.5, n + 0.5, false, 1000.0}, up};
    axes.draw(fmt::format("{}{}", task.empty() ? "" : task + ", ", measure), "", unit);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const double x = static_cast<double>(g) + 1.0;
        figure.text({axes.at(x, up.low).x, axes.y + axes.height + 15.0}, groups[g]->condition, 10.0, axis_ink,
                    display::TextAnchor::middle);
        if (groups[g]->count == 0) continue;
        const display::Colour colour = curve_colours[1];
        if (!groups[g]->is_bound())
            figure.line({axes.at(x + 0.18, groups[g]->low / factor), axes.at(x + 0.18, groups[g]->high / factor)},
                        colour, 1.5);
        draw_dot(figure, axes.at(x + 0.18, groups[g]->mean / factor), 3.5, colour);
    }
    for (const auto& [g, value] : dots)
        draw_dot(figure, axes.at(static_cast<double>(g) + 0.92, value), 2.5, {0x1F, 0x4E, 0x9E, 0.5});
    return figure;
}

display::Figure draw_effects(const analysis::ExperimentAnalysis& analysis) {
    std::vector<const analysis::AnalysedComparison*> rows;
    double reach = 1.2;
    for (const analysis::AnalysedComparison& one : analysis.comparisons)
        if (one.test) {
            rows.push_back(&one);
            for (const double end : {one.test->low, one.test->high})
                reach = std::max(reach, 1.1 * std::abs(end / one.test->of.deviation));
            if (one.of.margin) reach = std::max(reach, 1.1 * *one.of.margin);
        }
    const double high = 26.0 * static_cast<double>(rows.size());
    display::Figure figure(760.0, high + 80.0);
    const double n = static_cast<double>(rows.size());
    const Axes axes{figure, 330.0, 30.0, 400.0, high, {-reach, reach, false}, {0.5, n + 0.5, false, 1000.0}};
    axes.draw("differences, with intervals of 95 %", "standard deviations of the paired difference", "");
    figure.line({axes.at(0.0, 0.5), axes.at(0.0, n + 0.5)}, axis_ink, 1.0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const analysis::AnalysedComparison& one = *rows[i];
        const double y = n - static_cast<double>(i), sd = one.test->of.deviation;
        const display::Colour colour = one.adjusted_p < analysis.protocol.alpha ? curve_colours[1] : curve_colours[0];
        figure.text({322.0, axes.at(0.0, y).y + 4.0}, one.label, 10.5, axis_ink, display::TextAnchor::end);
        if (one.of.margin)
            for (const double margin : {-*one.of.margin, *one.of.margin})
                figure.line({axes.at(margin, y - 0.4), axes.at(margin, y + 0.4)}, axis_soft, 1.5, 2.0);
        figure.line({axes.at(one.test->low / sd, y), axes.at(one.test->high / sd, y)}, colour, 2.0);
        draw_dot(figure, axes.at(one.test->of.mean / sd, y), 3.5, colour);
    }
    return figure;
}

}  // namespace tactus::report
