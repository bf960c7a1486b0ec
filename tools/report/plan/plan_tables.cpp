// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/plan_tables.hpp"

#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <utility>

namespace tactus::report {

namespace {

/// Groups, lock and hidden state of a fragment in words.
std::string marks_of(const DrawnPlan& c, int number) {
    const fit::Arrangement& a = c.state.arrangement;
    std::vector<std::string> marks;
    for (int g = a.group_of(number); g != fit::Arrangement::none; g = a.parent_of(g))
        marks.push_back("in " + c.state.group_names[static_cast<std::size_t>(g)]);
    if (a.is_locked(number)) marks.emplace_back("locked");
    if (a.is_hidden(number)) marks.emplace_back("hidden");
    return fmt::format("{}", fmt::join(marks, ", "));
}

}  // namespace

void add_warnings(const std::vector<analysis::CaseWarning>& warnings, std::vector<ReportBlock>& out) {
    if (warnings.empty()) return;
    ReportList all{{}, true};
    for (const bool is_fault : {true, false})
        for (const analysis::CaseWarning& warning : warnings)
            if (warning.is_fault == is_fault) all.items.push_back(warning.text);
    out.emplace_back(Heading{"Warnings", true});
    out.emplace_back(std::move(all));
}

void add_connections(const DrawnPlan& c, std::vector<ReportBlock>& out) {
    ReportList list{analysis::connection_words(c.plan, c.state)};
    if (c.state.reconstruction || list.items.empty()) return;
    out.emplace_back(Heading{"Connections"});
    out.emplace_back(std::move(list));
}

ReportTable places(const DrawnPlan& c) {
    ReportTable table{{"fragment", "t, mm", "R"}, {}};
    for (std::size_t n = 0; n < c.fragments.size(); ++n) {
        const auto [t, q] = analysis::numbers_of(c.pose(n));
        table.rows.push_back({c.name(n), fmt::format("{:.3f} {:.3f} {:.3f}", t[0], t[1], t[2]),
                              fmt::format("{:.6f} {:.6f} {:.6f} {:.6f}", q[0], q[1], q[2], q[3])});
    }
    return table;
}

ReportTable fragments_table(const DrawnPlan& c) {
    ReportTable table{{"fragment", "moved, mm", "turned, °", "fitted to", "verdict", "score", "margin", "rms, mm",
                       "fitted area, mm²", "from the healthy side, mm", "marks"},
                      {}};
    for (std::size_t n = 0; n < c.fragments.size(); ++n) {
        const int number = static_cast<int>(n);
        const Vec3 middle = c.middle(n);
        std::vector<std::string> row{c.name(n),
                                     fmt::format("{:.2f}", 1e3 * glm::length(c.pose(n).apply(middle) - middle)),
                                     fmt::format("{:.2f}", analysis::angle_deg(c.pose(n)))};
        const auto& fit = c.state.fits[n];
        const bool is_void = fit && !c.state.holds(number);
        if (!fit) row.insert(row.end(), {"–", "–", "–", "–", "–", "–"});
        else if (is_void)
            row.insert(row.end(), {fit->partner, analysis::fit_words(c.state, number), "–", "–", "–", "–"});
        else
            row.insert(row.end(), {fit->partner, fit->verdict, fmt::format("{:.2f}", fit->score),
                                   fmt::format("{:.2f}", fit->margin), fmt::format("{:.3f}", fit->rms * 1e3),
                                   // Plans of earlier versions do not contain it.
                                   fit->overlap > 0.0 ? fmt::format("{:.0f}", fit->overlap * 1e6) : "–"});
        row.push_back(c.to_healthy[n] ? fmt::format("{:.2f}", *c.to_healthy[n] * 1e3) : "–");
        row.push_back(marks_of(c, number));
        table.rows.push_back(std::move(row));
        table.marks.push_back(c.plan.fragments[n].colour);
        table.warnings.push_back(is_void);
    }
    return table;
}

void add_vessels(const DrawnPlan& c, std::vector<ReportBlock>& out) {
    if (c.vessels.empty()) return;
    ReportTable table{{"vessel", "kind", "length, mm", "radius, mm", "nearest as scanned", "gap, mm",
                       "nearest as planned", "gap as planned, mm"},
                      {}};
    for (const analysis::VesselClearance& v : c.vessels) {
        std::vector<std::string> row{v.vessel->name, std::string(reconstruction::name_of(v.vessel->kind)),
                                     fmt::format("{:.1f}", analysis::length_of(*v.vessel) * 1e3),
                                     fmt::format("{:.2f}", v.vessel->radius * 1e3)};
        for (const auto& nearest : {v.scanned, v.planned}) {
            const bool is_none = nearest.fragment < 0;
            row.push_back(is_none ? "–" : c.name(static_cast<std::size_t>(nearest.fragment)));
            row.push_back(is_none ? "–" : fmt::format("{:.1f}", nearest.gap * 1e3));
        }
        table.rows.push_back(std::move(row));
        table.marks.push_back(colour_of(*v.vessel));
        table.warnings.push_back(v.planned.fragment >= 0 && v.planned.gap < 0.0);
    }
    out.emplace_back(Heading{"Vessels"});
    out.emplace_back(
        Paragraph{"They stay where they were scanned. The gap is from the vessel's wall to the surface of "
                  "the nearest fragment; below 0 bone lies in the vessel. 'tactus plan export' writes files of the "
                  "vessels beside those of the fragments."});
    out.emplace_back(std::move(table));
}

void add_mirror(const DrawnPlan& c, std::vector<ReportBlock>& out) {
    if (!c.state.mirror) return;
    const plan::MirrorTarget& target = *c.state.mirror;
    out.emplace_back(Heading{fmt::format("Target: the {}", target.words())});
    out.emplace_back(Paragraph{fmt::format(
        "{}: median distance {:.2f} mm. This residual includes {}; there is no ground truth to compare with.",
        target.file, target.residual * 1e3,
        target.is_mirrored ? "the asymmetry of the body" : "the difference between two persons or two scans")});
}

void add_steps(const DrawnPlan& c, std::vector<ReportBlock>& out) {
    ReportTable table{{"step", "time", "by", "what"}, {}};
    for (const int n : fit::steps_to(c.plan.before(), c.plan.place().head)) {
        const plan::PlanStep& step = c.plan.steps[static_cast<std::size_t>(n)];
        std::string what(plan::name_of(step.kind));
        for (const int f : step.fragments) what += " " + c.name(static_cast<std::size_t>(f));
        if (!step.group.empty()) what += fmt::format(" as '{}'", step.group);
        if (step.painted) what += " as in " + step.painted->file;
        if (step.vessels)
            for (const reconstruction::FlapVessel& vessel : *step.vessels) what += " " + vessel.name;
        if (step.mirror)
            what += fmt::format(" {}, {:.2f} mm median residual", step.mirror->file, step.mirror->residual * 1e3);
        if (step.fit)
            what += fmt::format(", {} to {}, {:.0f} mm² in contact, {:.3f} mm rms, gap {:.2f} mm, {:.2f} mm deep",
                                step.fit->verdict, step.fit->partner, step.fit->overlap * 1e6, step.fit->rms * 1e3,
                                analysis::shown_mm(step.fit->gap * 1e3), step.fit->penetration * 1e3);
        table.rows.push_back({fmt::format("{}", table.rows.size() + 1),
                              step.run_second ? fmt::format("{:.3f} s", *step.run_second) : step.time, step.by, what});
    }
    out.emplace_back(Heading{"Order of steps"});
    if (table.rows.empty()) out.emplace_back(Paragraph{"There are no steps."});
    else out.emplace_back(std::move(table));
}

ReportList alternatives(const plan::CasePlan& plan) {
    ReportList list;
    for (const plan::PlanAlternative& a : plan.alternatives)
        list.items.push_back(
            fmt::format("{}: {}", a.name, counted(fit::steps_to(plan.before(), a.place.head).size(), "step")));
    return list;
}

}  // namespace tactus::report
