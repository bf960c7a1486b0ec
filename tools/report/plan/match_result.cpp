// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/match_result.hpp"

#include "dsp/core/constants.hpp"
#include "tools/report/bone/pose_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tactus::report {

namespace {

using analysis::FragmentResidual;
using fit::FragmentMatch;
using Areas = std::vector<std::pair<std::string, double>>;
using Residual = std::pair<std::string, FragmentResidual>;

template <class Value>
auto if_met(Value value) {
    return [value](const JudgedMatch& m) {
        return m.has_met() ? std::optional<double>(std::invoke(value, m.found.match)) : std::nullopt;
    };
}

std::vector<std::string> notes_of(const JudgedMatch& m) {
    std::vector<std::string> notes;
    const auto add = [&notes](std::string note) {
        if (!note.empty()) notes.push_back(std::move(note));
    };
    const std::string moving = m.name_of(m.found.match.moving);
    if (!m.part.empty())
        add(fmt::format("{} {} apart: {}", fmt::join(m.part, ", "), m.part.size() > 1 ? "stay" : "stays", m.reason));
    else if (!m.has_met()) add(fmt::format("{} stays where it is: {}", moving, m.reason));
    else {
        const std::string bound = bound_words(m.found.match.verdict, m.found.match.bound);
        add(bound.empty() ? fmt::format("{} stays where it was", moving) : fmt::format("{}: {}", moving, bound));
        add(m.reason);
    }
    if (m.found.is_apart)
        add(fmt::format("'{}' is not connected to what stands, and nothing of that fits '{}'; see 'tactus plan check'",
                        m.name_of(m.found.match.partner), moving));
    if (m.found.as_scanned && m.reason != as_scanned_note) add(as_scanned_note);
    return notes;
}

std::vector<std::string> notes_of(const std::vector<JudgedMatch>& all) {
    std::vector<std::string> notes;
    for (const JudgedMatch& m : all)
        for (std::string& note : notes_of(m)) notes.push_back(std::move(note));
    return notes;
}

std::vector<std::string> left_out_notes(const Areas& areas) {
    std::vector<std::string> notes;
    for (const auto& [name, area] : areas) notes.push_back(left_out_words(name, area));
    return notes;
}

/// {fragment: mm²}
Areas in_mm2(Areas areas) {
    for (auto& [name, area] : areas) area *= 1e6;
    return areas;
}

const Fields<JudgedMatch>& stays_fields() {
    static const Fields<JudgedMatch> all =
        Fields<JudgedMatch>("match of a fragment that stays")
            .part(match_fields(), [](const JudgedMatch& m) -> const auto& { return m; })
            .texts("part", "", &JudgedMatch::part);
    return all;
}

const Fields<Residual>& residual_fields() {
    static const Fields<Residual> all =
        Fields<Residual>("a fragment's faces on others")
            .text("fragment", "fragment", [](const Residual& r) { return r.first; })
            .number("rms_mm", "rms", from_si(3, "mm"),
                    [](const Residual& r) { return r.second.faces > 0 ? std::optional(r.second.rms) : std::nullopt; })
            .number("overlap_mm2", "faces on others", from_si(0, "mm²"),
                    [](const Residual& r) { return r.second.area; })
            .integer("faces", "pairs of faces", [](const Residual& r) { return r.second.faces; });
    return all;
}

struct TargetMedians {
    double before;
    std::optional<double> there;
    bool is_as_scanned;

    std::optional<double> there_if(bool as_scanned) const { return as_scanned == is_as_scanned ? there : std::nullopt; }
};

const Fields<TargetMedians>& median_fields() {
    static const Fields<TargetMedians> all =
        Fields<TargetMedians>("median distance from the healthy side")
            .number("median_before_mm", "where it was", from_si(2, "mm"), &TargetMedians::before)
            .number("median_there_mm", "", from_si(2, "mm"), &TargetMedians::there)
            .number("", "where the scan has it", from_si(2, "mm"),
                    [](const TargetMedians& t) { return t.there_if(true); })
            .number("", "where its faces fit", from_si(2, "mm"),
                    [](const TargetMedians& t) { return t.there_if(false); });
    return all;
}

}  // namespace

Areas areas_left_out(const plan::CasePlan& plan, const analysis::PlanMatching& matching,
                     const fit::Arrangement& shown) {
    Areas areas;
    for (int n = 0; n < static_cast<int>(shown.size()); ++n)
        if (const double area = matching.as_scanned_area(n); area > 0.0 && !shown.is_hidden(n))
            areas.emplace_back(plan.fragments[static_cast<std::size_t>(n)].name, area);
    return areas;
}

