// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/flap_result.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/rope/measure.hpp"
#include "tools/analysis/plan/flap_words.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"
#include "tools/report/reconstruction/warning_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::report {

namespace {

using namespace reconstruction;

template <class T>
std::string kind_of(const T& of) {
    return reconstruction::name_of(of.kind);
}

std::string leg_of(Leg leg) { return leg == Leg::left ? "left" : "right"; }

const Fields<FlapVessel>& vessel_fields() {
    static const Fields<FlapVessel> all = Fields<FlapVessel>("vessel")
                                              .text("name", "vessel", &FlapVessel::name)
                                              .text("kind", "kind", kind_of<FlapVessel>)
                                              .number("radius_mm", "radius", from_si(2, "mm"), &FlapVessel::radius)
                                              .number("length_mm", "length", from_si(1, "mm"),
                                                      [](const FlapVessel& v) { return rope::length_of(v.points); });
    return all;
}

const Fields<Perforator>& perforator_fields() {
    static const Fields<Perforator> all = Fields<Perforator>("perforator of the leg")
                                              .text("name", "perforator", &Perforator::name)
                                              .vector("at_mm", "at", from_si(1, "mm"), &Perforator::at);
    return all;
}

const Fields<RecipientSite>& site_fields() {
    static const Fields<RecipientSite> all = Fields<RecipientSite>("vessel of the neck")
                                                 .text("name", "site", &RecipientSite::name)
                                                 .text("kind", "kind", kind_of<RecipientSite>)
                                                 .vector("at_mm", "at", from_si(1, "mm"), &RecipientSite::at);
    return all;
}

const Fields<Plate>& plate_fields() {
    static const Fields<Plate> all =
        Fields<Plate>("plate")
            .text("name", "plate", &Plate::name)
            .number("width_mm", "width", from_si(1, "mm"), &Plate::width)
            .number("thickness_mm", "thickness", from_si(1, "mm"), &Plate::thickness)
            .number("length_mm", "length", from_si(1, "mm"), [](const Plate& p) { return rope::length_of(p.points); })
            .integer("screws", "screws", [](const Plate& p) { return p.screws.size(); });
    return all;
}

const Fields<DentalImplant>& implant_fields() {
    using I = DentalImplant;
    static const Fields<I> all = Fields<I>("dental implant")
                                     .text("name", "implant", &I::name)
                                     .vector("head_mm", "head", from_si(1, "mm"), &I::head)
                                     .vector("axis", "axis", fixed(2), &I::axis)
                                     .number("diameter_mm", "diameter", from_si(1, "mm"), &I::diameter)
                                     .number("length_mm", "length", from_si(1, "mm"), &I::length);
    return all;
}

const Fields<SkinPaddle>& skin_fields() {
    static const Fields<SkinPaddle> all = Fields<SkinPaddle>("skin paddle")
                                              .vector("at_mm", "at", from_si(1, "mm"), &SkinPaddle::at)
                                              .number("length_mm", "length", from_si(0, "mm"), &SkinPaddle::length)
                                              .number("width_mm", "width", from_si(0, "mm"), &SkinPaddle::width);
    return all;
}

/// Those of candidates are without points.
Fields<SiteReach> made_reach_fields(bool with_points) {
    using R = SiteReach;
    Fields<R> all("vessel of a flap and a site");
    all.text("vessel", "vessel", &R::vessel)
        .text("site", "site", &R::site)
        .text("kind", "", kind_of<R>)
        .text("reach", "verdict", [](const R& r) { return std::string(name_of(r.reach)); })
        .number("in_situ_mm", "in the leg", from_si(1, "mm"), &R::in_situ)
        .number("free_mm", "free", from_si(1, "mm"), &R::free)
        .number("path_mm", "path", from_si(1, "mm"), &R::path)
        .flag("path_settled", "", &R::is_settled)
        .text("", "path", [](const R& r) { return std::string(r.is_settled ? "" : "did not settle"); })
        .number("slack_mm", "slack", from_si(1, "mm"), &R::slack)
        .number("strain", "strain", fixed(1, "%", "1"), &R::strain)
        .number("tension_n", "tension", fixed(2, "N"), &R::tension)
        .number("bend_radius_mm", "", from_si(1, "mm"), &R::bend_radius)
        .text("", "bend, mm",
              [](const R& r) {
                  return std::isfinite(r.bend_radius) ? fmt::format("{:.1f}", r.bend_radius / mm)
                                                      : std::string("straight");
              })
        .number("twist_deg", "twist", from_si(0, "°"), &R::twist)
        .number("contact_mm", "on bone", from_si(1, "mm"), &R::contact)
        .number("to_plate_mm", "to plate", from_si(1, "mm"), &R::to_plate)
        .number("to_screw_mm", "to screw", from_si(1, "mm"), &R::to_screw);
    if (with_points) all.points("points_mm", [](const R& r) { return series_of(r.points, mm); });
    return all;
}

const Fields<SpanReach>& span_fields() {
    using S = SpanReach;
    static const Fields<S> all =
        Fields<S>("vessel between two segments")
            .text("vessel", "vessel", &S::vessel)
            .integers("segments", "", [](const S& s) { return std::array{s.first, s.second}; })
            .text("", "between segments",
                  [](const S& s) { return fmt::format("{} and {}", s.first + 1, s.second + 1); })
            .number("in_situ_mm", "in the leg", from_si(1, "mm"), &S::in_situ)
            .number("path_mm", "in the jaw", from_si(1, "mm"), &S::path)
            .number("strain", "strain", fixed(1, "%", "1"), &S::strain);
    return all;
}

const Fields<Clearance>& clearance_fields() {
    using C = Clearance;
    static const Fields<C> all = Fields<C>("nearest thing of a kind")
                                     .text("object", "object", &C::object)
                                     .text("to", "nearest", [](const C& c) { return std::string(name_of(c.nearness)); })
                                     .text("other", "name", &C::other)
                                     .number("distance_mm", "distance", from_si(1, "mm"), &C::distance);
    return all;
}

struct CodedText {
    std::string code, text;
};

const Fields<CodedText>& coded_fields() {
    static const Fields<CodedText> all =
        Fields<CodedText>("warning").text("code", "", &CodedText::code).text("text", "", &CodedText::text);
    return all;
}

std::vector<CodedText> warnings_of(const Candidate& c) {
    std::vector<CodedText> all;
    for (const FibulaWarning& w : c.plan.warnings) all.push_back({name_of(w.code), w.text});
    for (const FlapWarning& w : c.measures.warnings) all.push_back({name_of(w.code), w.text});
    return all;
}

/// The least strained one of a kind.
std::string best_reach(const Candidate& c, VesselKind kind) {
    const SiteReach* best = nullptr;
    for (const SiteReach& r : c.measures.reaches)
        if (r.kind == kind && (!best || r.strain < best->strain)) best = &r;
    return best ? name_of(best->reach) : "";
}

std::vector<std::string> reasons_of(const Candidate& c) {
    if (!c.excluded.empty()) return {"excluded: " + c.excluded};
    std::vector<std::string> texts;
    for (const FlapWarning& w : c.measures.warnings) texts.push_back(w.text);
    return texts;
}

const Fields<skin::PaddleRope>& rope_fields() {
    using R = skin::PaddleRope;
    static const Fields<R> all = Fields<R>("perforator of a skin paddle")
                                     .text("name", "perforator", &R::name)
                                     .vector("bone_mm", "", from_si(1, "mm"), &R::bone)
                                     .vector("skin_mm", "", from_si(1, "mm"), &R::skin)
                                     .number("distance_mm", "bone to skin", from_si(1, "mm"), &R::distance)
                                     .number("slack_mm", "slack", from_si(1, "mm"), &R::slack)
                                     .judged([](const R& r) { return r.slack < 0.0 ? Severity::fail : Severity::none; })
                                     .number("tension_N", "tension", fixed(2, "N"), &R::tension);
    return all;
}

}  // namespace

