// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/experiment_page.hpp"

#include "dsp/core/units.hpp"
#include "tools/report/figures/axes.hpp"
#include "tools/report/figures/html_report.hpp"

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
    return {parse_unit(name).factor, name.empty() ? "fraction of the standard" : name};
}

/// Unit in which a comparison is shown.
LevelUnit shown_unit(const Protocol& protocol, const analysis::AnalysedComparison& comparison) {
    if (protocol.is_psychophysics()) return level_unit_of(protocol);
    for (const experiment::Task& task : protocol.tasks)
        for (const experiment::Measure& measure : task.measures)
            if (task.name == comparison.of.task && measure.name == comparison.of.measure && !measure.unit.empty())
                return {parse_unit(measure.unit).factor, measure.unit};
    return {1.0, ""};
}

/// One panel for each subject: answers by level, and the fitted function of each condition.
display::Figure psychometric_panels(const analysis::ExperimentAnalysis& analysis) {
    const Protocol& protocol = analysis.protocol;
    const experiment::Stimulus& stimulus = *protocol.stimulus;
    const LevelUnit unit = level_unit_of(protocol);
    constexpr double wide = 220.0, high = 150.0;
    constexpr std::size_t across = 4, max_panels = 24;
    const std::size_t panels = std::min(analysis.subjects.size(), max_panels), rows = (panels + across - 1) / across;
    display::Figure figure(across * wide + 20.0, static_cast<double>(rows) * (high + 60.0) + 30.0);
    double legend = 10.0;
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const display::Colour colour = curve_colours[i % curve_colours.size()];
        figure.rectangle(legend, 6.0, 10.0, 10.0, colour);
        figure.text({legend + 14.0, 15.0}, protocol.conditions[i].name, 11.0, axis_ink);
        legend += 30.0 + 7.0 * static_cast<double>(protocol.conditions[i].name.size());
    }
    for (std::size_t s = 0; s < panels; ++s) {
        const analysis::AnalysedSubject& subject = analysis.subjects[s];
        const Axes axes{figure,
                        50.0 + wide * static_cast<double>(s % across),
                        45.0 + (high + 60.0) * static_cast<double>(s / across),
                        wide - 60.0,
                        high,
                        {stimulus.min / unit.factor, stimulus.max / unit.factor, stimulus.is_log},
                        {0.0, 1.0, false, 0.25}};
        axes.draw(subject.entry.pseudonym + (subject.excluded.empty() ? "" : " (excluded)"), "level, " + unit.name,
                  protocol.response.kind == experiment::ResponseKind::choice ? "correct" : "yes");
        for (std::size_t c = 0; c < subject.thresholds.size(); ++c) {
            const analysis::SubjectThreshold& one = subject.thresholds[c];
            const display::Colour colour = curve_colours[c % curve_colours.size()];
            for (const psychophysics::LevelCount& count : one.counts) {
                const display::FigurePoint at =
                    axes.at(stimulus.level_at(count.level) / unit.factor, count.correct / count.trials);
                // The area of a dot is that of its trials.
                const double size = std::min(14.0, 2.0 * std::sqrt(count.trials));
                figure.rectangle(at.x - 0.5 * size, at.y - 0.5 * size, size, size,
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

/// Values of all subjects by condition, with the mean and its interval of 95 %.
display::Figure group_panel(const analysis::ExperimentAnalysis& analysis, const std::string& task,
                            const std::string& measure, double factor, const std::string& unit) {
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
            std::optional<double> value;
            if (task.empty()) {
                for (const analysis::SubjectThreshold& one : subject.thresholds)
                    if (one.condition == groups[g]->condition) value = one.threshold;
            } else if (const auto found = subject.means.find(task + " " + measure + " " + groups[g]->condition);
                       found != subject.means.end()) {
                value = is_log ? std::exp(found->second) : found->second;
            }
            if (!value) continue;
            dots.emplace_back(g, *value / factor);
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
        figure.line({axes.at(x + 0.18, groups[g]->low / factor), axes.at(x + 0.18, groups[g]->high / factor)}, colour,
                    1.5);
        const display::FigurePoint mean = axes.at(x + 0.18, groups[g]->mean / factor);
        figure.rectangle(mean.x - 3.5, mean.y - 3.5, 7.0, 7.0, colour);
    }
    for (const auto& [g, value] : dots) {
        const display::FigurePoint at = axes.at(static_cast<double>(g) + 0.92, value);
        figure.rectangle(at.x - 2.5, at.y - 2.5, 5.0, 5.0, {0x1F, 0x4E, 0x9E, 0.5});
    }
    return figure;
}

/// A row for each comparison: interval of the standardised difference, and the margin.
display::Figure effect_panel(const analysis::ExperimentAnalysis& analysis) {
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
        const display::FigurePoint mean = axes.at(one.test->of.mean / sd, y);
        figure.rectangle(mean.x - 3.5, mean.y - 3.5, 7.0, 7.0, colour);
    }
    return figure;
}

std::string p_text(double p) { return p < 1e-4 ? "&lt; 0.0001" : fmt::format("{:.4f}", p); }

std::string comparison_rows(const analysis::ExperimentAnalysis& analysis) {
    std::string out =
        "<table><tr><th>comparison</th><th class=\"n\">n</th><th class=\"n\">difference (95 %)</th><th "
        "class=\"n\">p</th>"
        "<th class=\"n\">p, permutation</th><th class=\"n\">p, Holm</th><th class=\"n\">p, equivalence</th>"
        "<th>verdict</th></tr>\n";
    for (const analysis::AnalysedComparison& one : analysis.comparisons) {
        if (!one.test) {
            out += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td colspan=\"6\">not tested: {}</td></tr>\n",
                               html::escaped(one.label), one.differences.size(), html::escaped(one.problem));
            continue;
        }
        const LevelUnit unit = shown_unit(analysis.protocol, one);
        const auto back = [&](double value) {
            return one.is_log ? fmt::format("× {:.3f}", std::exp(value))
                              : fmt::format("{:.4g} {}", value / unit.factor, html::escaped(unit.name));
        };
        out += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{} ({} to {})</td><td class=\"n\">{}</td>"
            "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
            html::escaped(one.label), one.differences.size(), back(one.test->of.mean), back(one.test->low),
            back(one.test->high), p_text(one.test->p), p_text(one.permutation->p), p_text(one.adjusted_p),
            one.equivalence ? p_text(one.equivalence->p) : "–", analysis::verdict_of(one, analysis.protocol.alpha));
    }
    return out + "</table>\n";
}

