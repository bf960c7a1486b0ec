// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/plan_result.hpp"

#include "dsp/core/constants.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/plan/plan_vessels.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/report/bone/pose_fields.hpp"
#include "tools/report/plan/plan_scenes.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"
#include "tools/report/reconstruction/flap_result.hpp"
#include "tools/report/reconstruction/warning_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

namespace tactus::report {

namespace {

using analysis::NamedDeviation;
using reconstruction::SegmentDeviation;

/// A fragment of a plan where it lies.
struct PlacedFragment {
    const ShownPlan* of;
    int n;

    const plan::PlanFragment& fragment() const { return of->plan.fragments[static_cast<std::size_t>(n)]; }
    const std::optional<plan::PlanFit>& fit() const { return of->state.fits[static_cast<std::size_t>(n)]; }
    Pose pose() const { return of->state.arrangement.pose(n); }
    bool is_void() const { return fit() && !of->state.holds(n); }
    /// Its fit, if that holds.
    template <class Value>
    std::optional<double> held(Value value) const {
        return fit() && !is_void() ? std::optional<double>(std::invoke(value, *fit())) : std::nullopt;
    }
    /// The groups that hold it, innermost first.
    std::vector<std::string> groups() const {
        std::vector<std::string> names;
        const fit::Arrangement& a = of->state.arrangement;
        for (int g = a.group_of(n); g != fit::Arrangement::none; g = a.parent_of(g))
            names.push_back(of->state.group_names[static_cast<std::size_t>(g)]);
        return names;
    }
    std::string marks() const {
        std::vector<std::string> marks;
        if (of->state.arrangement.is_locked(n)) marks.emplace_back("locked");
        if (of->state.arrangement.is_hidden(n)) marks.emplace_back("hidden");
        for (const std::string& group : groups()) marks.push_back(fmt::format("in '{}'", group));
        return fmt::format("{}", fmt::join(marks, ", "));
    }
};

const Fields<fit::Arrangement::Departure>& departure_fields() {
    using D = fit::Arrangement::Departure;
    static const Fields<D> all = Fields<D>("motion since a fit")
                                     .number("distance_mm", "", from_si(2, "mm"), &D::distance)
                                     .number("angle_deg", "", from_si(2, "°"), &D::angle);
    return all;
}

const Fields<PlacedFragment>& fit_fields() {
    using F = PlacedFragment;
    const auto of = [](auto member) { return [member](const F& f) { return *f.fit().*member; }; };
    using Fit = plan::PlanFit;
    static const Fields<F> all =
        Fields<F>("last fit of a fragment; its verdict is \"void\" if it or its partner has moved since")
            .text("partner", "", of(&Fit::partner))
            .text("verdict", "", [](const F& f) { return f.is_void() ? std::string("void") : f.fit()->verdict; })
            .child("moved_since", "", departure_fields(),
                   [](const F& f) { return f.of->state.arrangement.departure(f.n); })
            .number("score", "", fixed(2), of(&Fit::score))
            .number("margin", "", fixed(2), of(&Fit::margin))
            .number("rms_mm", "", from_si(3, "mm"), of(&Fit::rms))
            .number("gap_mm", "", from_si(2, "mm"), of(&Fit::gap))
            .number("penetration_mm", "", from_si(2, "mm"), of(&Fit::penetration))
            .number("overlap_mm2", "", from_si(0, "mm²"), of(&Fit::overlap));
    return all;
}

/// Of a report: how far the middle was moved, m.
std::optional<double> moved(const PlacedFragment& f) {
    if (!f.of->drawn) return std::nullopt;
    const Vec3 middle = f.of->drawn->middle(static_cast<std::size_t>(f.n));
    return glm::length(f.pose().apply(middle) - middle);
}

std::optional<double> from_healthy(const PlacedFragment& f) {
    return f.of->drawn ? f.of->drawn->to_healthy[static_cast<std::size_t>(f.n)] : std::nullopt;
}

const Fields<PlacedFragment>& fragment_fields() {
    using F = PlacedFragment;
    using Fit = plan::PlanFit;
    const auto held = [](auto member) { return [member](const F& f) { return f.held(member); }; };
    static const Fields<F> all =
        Fields<F>("fragment of a plan")
            .text("name", "fragment", [](const F& f) { return f.fragment().name; })
            .text("file", "", [](const F& f) { return f.of->state.files[static_cast<std::size_t>(f.n)].file; })
            .child("pose", "", pose_fields(), &F::pose)
            .vector("", "at", from_si(2, "mm"), [](const F& f) { return f.pose().position; })
            .number("", "moved", from_si(2, "mm"), moved)
            .number("", "rotated", fixed(2, "°"), [](const F& f) { return analysis::angle_deg(f.pose()); })
            .texts("groups", "", &F::groups)
            .flag("locked", "", [](const F& f) { return f.of->state.arrangement.is_locked(f.n); })
            .flag("hidden", "", [](const F& f) { return f.of->state.arrangement.is_hidden(f.n); })
            .text("", "fit", [](const F& f) { return analysis::fit_words(f.of->state, f.n); })
            .judged([](const F& f) { return f.is_void() ? Severity::fail : Severity::none; })
            .number("", "score", fixed(2), held(&Fit::score))
            .number("", "margin", fixed(2), held(&Fit::margin))
            .number("", "rms", from_si(3, "mm"), held(&Fit::rms))
            // Plans of earlier versions do not contain it.
            .number("", "fitted area", from_si(0, "mm²"),
                    [](const F& f) {
                        const auto area = f.held(&Fit::overlap);
                        return area && *area > 0.0 ? area : std::nullopt;
                    })
            .number("", "from the healthy side", from_si(2, "mm"), from_healthy)
            .text("", "marks", &F::marks)
            .child("fit", "", fit_fields(), [](const F& f) { return f.fit() ? std::optional(f) : std::nullopt; })
            .marked([](const F& f) { return f.of->drawn ? std::optional(f.fragment().colour) : std::nullopt; });
    return all;
}

const Fields<PlacedFragment>& pose_row_fields() {
    using F = PlacedFragment;
    static const Fields<F> all = Fields<F>("pose of a fragment")
                                     .text("", "fragment", [](const F& f) { return f.fragment().name; })
                                     .part(pose_fields(), &F::pose);
    return all;
}

std::vector<PlacedFragment> fragments_of(const ShownPlan& of) {
    std::vector<PlacedFragment> all;
    for (int n = 0; n < static_cast<int>(of.plan.fragments.size()); ++n) all.push_back({&of, n});
    return all;
}

struct GroupOfPlan {
    std::string name;
    std::optional<std::string> in;
};

const Fields<GroupOfPlan>& group_fields() {
    static const Fields<GroupOfPlan> all =
        Fields<GroupOfPlan>("group of fragments").text("name", "", &GroupOfPlan::name).text("in", "", &GroupOfPlan::in);
    return all;
}

std::vector<GroupOfPlan> groups_of(const ShownPlan& of) {
    std::vector<GroupOfPlan> all;
    const plan::PlanState& state = of.state;
    const auto name = [&state](int g) { return state.group_names[static_cast<std::size_t>(g)]; };
    for (int g = 0; g < static_cast<int>(state.arrangement.max_groups()); ++g) {
        if (!state.arrangement.exists(g)) continue;
        const int parent = state.arrangement.parent_of(g);
        all.push_back({name(g), parent == fit::Arrangement::none ? std::nullopt : std::optional(name(parent))});
    }
    return all;
}

struct CountedAlternative {
    std::string name;
    std::size_t steps;
};

const Fields<CountedAlternative>& alternative_fields() {
    static const Fields<CountedAlternative> all = Fields<CountedAlternative>("alternative of a plan")
                                                      .text("name", "alternative", &CountedAlternative::name)
                                                      .integer("steps", "steps", &CountedAlternative::steps);
    return all;
}

std::size_t steps_to(const ShownPlan& of, int end) { return fit::steps_to(of.plan.before(), end).size(); }

std::vector<CountedAlternative> alternatives_of(const ShownPlan& of) {
    std::vector<CountedAlternative> all;
    for (const plan::PlanAlternative& a : of.plan.alternatives) all.push_back({a.name, steps_to(of, a.place.head)});
    return all;
}

const Fields<SegmentDeviation::Curve>& curve_fields() {
    using C = SegmentDeviation::Curve;
    static const Fields<C> all = Fields<C>("axis of a segment from the middle of the target")
                                     .number("rms", "", from_si(1, "mm"), &C::rms)
                                     .number("greatest", "", from_si(1, "mm"), &C::greatest);
    return all;
}

const Fields<SegmentDeviation::Contour>& contour_fields() {
    using C = SegmentDeviation::Contour;
    static const Fields<C> all = Fields<C>("surface of a segment from that of the target, positive beyond it")
                                     .number("rms", "", from_si(1, "mm"), &C::rms)
                                     .number("lowest", "", from_si(1, "mm"), &C::lowest)
                                     .number("highest", "", from_si(1, "mm"), &C::highest)
                                     .number("share", "", fixed(0, "%", "1"), &C::share);
    return all;
}

const Fields<NamedDeviation>& deviation_fields() {
    using D = NamedDeviation;
    const auto curve = [](auto member) {
        return [member](const D& d) {
            return d.deviation.curve ? std::optional(*d.deviation.curve.*member) : std::nullopt;
        };
    };
    const auto contour = [](auto member) {
        return [member](const D& d) {
            return d.deviation.contour ? std::optional(*d.deviation.contour.*member) : std::nullopt;
        };
    };
    using Curve = SegmentDeviation::Curve;
    using Contour = SegmentDeviation::Contour;
    static const Fields<D> all =
        Fields<D>("deviation of a segment from the target")
            .text("segment", "segment", &D::segment)
            .number("", "curve, rms", from_si(1, "mm"), curve(&Curve::rms))
            .number("", "curve, greatest", from_si(1, "mm"), curve(&Curve::greatest))
            .number("", "contour, rms", from_si(1, "mm"), contour(&Contour::rms))
            .number("", "contour, lowest", from_si(1, "mm").with_sign(), contour(&Contour::lowest))
            .number("", "contour, highest", from_si(1, "mm").with_sign(), contour(&Contour::highest))
            .number("", "facing the target", fixed(0, "%", "1"), contour(&Contour::share))
            .child("curve_mm", "", curve_fields(), [](const D& d) { return d.deviation.curve; })
            .child("contour_mm", "", contour_fields(), [](const D& d) { return d.deviation.contour; });
    return all;
}

/// A vessel of the case; in a report with the bone nearest to it.
struct VesselOfCase {
    const ShownPlan* of;
    const reconstruction::FlapVessel* vessel;
    const analysis::VesselClearance* clearance;  ///< null: not measured
};

const Fields<VesselOfCase>& case_vessel_fields() {
    using V = VesselOfCase;
    const auto nearest = [](analysis::VesselClearance::Nearest analysis::VesselClearance::* when) {
        return [when](const V& v) {
            const int n = v.clearance ? (v.clearance->*when).fragment : -1;
            return n < 0 ? std::string() : v.of->plan.fragments[static_cast<std::size_t>(n)].name;
        };
    };
    const auto gap = [](analysis::VesselClearance::Nearest analysis::VesselClearance::* when) {
        return [when](const V& v) {
            return v.clearance && (v.clearance->*when).fragment >= 0 ? std::optional((v.clearance->*when).gap)
                                                                     : std::nullopt;
        };
    };
    using Clear = analysis::VesselClearance;
    static const Fields<V> all =
        Fields<V>("vessel of a case")
            .text("name", "vessel", [](const V& v) { return v.vessel->name; })
            .text("kind", "kind", [](const V& v) { return std::string(reconstruction::name_of(v.vessel->kind)); })
            .number("length_mm", "length", from_si(1, "mm"), [](const V& v) { return analysis::length_of(*v.vessel); })
            .number("radius_mm", "radius", from_si(2, "mm"), [](const V& v) { return v.vessel->radius; })
            .text("", "nearest as scanned", nearest(&Clear::scanned))
            .number("", "gap", from_si(1, "mm"), gap(&Clear::scanned))
            .text("", "nearest as planned", nearest(&Clear::planned))
            .number("", "gap as planned", from_si(1, "mm"), gap(&Clear::planned))
            .judged([gap](const V& v) {
                return gap(&Clear::planned)(v).value_or(0.0) < 0.0 ? Severity::fail : Severity::none;
            })
            .marked([](const V& v) { return v.clearance ? std::optional(colour_of(*v.vessel)) : std::nullopt; });
    return all;
}

std::vector<VesselOfCase> vessels_of(const ShownPlan& of) {
    std::vector<VesselOfCase> all;
    if (!of.state.vessels) return all;
    for (std::size_t n = 0; n < of.state.vessels->size(); ++n)
        all.push_back({&of, &(*of.state.vessels)[n], of.drawn ? &of.drawn->vessels[n] : nullptr});
    return all;
}

const Fields<plan::MirrorTarget>& target_fields() {
    using M = plan::MirrorTarget;
    static const Fields<M> all =
        Fields<M>("target of a plan")
            .remark([](const M& m) {
                return fmt::format(
                    "The residual includes {}; there is no ground truth to compare with.",
                    m.is_mirrored ? "the asymmetry of the body" : "the difference between two persons or two scans");
            })
            .text("", "target", [](const M& m) { return std::string(m.words()); })
            .text("file", "file", &M::file)
            .flag("mirrored", "", &M::is_mirrored)
            .vector("plane_normal", "", fixed(4), &M::plane_normal)
            .number("plane_offset_mm", "", from_si(2, "mm"), &M::plane_offset)
            .number("residual_mm", "residual, median", from_si(2, "mm"), &M::residual);
    return all;
}

struct DoneStep {
    const ShownPlan* of;
    std::size_t number;
    const plan::PlanStep* step;
};

std::string words_of(const DoneStep& done) {
    const plan::PlanStep& step = *done.step;
    std::string what(plan::name_of(step.kind));
    for (const int f : step.fragments) what += " " + done.of->plan.fragments[static_cast<std::size_t>(f)].name;
    if (!step.group.empty()) what += fmt::format(" as '{}'", step.group);
    if (step.painted) what += " as in " + step.painted->file;
    if (step.vessels)
        for (const reconstruction::FlapVessel& vessel : *step.vessels) what += " " + vessel.name;
    if (step.mirror)
        what += fmt::format(" {}, {:.2f} mm median residual", step.mirror->file, step.mirror->residual / mm);
    if (step.fit)
        what += fmt::format(", {} to {}, {:.0f} mm² in contact, {:.3f} mm rms, gap {:.2f} mm, {:.2f} mm deep",
                            step.fit->verdict, step.fit->partner, step.fit->overlap * 1e6, step.fit->rms / mm,
                            analysis::shown_mm(step.fit->gap / mm), step.fit->penetration / mm);
    return what;
}

const Fields<DoneStep>& step_fields() {
    using S = DoneStep;
    static const Fields<S> all =
        Fields<S>("step of a plan")
            .integer("", "step", &S::number)
            .text("", "time",
                  [](const S& s) {
                      return s.step->run_second ? fmt::format("{:.3f} s", *s.step->run_second) : s.step->time;
                  })
            .text("", "by", [](const S& s) { return s.step->by; })
            .text("", "action", words_of);
    return all;
}

std::vector<DoneStep> steps_of(const ShownPlan& of) {
    std::vector<DoneStep> all;
    if (!of.drawn) return all;
    for (const int n : fit::steps_to(of.plan.before(), of.plan.place().head))
        all.push_back({&of, all.size() + 1, &of.plan.steps[static_cast<std::size_t>(n)]});
    return all;
}

std::vector<std::string> changed_files(const ShownPlan& of) {
    std::vector<std::string> texts;
    for (const analysis::CaseWarning& warning : of.warnings.all)
        if (warning.code == "changed-file") texts.push_back(warning.text);
    return texts;
}

std::vector<std::string> connections_of(const ShownPlan& of) {
    return of.state.reconstruction ? std::vector<std::string>() : analysis::connection_words(of.plan, of.state);
}

auto part_of_plan(const ShownPlan& of) { return analysis::assembly_names(of.plan, of.state); }

const Fields<ShownPlan>& made_plan_fields() {
    using P = ShownPlan;
    static Fields<P> all("plan of a case");
    all.titled([](const P& p) { return p.plan.title; }).remark([](const P& p) {
        return fmt::format("Alternative '{}', {} fragments. Research use; not a medical device.",
                           p.plan.alternatives[static_cast<std::size_t>(p.plan.current)].name, p.plan.fragments.size());
    });
    all.part(plan_warnings_fields(), [](const P& p) -> const auto& { return p.warnings.all; });
    all.text("title", "", [](const P& p) { return p.plan.title; })
        .text("current", "alternative",
              [](const P& p) { return p.plan.alternatives[static_cast<std::size_t>(p.plan.current)].name; })
        .integer("steps_done", "steps done", [](const P& p) { return steps_to(p, p.plan.place().head); })
        .integer("steps_to_redo", "steps to redo",
                 [](const P& p) { return steps_to(p, p.plan.place().tip) - steps_to(p, p.plan.place().head); })
        .integer("steps_in_all", "", [](const P& p) { return p.plan.steps.size(); })
        .notes("", "connections", connections_of)
        .groups("assemblies", "", part_of_plan)
        .texts("problems", "", changed_files)
        .flag("measured", "", [](const P& p) { return p.warnings.is_measured; })
        .text("", "not measured",
              [](const P& p) {
                  return p.warnings.is_measured
                             ? std::string()
                             : fmt::format("for this version of the plan: overlaps{}; 'tactus plan check' does",
                                           p.state.reconstruction ? ", vessels, hardware" : "");
              })
        .child("", "planned operation", reported_flap_fields(),
               [](const P& p) -> const std::optional<ReportedFlap>& { return p.flap; })
        .rows("fragments", "fragments", fragment_fields(), fragments_of)
        .rows("groups", "", group_fields(), groups_of)
        .rows("vessels", "vessels", case_vessel_fields(), vessels_of)
        .explained(
            "They stay where they were scanned. The gap is from the vessel's wall to the surface of the nearest "
            "fragment; below 0 bone lies in the vessel. 'tactus plan export' writes files of the vessels beside those "
            "of the fragments.")
        .child("mirror", "target", target_fields(), [](const P& p) -> const auto& { return p.state.mirror; })
        .child("reconstruction", "reconstruction", reconstruction_fields(),
               [](const P& p) { return p.state.reconstruction.get(); })
        .omitted()
        .rows("deviation", "deviation from the target", deviation_fields(), &P::deviation)
        .omitted()
        .explained(
            "Curve: from the segment's axis to the middle of the target within 15 mm, in sections across the axis. "
            "Contour: from the target's surface to the segment's, where both face the same way; positive beyond the "
            "target, 2.5 and 97.5 % of the area.")
        .child("", "pictures", scenes_fields(), [](const P& p) { return p.drawn ? &*p.drawn : nullptr; })
        .on_pages()
        .child("", "gaps and overlaps", drawn_gaps_fields(), [](const P& p) { return p.drawn ? &*p.drawn : nullptr; })
        .rows("", "poses", pose_row_fields(), fragments_of)
        .on_pages()
        .explained("p_plan = R p_scan + t, LPS, mm; R as a unit quaternion w x y z.")
        .rows("", "order of steps", step_fields(), steps_of)
        .text("", "order of steps",
              [](const P& p) { return std::string(p.drawn && steps_of(p).empty() ? "there are no steps" : ""); })
        .rows("alternatives", "alternatives", alternative_fields(), alternatives_of);
    return all;
}

}  // namespace

ShownPlan ShownPlan::of(const plan::CasePlan& plan, const std::filesystem::path& folder) {
    return {plan, plan::state_of(plan), analysis::known_warnings(plan, folder),
            analysis::deviation_from_target(plan, folder)};
}

ShownPlan ShownPlan::reported(const plan::CasePlan& plan, const std::filesystem::path& folder,
                              const std::function<void(double, std::string_view)>& progress) {
    const auto begin = [&progress](double done, std::string_view doing) {
        if (progress) progress(done, doing);
    };
    begin(0.0, "warnings");
    ShownPlan shown{plan, plan::state_of(plan), analysis::case_warnings(plan, folder), {}};
    begin(0.3, "deviation from the target");
    shown.deviation = analysis::deviation_from_target(plan, folder);
    begin(0.4, "gaps");
    shown.drawn = draw_plan(plan, folder);
    begin(0.7, "reconstruction");
    shown.flap = report_flap(plan, folder);
    begin(0.8, "pictures");
    return shown;
}

const Fields<ShownPlan>& plan_fields() {
    static const Fields<ShownPlan>& all = made_plan_fields();
    return all;
}

const Fields<ShownPlan>& checked_plan_fields() {
    using P = ShownPlan;
    static const Fields<P> all = [] {
        Fields<P> made("whether a plan is finished and does not contradict itself");
        made.part(plan_warnings_fields(), [](const P& p) -> const auto& { return p.warnings.all; });
        made.flag("ok", "", [](const P& p) { return !p.warnings.has_fault(); })
            .text("", "verdict",
                  [](const P& p) {
                      return std::string(
                          p.warnings.has_fault() ? "not finished"
                          : p.state.reconstruction
                              ? "all pieces are where they are planned or accepted, and none lies in another"
                              : "all shown fragments are connected, every fit holds, and none lies in another");
                  })
            .judged([](const P& p) { return p.warnings.has_fault() ? Severity::fail : Severity::pass; })
            .notes("", "connections", connections_of)
            .groups("assemblies", "", part_of_plan)
            .texts("problems", "", [](const P& p) { return texts_of(p.warnings.all, true); })
            .rows("deviation", "deviation from the target", deviation_fields(), &P::deviation)
            .omitted();
        return made;
    }();
    return all;
}

const Fields<NamedGap>& gap_fields() {
    using G = NamedGap;
    using Mutual = fit::MutualGap;
    const auto of = [](auto member) { return [member](const G& g) { return g.gap->gap.*member; }; };
    // Without surfaces that face each other there is no gap.
    const auto facing = [](auto member) {
        return
            [member](const G& g) { return g.gap->gap.facing > 0.0 ? std::optional(g.gap->gap.*member) : std::nullopt; };
    };
    static const Fields<G> all =
        Fields<G>("gap between two fragments")
            .texts("fragments", "fragments", [](const G& g) { return std::vector{g.first, g.second}; })
            .number("facing_mm2", "facing", from_si(0, "mm²"), of(&Mutual::facing))
            .number("contact_mm2", "touching", from_si(0, "mm²"), of(&Mutual::contact))
            .number("gap_median_mm", "median gap", from_si(2, "mm"), facing(&Mutual::median))
            .number("gap_p95_mm", "95 %", from_si(2, "mm"), facing(&Mutual::p95))
            .number("deepest_mm", "deepest", from_si(2, "mm"), of(&Mutual::deepest))
            .number("overlap_mm3", "overlap", from_si(1, "mm³"), [](const G& g) { return g.gap->overlap; });
    return all;
}

GapsOfPlan named_gaps(const plan::CasePlan& plan, const std::vector<analysis::PlanGap>& gaps) {
    GapsOfPlan named;
    for (const analysis::PlanGap& g : gaps)
        named.pairs.push_back({plan.fragments[static_cast<std::size_t>(g.first)].name,
                               plan.fragments[static_cast<std::size_t>(g.second)].name, &g});
    return named;
}

const Fields<GapsOfPlan>& gaps_fields() {
    static const Fields<GapsOfPlan> all =
        Fields<GapsOfPlan>("gaps between the fragments of a plan")
            .rows("pairs", "gaps and overlaps", gap_fields(), &GapsOfPlan::pairs)
            .text("", "gaps", [](const GapsOfPlan& g) {
                return std::string(g.pairs.empty() ? "no two shown fragments face each other within 3 mm" : "");
            });
    return all;
}

}  // namespace tactus::report