const Fields<Reconstruction>& reconstruction_fields() {
    using R = Reconstruction;
    const auto flap = [](auto member) { return [member](const R& r) -> const auto& { return r.flap.*member; }; };
    const auto file = [](std::optional<MeshFile> R::* member) {
        return [member](const R& r) { return r.*member ? std::optional((r.*member)->file) : std::nullopt; };
    };
    static const Fields<R> all =
        Fields<R>("reconstruction of a jaw")
            .text("donor", "donor", [](const R& r) { return r.donor.file; })
            .text("jaw", "jaw", file(&R::jaw))
            .text("tumour", "tumour", file(&R::tumour))
            .number("margin_mm", "margin of the tumour", from_si(1, "mm"), [](const R& r) { return r.flap.margin; })
            .text("leg", "leg", [](const R& r) { return leg_of(r.inputs.leg); })
            .integer("planes", "", [](const R& r) { return r.inputs.planes.size(); })
            .integer("", "segments", [](const R& r) { return r.inputs.planes.size() - 1; })
            .flag("reversed", "reversed", [](const R& r) { return r.inputs.reversed; })
            .number("roll_deg", "rotated about its axis", from_si(1, "°"), [](const R& r) { return r.inputs.roll; })
            .text("resection", "resection", [](const R& r) { return std::string(name_of(r.inputs.resection)); })
            .rows("vessels", "vessels", vessel_fields(), flap(&Flap::vessels))
            .rows("perforators", "perforators", perforator_fields(), flap(&Flap::perforators))
            .rows("sites", "sites", site_fields(), flap(&Flap::sites))
            .rows("plates", "plates", plate_fields(), flap(&Flap::plates))
            .rows("implants", "implants", implant_fields(), flap(&Flap::implants))
            .child("paddle", "skin paddle", skin_fields(), flap(&Flap::paddle));
    return all;
}