std::string power_text(const analysis::ExperimentAnalysis& analysis) {
    std::string out;
    for (const analysis::AnalysedComparison& one : analysis.comparisons) {
        if (!one.test) continue;
        const LevelUnit unit = shown_unit(analysis.protocol, one);
        out += fmt::format(
            "<li>{}: with {} subjects the t test finds {:.2f} standard deviations of the difference with 80 % "
            "power{}",
            html::escaped(one.label), one.differences.size(), one.detectable,
            one.is_log ? fmt::format(" (here a factor of {:.3f})", std::exp(one.detectable * one.test->of.deviation))
                       : fmt::format(" (here {:.3g} {})", one.detectable * one.test->of.deviation / unit.factor,
                                     html::escaped(unit.name)));
        if (one.of.margin)
            out += fmt::format(
                "; equivalence within {:.2g} standard deviations is shown in {:.0f} % of studies without an effect",
                *one.of.margin, 100.0 * one.equivalence_power);
        if (one.cross_over)
            out += fmt::format("; period effect p = {}, difference adjusted for it p = {}",
                               p_text(one.cross_over->period_p), p_text(one.cross_over->p));
        out += "</li>\n";
    }
    return out.empty() ? out : "<ul>" + out + "</ul>\n";
}

std::string subject_rows(const analysis::ExperimentAnalysis& analysis) {
    std::string out =
        "<table><tr><th>subject</th><th class=\"n\">order</th><th class=\"n\">trials</th><th class=\"n\">marked</th>"
        "<th class=\"n\">catch trials correct</th><th>in the group</th></tr>\n";
    for (const analysis::AnalysedSubject& subject : analysis.subjects) {
        std::string marked = std::to_string(subject.marked);
        for (const auto& [condition, count] : subject.marked_in) marked += fmt::format(", {} {}", condition, count);
        out += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
            "<td class=\"n\">{}</td><td>{}</td></tr>\n",
            html::escaped(subject.entry.pseudonym), subject.entry.row + 1, subject.trials, html::escaped(marked),
            subject.catch_trials > 0 ? fmt::format("{} of {}", subject.catch_correct, subject.catch_trials) : "–",
            subject.excluded.empty() ? "yes" : "no: " + html::escaped(subject.excluded));
    }
    return out + "</table>\n";
}