const Fields<JudgedMatch>& match_fields() {
    using M = JudgedMatch;
    const auto named = [](auto number) {
        return [number](const M& m) {
            const int n = std::invoke(number, m.found);
            return n == fit::Arrangement::none ? std::nullopt : std::optional(m.name_of(n));
        };
    };
    static const Fields<M> all =
        Fields<M>("match of a fragment")
            .text("fragment", "fragment", [](const M& m) { return m.name_of(m.found.match.moving); })
            .text("partner", "to", named([](const analysis::PlanMatch& found) { return found.match.partner; }))
            .text("verdict", "verdict", [](const M& m) { return std::string(fit::name_of(m.found.match.verdict)); })
            .text("answer", "", [](const M& m) { return std::string(fit::answer_of(m.found.match.verdict)); })
            .child("bound", "", bound_fields(),
                   [](const M& m) { return m.has_met() ? std::optional(m.found.match.bound) : std::nullopt; })
            .flag("placed", "", [](const M& m) { return m.found.match.verdict == fit::FitVerdict::fit; })
            .text("reason", "", [](const M& m) { return m.reason.empty() ? std::nullopt : std::optional(m.reason); })
            .flag("as_scanned", "", [](const M& m) { return m.found.as_scanned; })
            .text("inside", "would lie in", named(&analysis::PlanMatch::inside))
            .flag("apart", "", [](const M& m) { return m.found.is_apart; })
            .integer("faces", "faces", [](const M& m) { return m.found.match.faces; })
            .number("score", "score", fixed(2), if_met([](const FragmentMatch& f) { return f.quality.score; }))
            .number("margin", "margin", fixed(2), if_met(&FragmentMatch::margin))
            .number("held_at_far_end_mm", "", from_si(2, "mm"),
                    if_met([](const FragmentMatch& f) { return f.precision.far; }))
            .number("held_deg", "", from_si(2, "°"), if_met([](const FragmentMatch& f) { return f.precision.turn; }))
            .number("overlap_mm2", "on each other", from_si(0, "mm²"),
                    if_met([](const FragmentMatch& f) { return f.quality.overlap; }))
            .number("rms_mm", "rms", from_si(3, "mm"), if_met([](const FragmentMatch& f) { return f.quality.rms; }))
            .number("gap_mm", "gap", from_si(2, "mm"), if_met([](const FragmentMatch& f) { return f.quality.gap; }))
            .number("penetration_mm", "", from_si(2, "mm"),
                    if_met([](const FragmentMatch& f) { return f.quality.penetration; }))
            .child("pose", "", pose_fields(),
                   [](const M& m) { return m.has_met() ? std::optional(m.found.match.pose) : std::nullopt; })
            .child("moved", "", motion_fields(),
                   [](const M& m) { return m.has_met() ? std::optional(m.found.moved) : std::nullopt; })
            .text("paint", "", [](const M& m) { return std::string(m.found.was_painted ? "file" : "proposed"); });
    return all;
}

const Fields<SnappedFragment>& snapped_fields() {
    using S = SnappedFragment;
    static const Fields<S> all =
        Fields<S>("fit of a fragment of a plan")
            .part(match_fields(), [](const S& s) -> const JudgedMatch& { return s.match; })
            .notes("", "note",
                   [](const S& s) {
                       std::vector<std::string> notes = notes_of(s.match);
                       const FragmentMatch& match = s.match.found.match;
                       if (s.is_moved && match.verdict == fit::FitVerdict::uncertain)
                           notes.push_back(fmt::format("{} is put there; 'tactus plan accept' settles it",
                                                       s.match.name_of(match.moving)));
                       return notes;
                   })
            .flag("moved_there", "moved there", &S::is_moved)
            .numbers("as_scanned_mm2", [](const S& s) { return in_mm2(s.left_out); })
            .notes("", "left out", [](const S& s) { return left_out_notes(s.left_out); })
            .child("target", "distance from the healthy side, median", median_fields(),
                   [](const S& s) {
                       return s.target
                                  ? std::optional(TargetMedians{
                                        s.target->before, s.has_place ? std::optional(s.target->there) : std::nullopt,
                                        s.match.found.as_scanned})
                                  : std::nullopt;
                   })
            .omitted();
    return all;
}

const Fields<SettledFragments>& settled_fields() {
    using S = SettledFragments;
    static const Fields<S> all = Fields<S>("fits of fragments, each against all its neighbours")
                                     .rows("rows", "fits", match_fields(), &S::rows)
                                     .notes("", "note", [](const S& s) { return notes_of(s.rows); })
                                     .notes("", "connections", &S::connections)
                                     .groups("assemblies", "", &S::assemblies);
    return all;
}

const Fields<AssembledFragments>& assembled_fields() {
    using A = AssembledFragments;
    static const Fields<A> all = Fields<A>("assembly of the fragments of a plan")
                                     .warnings("problems", &A::problems, "problem")
                                     .flag("ok", "assembled", &A::is_done)
                                     .rows("placed", "placed", match_fields(), &A::placed)
                                     .rows("stays", "stays", stays_fields(), &A::stays)
                                     .notes("", "note",
                                            [](const A& a) {
                                                std::vector<std::string> notes = notes_of(a.placed);
                                                for (std::string& note : notes_of(a.stays)) notes.push_back(note);
                                                return notes;
                                            })
                                     .rows("residuals", "residuals", residual_fields(), &A::residuals)
                                     .numbers("as_scanned_mm2", [](const A& a) { return in_mm2(a.left_out); })
                                     .notes("", "left out", [](const A& a) { return left_out_notes(a.left_out); })
                                     .notes("", "connections", &A::connections)
                                     .groups("assemblies", "", &A::assemblies);
    return all;
}

}  // namespace tactus::report