const Fields<FlapMeasures>& flap_measures_fields() {
    static const Fields<SiteReach> reach = made_reach_fields(true);
    static const Fields<FlapMeasures> all =
        Fields<FlapMeasures>("reach of the vessels of a flap, and clearances")
            .number("tumour_margin_mm", "tumour to the nearest cut of the jaw", from_si(1, "mm"),
                    &FlapMeasures::tumour_margin)
            .rows("reaches", "vessels and sites", reach, &FlapMeasures::reaches)
            .rows("spans", "vessels between segments", span_fields(), &FlapMeasures::spans)
            .rows("clearances", "clearances", clearance_fields(), &FlapMeasures::clearances);
    return all;
}

const Fields<RankedCandidate>& candidate_fields() {
    using C = RankedCandidate;
    static const Fields<SiteReach> reach = made_reach_fields(false);
    static const Fields<C> all =
        Fields<C>("candidate")
            .integer("", "rank", &C::rank)
            .text("", "candidate", [](const C& c) { return analysis::candidate_words(*c.candidate); })
            .text("", "artery", [](const C& c) { return best_reach(*c.candidate, VesselKind::artery); })
            .text("", "vein", [](const C& c) { return best_reach(*c.candidate, VesselKind::vein); })
            .text("leg", "", [](const C& c) { return leg_of(c.candidate->leg); })
            .flag("mirrored", "", [](const C& c) { return c.candidate->is_mirrored; })
            .text("pedicle_at", "", [](const C& c) { return std::string(c.candidate->at_first ? "first" : "last"); })
            .flag("reversed", "", [](const C& c) { return c.candidate->inputs.reversed; })
            .flag("turned_180", "", [](const C& c) { return c.candidate->is_flipped; })
            .number("roll_deg", "", from_si(1, "°"), [](const C& c) { return c.candidate->inputs.roll; })
            .flag("as_given", "", [](const C& c) { return c.candidate->changes == 0; })
            .text("excluded", "",
                  [](const C& c) {
                      return c.candidate->excluded.empty() ? std::nullopt : std::optional(c.candidate->excluded);
                  })
            .texts("", "why not, or warnings", [](const C& c) { return reasons_of(*c.candidate); })
            .rows("reaches", "", reach, [](const C& c) -> const auto& { return c.candidate->measures.reaches; })
            .rows("warnings", "", coded_fields(), [](const C& c) { return warnings_of(*c.candidate); });
    return all;
}

std::vector<RankedCandidate> numbered(const std::vector<Candidate>& all) {
    std::vector<RankedCandidate> ranks;
    for (const Candidate& c : all) ranks.push_back({ranks.size() + 1, &c});
    return ranks;
}

const Fields<MeasuredFlap>& flap_fields() {
    using F = MeasuredFlap;
    static const Fields<F> all = [] {
        Fields<F> made("flap of a plan");
        made.part(plan_warnings_fields(), [](const F& f) -> const auto& { return *f.warnings; });
        made.part(flap_measures_fields(), [](const F& f) -> const FlapMeasures& { return *f.measures; })
            .rows("candidates", "candidates, best first", candidate_fields(),
                  [](const F& f) { return f.candidates ? numbered(*f.candidates) : std::vector<RankedCandidate>(); })
            .omitted()
            .text("", "note", [](const F&) { return std::string(research_note); });
        return made;
    }();
    return all;
}

const Fields<DrapedFlap>& paddle_fields() {
    using D = DrapedFlap;
    const auto of = [](auto member) { return [member](const D& d) { return d.study->draped.*member; }; };
    using P = skin::DrapedPaddle;
    static const Fields<D> all = [of] {
        Fields<D> made("skin paddle over a defect");
        made.part(plan_warnings_fields(), [](const D& d) -> const auto& { return d.study->warnings; });
        made.child("paddle", "paddle", skin_fields(), [](const D& d) -> const SkinPaddle& { return *d.paddle; })
            .number("perforator_length_mm", "length of a perforator", from_si(1, "mm"),
                    [](const D& d) { return d.study->settings.rope_length; })
            .number("thickness_mm", "thickness", from_si(1, "mm"),
                    [](const D& d) { return d.study->settings.sheet.thickness; })
            .number("defect_mm2", "defect", from_si(0, "mm²"), of(&P::defect_area))
            .number("coverage", "of the defect covered", fixed(0, "%", "1"), of(&P::coverage))
            .number("on_bone", "of the paddle on bone", fixed(0, "%", "1"), of(&P::touching))
            .number("fold_deg", "fold", from_si(0, "°"), of(&P::fold))
            .number("area_flat_mm2", "area at rest", from_si(0, "mm²"), of(&P::area_flat))
            .number("area_mm2", "area as draped", from_si(0, "mm²"), of(&P::area))
            .flag("at_rest", "at rest", of(&P::is_settled))
            .rows("perforators", "perforators", rope_fields(), of(&P::ropes))
            .texts("unused_perforators", "perforators not used: on bone that is not kept or beyond the paddle",
                   of(&P::unused))
            .text("", "note",
                  [](const D&) { return fmt::format("the skin's mechanics are assumed; {}", research_note); });
        return made;
    }();
    return all;
}

}  // namespace tactus::report
