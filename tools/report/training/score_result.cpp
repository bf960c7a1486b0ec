// SPDX-License-Identifier: Apache-2.0
#include "tools/report/training/score_result.hpp"

#include "dsp/core/error.hpp"
#include "tools/report/figures/training_pictures.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace tactus::report {

namespace {

using analysis::CutScore;
using analysis::LearningCurve;
using analysis::ReferenceMeasure;
using analysis::Score;
using analysis::ScoredRun;
using analysis::SparedScore;

constexpr const char* not_validated = "not validated";
constexpr const char* validity =
    "These scores are not validated: they describe one attempt in a simulation and do not state how well anybody "
    "operates";

/// A plane that was cut.
template <class Cut>
const Fields<Cut>& plane_fields() {
    static const Fields<Cut> all = Fields<Cut>("distance of the cut from its plan")
                                       .number("rms_mm", "", significant(3, "mm"), &Cut::rms_mm)
                                       .number("max_mm", "", significant(3, "mm"), &Cut::max_mm)
                                       .number("angle_deg", "", significant(3, "°"), &Cut::angle_deg);
    return all;
}

template <class Cut>
const Fields<Cut>& breakthrough_fields() {
    static const Fields<Cut> all =
        Fields<Cut>("plunge behind the bone")
            .number("depth_mm", "", significant(3, "mm"), &Cut::breakthrough_mm)
            .number("speed_mm_per_s", "", significant(3, "mm/s"), &Cut::breakthrough_mm_per_s);
    return all;
}

template <class T>
const T& same(const T& t) {
    return t;
}

std::string cut_text(const CutScore& c) {
    if (!c.rms_mm) return "not made";
    return fmt::format("{:.2f} mm rms, {:.2f} mm at most{} from the plan", *c.rms_mm, *c.max_mm,
                       c.angle_deg ? fmt::format(", {:.2f}°", *c.angle_deg) : "");
}

const Fields<CutScore>& cut_fields() {
    using C = CutScore;
    static const Fields<C> all = Fields<C>("one cut of a task")
                                     .text("name", "cut", &C::name)
                                     .child("plane", "", plane_fields<C>(), same<C>)
                                     .text("", "made", cut_text)
                                     .number("over_mm3", "", significant(3, "mm^3"), &C::over_mm3)
                                     .number("under_mm3", "", significant(3, "mm^3"), &C::under_mm3)
                                     .child("breakthrough", "", breakthrough_fields<C>(), same<C>);
    return all;
}

const Fields<SparedScore>& spared_fields() {
    using S = SparedScore;
    static const Fields<S> all =
        Fields<S>("structure to spare")
            .text("name", "structure", &S::name)
            .number("injured_mm3", "injured", significant(3, "mm^3"), &S::injured_mm3)
            .judged([](const S& s) { return s.injured_mm3 > 0.0 ? Severity::fail : Severity::pass; })
            .number("closest_mm", "nearest", fixed(2, "mm"), &S::closest_mm);
    return all;
}

const Fields<Score>& force_fields() {
    using S = Score;
    static const Fields<S> all = Fields<S>("force of the tool")
                                     .number("mean_N", "", significant(3, "N"), &S::mean_N)
                                     .number("contact_s", "", significant(3, "s"), &S::contact_s)
                                     .number("over_limit_Ns", "", significant(3, "N s"), &S::over_limit_Ns)
                                     .number("shown", "", significant(3), &S::shown_share)
                                     .number("device_scale", "", significant(3), &S::device_scale)
                                     .number("limited", "", significant(3), &S::limited)
                                     .number("jerk", "", significant(3), &S::jerk);
    return all;
}

/// The values in JSON; the printed formats have the list of measures.
const Fields<Score>& score_fields() {
    using S = Score;
    static const Fields<S> all =
        Fields<S>("scores of an attempt")
            .child("plane", "", plane_fields<S>(), same<S>)
            .number("over_mm3", "", significant(3, "mm^3"), &S::over_mm3)
            .number("under_mm3", "", significant(3, "mm^3"), &S::under_mm3)
            .rows("spared", "", spared_fields(), &S::spared)
            .child("force", "", force_fields(), same<S>)
            .child("breakthrough", "", breakthrough_fields<S>(), same<S>)
            .integer("strokes", "", &S::strokes)
            .number("seconds", "", significant(3, "s"), &S::seconds)
            .number("path_mm", "", significant(3, "mm"), &S::path_mm)
            .number("heat_s", "", significant(3, "s"), &S::heat_s)
            .rows("cuts", "cuts", cut_fields(),
                  [](const S& s) { return s.cuts.size() > 1 ? s.cuts : std::vector<CutScore>(); })
            .omitted()
            .text("validity", "", [](const S&) { return not_validated; });
    return all;
}

/// An attempt and the group it is compared with.
struct Attempt {
    const ScoredRun* run;
    std::span<const ReferenceMeasure> reference;
};

struct MeasureOf {
    const analysis::Measure* measure;
    std::optional<double> value, rank;
    std::size_t count = 0;  ///< of the group
};

std::vector<MeasureOf> measures_of(const Attempt& a) {
    std::vector<MeasureOf> all;
    for (const analysis::Measure& measure : analysis::measures()) {
        const std::size_t n = all.size();
        all.push_back({&measure, measure.of(a.run->score), {}, 0});
        if (a.reference.empty()) continue;
        all.back().rank = analysis::percentile(measure, all.back().value, a.reference[n]);
        all.back().count = a.reference[n].values.size();
    }
    return all;
}

const Fields<MeasureOf>& measure_fields() {
    static const Fields<MeasureOf> all =
        Fields<MeasureOf>("value of a measure")
            .text("", "measure", [](const MeasureOf& m) { return m.measure->name; })
            .number("", "value", significant(4), &MeasureOf::value)
            .text("", "percentile", [](const MeasureOf& m) {
                return m.rank ? fmt::format("{:.0f} of {}", *m.rank, m.count) : std::string();
            });
    return all;
}

std::vector<std::string> warnings_of(const Attempt& a) {
    const Score& score = a.run->score;
    std::vector<std::string> all;
    for (const SparedScore& one : score.spared)
        if (one.injured_mm3 > 0.0) all.push_back(fmt::format("injured: {}, {:.3g} mm³", one.name, one.injured_mm3));
    if (score.limited >= 0.005)
        all.push_back(
            fmt::format("the force was limited {:.0f} % of the time in contact: the device rendered less force than "
                        "the tool requires",
                        100.0 * score.limited));
    if (score.shown_share && *score.shown_share < analysis::complete_share)
        all.push_back("the blade was in the bone without force on the hand: do not compare this attempt with others");
    return all;
}

std::string scale_text(const Attempt& a) {
    if (a.run->score.device_scale == 1.0) return {};
    return fmt::format("of the tool; those on the device were {:g} times as large", a.run->score.device_scale);
}

using Percentiles = std::vector<std::pair<std::string, std::optional<double>>>;

Percentiles percentiles_of(const Attempt& a) {
    Percentiles all;
    for (const MeasureOf& m : measures_of(a)) all.emplace_back(m.measure->name, m.rank);
    return all;
}

std::string title_of(const Attempt& a) { return fmt::format("{}: {}", a.run->name, a.run->task.title); }
const Score& score_of(const Attempt& a) { return a.run->score; }

/// What is printed of an attempt.
const Fields<Attempt>& printed_fields() {
    static const Fields<Attempt> all = Fields<Attempt>("attempt")
                                           .titled(title_of)
                                           .text("", "trainee", [](const Attempt& a) { return a.run->trainee; })
                                           .warnings("", warnings_of)
                                           .text("", "forces", scale_text)
                                           .rows("", "measures", measure_fields(), measures_of)
                                           .rows("", "structures to spare", spared_fields(),
                                                 [](const Attempt& a) -> const auto& { return a.run->score.spared; });
    return all;
}

const Attempt& attempt(const Attempt& a) { return a; }

const Fields<Attempt>& row_fields() {
    static const auto is_of_group = [](const Attempt& a) { return !a.reference.empty(); };
    const auto basis = [](const char* about) {
        return Fields<Attempt>(about)
            .text("run", "", [](const Attempt& a) { return a.run->name; })
            .text("task", "", [](const Attempt& a) { return a.run->task.title; })
            .text(
                "trainee", "",
                [](const Attempt& a) { return a.run->trainee.empty() ? std::nullopt : std::optional(a.run->trainee); })
            .omitted()
            .part(printed_fields(), attempt)
            .part(score_fields(), score_of);
    };
    static const Fields<Attempt> with_group =
        basis("scores of an attempt beside a reference group").numbers("percentiles", percentiles_of);
    static const Fields<Attempt> all = basis("scores of an attempt").otherwise(is_of_group, with_group);
    return all;
}

const Fields<LearningCurve>& curve_fields() {
    using C = LearningCurve;
    static const Fields<C> all =
        Fields<C>("values of one measure over the attempts")
            .text("task", "task", &C::task)
            .text("measure", "measure", &C::measure)
            .series("values",
                    [](const C& c) {
                        return ResultEntry::Series{
                            c.values.size(), [values = c.values](std::size_t n) {
                                return values[n].value_or(std::numeric_limits<double>::quiet_NaN());
                            }};
                    })
            .number("exponent", "exponent", significant(3), &C::exponent);
    return all;
}

const Fields<ReferenceMeasure>& reference_fields() {
    using R = ReferenceMeasure;
    static const Fields<R> all =
        Fields<R>("values of a reference group")
            .text("measure", "measure", &R::measure)
            .integer("n", "attempts", [](const R& r) { return r.values.size(); })
            .number("mean", "mean", significant(3),
                    [](const R& r) { return r.values.empty() ? std::nullopt : std::optional(r.mean); })
            .number("deviation", "standard deviation", significant(3), &R::deviation);
    return all;
}

const ReferenceMeasure* find(std::span<const ReferenceMeasure> group, const std::string& name) {
    const auto found = std::ranges::find(group, name, &ReferenceMeasure::measure);
    return found == group.end() || found->values.empty() ? nullptr : &*found;
}

/// Curves with at least two values, for the task of the last run.
std::vector<LearningCurve> drawn_curves(const ScoredRuns& s) {
    std::vector<LearningCurve> all;
    for (LearningCurve& curve : analysis::learning_curves(s.runs)) {
        const auto values = std::ranges::count_if(curve.values, [](const auto& v) { return v.has_value(); });
        if (curve.task == s.runs.back().task.title && values > 1) all.push_back(std::move(curve));
    }
    return all;
}

/// One panel per measure.
display::Figure draw_curves(const ScoredRuns& s) {
    const std::vector<LearningCurve> all = drawn_curves(s);
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
        const ReferenceMeasure* reference = find(s.reference, all[n].measure);
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
    return figure;
}

/// The measures of all attempts side by side, with the reference group.
ResultEntry::Rows side_by_side(const ScoredRuns& s) {
    ResultEntry::Rows table{{}, {{"", "measure"}}};
    for (const ScoredRun& run : s.runs) table.columns.emplace_back("", run.name);
    if (!s.reference.empty()) {
        table.columns.emplace_back("", "percentile of the last");
        table.columns.emplace_back("", "reference, mean ± sd (n)");
    }
    const auto cell = [](std::string name, std::optional<double> value) {
        return ResultEntry{"", std::move(name), false, Severity::none,
                           ResultEntry::Quantity{Number(value), significant(3)}};
    };
    for (const analysis::Measure& measure : analysis::measures()) {
        Result row;
        row.entries.push_back({"", "measure", false, Severity::none, ResultEntry::Text{measure.label}});
        for (std::size_t n = 0; n < s.runs.size(); ++n)
            row.entries.push_back(cell(s.runs[n].name, measure.of(s.runs[n].score)));
        if (const ReferenceMeasure* group = find(s.reference, measure.name)) {
            row.entries.push_back(
                cell("percentile of the last", analysis::percentile(measure, measure.of(s.runs.back().score), *group)));
            row.entries.push_back(
                {"", "reference, mean ± sd (n)", false, Severity::none,
                 ResultEntry::Text{fmt::format("{:.3g} ± {} ({})", group->mean,
                                               group->deviation ? fmt::format("{:.3g}", *group->deviation) : "–",
                                               group->values.size())}});
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

const Fields<CutPictures>& picture_fields() {
    static const Fields<CutPictures> all =
        Fields<CutPictures>("pictures of a cut")
            .titled([](const CutPictures& c) { return c.title; })
            .figure(
                "The bone; blue: the planned cut; red: what to spare", [](const CutPictures&) { return true; },
                [](const CutPictures& c) { return c.bone; })
            .figure(
                "Opened along the cut. Its wall: white as planned, blue and red to either side; dark: not cut",
                [](const CutPictures&) { return true; }, [](const CutPictures& c) { return c.face; })
            .text("", "colours", &CutPictures::face_caption);
    return all;
}

const ScoredRun& last(const ScoredRuns& s) { return s.runs.back(); }

/// What pages add: pictures, the attempt over time, side-by-side tables and learning curves.
const Fields<ScoredRuns>& page_fields() {
    using S = ScoredRuns;
    static const Fields<S> all =
        Fields<S>("debriefing")
            .titled([](const S& s) { return last(s).task.title; })
            .warnings("", [](const S&) { return std::vector<std::string>{validity}; })
            .printed([](const S&) { return Where::pages; })
            .text("", "task", [](const S& s) { return last(s).task.about; })
            .on_pages()
            .number("", "removed", fixed(1, "mm³"), [](const S& s) { return last(s).removed_mm3; })
            .on_pages()
            .number("", "largest force", fixed(1, "N"), [](const S& s) { return last(s).max_N; })
            .on_pages()
            .text("", "pictures of the bone",
                  [](const S& s) { return s.pictures.missing.empty() ? std::string() : "none: " + s.pictures.missing; })
            .on_pages()
            .figure(
                "depth, distance from the plan and force over time", [](const S& s) { return s.pictures.is_drawn; },
                [](const S& s) { return draw_attempt(last(s)); })
            .children("", "cut", picture_fields(), [](const S& s) -> const auto& { return s.pictures.cuts; })
            .on_pages()
            .table("Scores", side_by_side)
            .on_pages()
            .figure(
                "Learning curve", [](const S& s) { return s.pictures.is_drawn && !drawn_curves(s).empty(); },
                draw_curves)
            .notes("", "How to read the scores",
                   [](const S&) {
                       return std::vector<std::string>{
                           "Greater is worse, except for the nearest distance; for mean force and strokes neither is.",
                           "Percentile: percent of the reference group that did worse.",
                           "What each measure is: docs/reference/scores.md."};
                   })
            .on_pages();
    return all;
}

const Fields<ScoredRuns>& one_fields() {
    using S = ScoredRuns;
    static const Fields<S> all =
        Fields<S>("scores of an attempt")
            .part(score_fields(), [](const S& s) -> const Score& { return last(s).score; })
            .children("", "attempt", printed_fields(), [](const S& s) { return std::vector{Attempt{&last(s), {}}}; })
            .part(page_fields(), same<S>)
            .text("", "scores", [](const S&) { return "are not validated"; });
    return all;
}

const Fields<ScoredRuns>& many_fields() {
    using S = ScoredRuns;
    static const Fields<S> all =
        Fields<S>("scores of several attempts")
            .text("validity", "", [](const S&) { return not_validated; })
            .children("rows", "attempt", row_fields(),
                      [](const S& s) {
                          std::vector<Attempt> attempts;
                          for (const ScoredRun& run : s.runs) attempts.push_back({&run, s.reference});
                          return attempts;
                      })
            .rows("learning", "", curve_fields(), [](const S& s) { return analysis::learning_curves(s.runs); })
            .rows("reference", "", reference_fields(), [](const S& s) -> const auto& { return s.reference; })
            .omitted()
            .part(page_fields(), same<S>)
            .text("", "scores", [](const S&) { return "are not validated"; });
    return all;
}

display::Figure figure_of(const display::Image& image) {
    display::Figure figure(image.width, image.height);
    figure.picture(0.0, 0.0, image.width, image.height, image);
    return figure;
}

}  // namespace

AttemptPictures pictures_of(const ScoredRun& run) {
    AttemptPictures all;
    all.is_drawn = true;
    try {
        for (std::size_t n = 0; n < run.task.cuts.size(); ++n) {
            const training::PlannedCut& cut = run.task.cuts[n];
            all.cuts.push_back({run.task.cuts.size() > 1 ? "Cut " + cut.name : "Cut", figure_of(draw_cut_bone(run, n)),
                                figure_of(draw_cut_face(run, n)),
                                fmt::format("blue and red: {:.2g} mm or more to either side", 2e3 * cut.tolerance)});
        }
    } catch (const Error& error) {
        all.cuts.clear();
        all.missing = error.what();
    }
    return all;
}

Result score_result(const ScoredRuns& runs) {
    return (runs.runs.size() == 1 && runs.reference.empty() ? one_fields() : many_fields()).of(runs);
}

std::vector<file::Json> score_schemas() { return {one_fields().schema(), many_fields().schema()}; }

std::string score_table(std::span<const ScoredRun> runs) {
    std::vector<std::string> columns{"run", "trainee", "task"};
    for (const analysis::Measure& measure : analysis::measures()) columns.push_back(measure.name);
    columns.emplace_back("validity");
    std::vector<file::Json> rows;
    for (const ScoredRun& run : runs) {
        file::Json row{
            {"run", run.name}, {"trainee", run.trainee}, {"task", run.task.title}, {"validity", not_validated}};
        for (const analysis::Measure& measure : analysis::measures())
            if (const auto value = measure.of(run.score)) row[measure.name] = *value;
        rows.push_back(std::move(row));
    }
    return csv_table(columns, rows);
}

}  // namespace tactus::report