std::string threshold_rows(const analysis::ExperimentAnalysis& analysis) {
    const LevelUnit unit = level_unit_of(analysis.protocol);
    std::string out = fmt::format(
        "<table><tr><th>subject</th><th>condition</th><th class=\"n\">threshold, {}</th>"
        "<th class=\"n\">95 %</th><th class=\"n\">with marked trials</th><th class=\"n\">slope</th>"
        "<th class=\"n\">d′</th><th class=\"n\">criterion</th></tr>\n",
        html::escaped(unit.name));
    const auto level = [&](const std::optional<double>& value) {
        return value ? fmt::format("{:.4g}", *value / unit.factor) : std::string("not identified");
    };
    const auto plain = [](const std::optional<double>& value) {
        return value ? fmt::format("{:.2f}", *value) : std::string("–");
    };
    for (const analysis::AnalysedSubject& subject : analysis.subjects)
        for (const analysis::SubjectThreshold& one : subject.thresholds)
            out += fmt::format(
                "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
                "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
                html::escaped(subject.entry.pseudonym), html::escaped(one.condition), level(one.threshold),
                one.interval
                    ? fmt::format("{:.4g} to {:.4g}", one.interval->low / unit.factor, one.interval->high / unit.factor)
                    : "–",
                level(one.with_marked), one.fit ? fmt::format("{:.2f}", one.fit->function.slope) : "–",
                plain(one.d_prime), plain(one.criterion));
    return out + "</table>\n";
}

std::string group_figures(const analysis::ExperimentAnalysis& analysis) {
    const Protocol& protocol = analysis.protocol;
    if (protocol.is_psychophysics()) {
        const LevelUnit unit = level_unit_of(protocol);
        return html::drawing(group_panel(analysis, "", "threshold", unit.factor, unit.name), "g");
    }
    std::string out;
    int mark = 0;
    for (const experiment::Task& task : protocol.tasks)
        for (const experiment::Measure& measure : task.measures) {
            const double factor = measure.unit.empty() ? 1.0 : parse_unit(measure.unit).factor;
            out += html::drawing(
                group_panel(analysis, task.name, measure.name, factor, measure.unit),
                std::string("g") + static_cast<char>('a' + mark / 26) + static_cast<char>('a' + mark % 26));
            ++mark;
        }
    return out;
}

}  // namespace

std::string experiment_page(const analysis::ExperimentAnalysis& analysis) {
    const Protocol& protocol = analysis.protocol;
    std::string body;
    if (analysis.is_simulated)
        body +=
            "<p><b>Simulated data.</b> Some or all subjects are models: this page shows that the experiment and its "
            "analysis "
            "work, and nothing about people.</p>\n";
    if (analysis.is_rehearsal)
        body += "<p><b>Rehearsal.</b> Some sessions had no haptic device or no registered display.</p>\n";
    body += fmt::format("<p>{}</p>\n<p>{} of {} subjects are in the group.</p>\n", html::escaped(protocol.about),
                        analysis.included, analysis.subjects.size());
    body += "<h2>Comparisons</h2>\n";
    if (analysis.comparisons.empty()) body += "<p>The protocol states none.</p>\n";
    else {
        body += comparison_rows(analysis);
        if (std::ranges::any_of(analysis.comparisons, [](const auto& one) { return one.test.has_value(); }))
            body += html::drawing(effect_panel(analysis), "e");
        body += power_text(analysis);
        body +=
            "<p class=\"small\">Paired t tests, two-sided; permutation tests flip signs. Holm's adjustment is over all "
            "comparisons of this table. Equivalence: the t statistic against the non-central t at the margin that the "
            "protocol states. <i>Inconclusive</i> means that neither an effect nor its absence was shown.</p>\n";
    }
    body +=
        "<h2>Group</h2>\n<p class=\"small\">Blue: subjects. Red: mean with its interval of 95 %, of logarithms where "
        "the axis is "
        "logarithmic.</p>\n" +
        group_figures(analysis);
    if (protocol.is_psychophysics())
        body +=
            "<h2>Thresholds</h2>\n" + html::drawing(psychometric_panels(analysis), "p") + threshold_rows(analysis) +
            fmt::format(
                "<p class=\"small\">Level with a probability of {:.3g}. Intervals: parametric bootstrap; for adaptive "
                "methods it ignores that the levels depended on the answers.</p>\n",
                protocol.method.target);
    body += "<h2>Subjects</h2>\n" + subject_rows(analysis);
    return html::page(protocol.title, body);
}

}  // namespace tactus::report
