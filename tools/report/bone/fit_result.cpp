// SPDX-License-Identifier: Apache-2.0
#include "tools/report/bone/fit_result.hpp"

#include "tools/analysis/bone/kerf_doubt.hpp"
#include "tools/report/bone/pose_fields.hpp"

#include <fmt/format.h>

namespace tactus::report {

namespace {

using fit::Fit;
using fit::FitQuality;
using Rival = fit::JudgedRegistration::Rival;

const Fields<fit::FreeDirection>& free_fields() {
    using F = fit::FreeDirection;
    static const Fields<F> all =
        Fields<F>("direction in which a fit does not hold")
            .text("type", "free", [](const F& f) { return std::string(f.is_rotation ? "rotation" : "translation"); })
            .vector("axis", "about or along", fixed(2), &F::axis);
    return all;
}

const Fields<Fit>& fit_fields() {
    const auto of = [](auto member) { return [member](const Fit& f) { return f.quality.*member; }; };
    static const Fields<Fit> all =
        Fields<Fit>("fit of two fragments")
            .text("verdict", "verdict", [](const Fit& f) { return std::string(fit::name_of(f.verdict)); })
            .text("answer", "", [](const Fit& f) { return std::string(fit::answer_of(f.verdict)); })
            .text("", "place", [](const Fit& f) { return bound_words(f.verdict, f.bound); })
            .child("pose", "", pose_fields(), [](const Fit& f) { return f.pose; })
            .vector("", "p_fixed = R p_moving + t: t", from_si(3, "mm"), [](const Fit& f) { return f.pose.position; })
            .vector("", "R as a unit quaternion w x y z", fixed(5),
                    [](const Fit& f) {
                        const Quat& q = f.pose.orientation;
                        return std::array{q.w, q.x, q.y, q.z};
                    })
            .number("score", "score", fixed(2), of(&FitQuality::score))
            .number("margin", "margin", fixed(2), &Fit::margin)
            .number("held_at_far_end_mm", "", from_si(2, "mm"), [](const Fit& f) { return f.precision.far; })
            .number("held_deg", "", from_si(2, "°"), [](const Fit& f) { return f.precision.turn; })
            .number("overlap_mm2", "on each other", from_si(0, "mm²"), of(&FitQuality::overlap))
            .number("rms_mm", "rms", from_si(3, "mm"), of(&FitQuality::rms))
            .number("gap_mm", "", from_si(2, "mm"), of(&FitQuality::gap))
            .number("penetration_mm", "", from_si(2, "mm"), of(&FitQuality::penetration))
            .number("outline_step_mm", "", from_si(2, "mm"), of(&FitQuality::outline))
            .rows("free_directions", "free directions", free_fields(), &Fit::free)
            .child("bound", "", bound_fields(), [](const Fit& f) { return f.bound; })
            .integer("iterations", "", &Fit::iterations);
    return all;
}

/// A value of the moving and of the fixed fragment.
template <class Value>
struct Sides {
    Value moving, fixed;
};

const Fields<Sides<std::string>>& paint_fields() {
    using S = Sides<std::string>;
    static const Fields<S> all =
        Fields<S>("source of the paint").text("moving", "", &S::moving).text("fixed", "", &S::fixed);
    return all;
}

const Fields<Sides<double>>& area_fields() {
    using S = Sides<double>;
    static const Fields<S> all = Fields<S>("surface in contact with another fragment in the scan, left out")
                                     .number("moving", "", from_si(0, "mm²"), &S::moving)
                                     .number("fixed", "", from_si(0, "mm²"), &S::fixed);
    return all;
}

const Fields<Sides<std::vector<double>>>& painted_fields() {
    using S = Sides<std::vector<double>>;
    static const Fields<S> all = Fields<S>("area of each painted face")
                                     .vector("moving", "", from_si(0, "mm²"), &S::moving)
                                     .vector("fixed", "", from_si(0, "mm²"), &S::fixed);
    return all;
}

std::vector<std::string> notes_of(const SnappedFiles& s) {
    std::vector<std::string> notes;
    if (s.found->as_scanned) notes.emplace_back(as_scanned_note);
    if (s.found->kerf && s.found->kerf->is_doubtful()) notes.push_back(analysis::kerf_doubt(*s.found->kerf));
    if (s.found->moving.as_scanned > 0.0) notes.push_back(left_out_words(s.moving, s.found->moving.as_scanned));
    if (s.found->fixed.as_scanned > 0.0) notes.push_back(left_out_words(s.fixed, s.found->fixed.as_scanned));
    return notes;
}

struct PlacedRegistration {
    const fit::Registration* registration;
    Pose pose;
};

const Fields<PlacedRegistration>& placed_fields() {
    using P = PlacedRegistration;
    const auto of = [](auto member) { return [member](const P& p) { return p.registration->*member; }; };
    using R = fit::Registration;
    static const Fields<P> all = Fields<P>("registration of two surfaces")
                                     .child("pose", "", pose_fields(), &P::pose)
                                     .number("median_mm", "median distance", from_si(2, "mm"), of(&R::median))
                                     .number("median_before_mm", "before", from_si(2, "mm"), of(&R::before))
                                     .number("p90_mm", "90 % within", from_si(2, "mm"), of(&R::p90))
                                     .number("covered", "", fixed(0, "%", "1"), of(&R::covered));
    return all;
}

struct PosedRival {
    const Rival* rival;
    double angle_deg;  ///< against the best pose
};

const Fields<PosedRival>& rival_fields() {
    using R = PosedRival;
    static const Fields<R> all =
        Fields<R>("another pose that was found")
            .child("pose", "", pose_fields(), [](const R& r) { return r.rival->pose; })
            .number("", "rotated against it", fixed(1, "°"), &R::angle_deg)
            .number("rms_mm", "rms", from_si(2, "mm"), [](const R& r) { return r.rival->score; });
    return all;
}

std::vector<PosedRival> rivals_of(const RegisteredFiles& r) {
    std::vector<PosedRival> all;
    if (r.found->judged)
        for (const Rival& rival : r.found->judged->rivals)
            all.push_back(
                {&rival, analysis::motion_between(r.found->judged->best.pose, rival.pose, Vec3(0.0)).angle_deg});
    return all;
}

const Fields<analysis::RegisteredRegion>& plain_fields() {
    using R = analysis::RegisteredRegion;
    static const Fields<R> all =
        Fields<R>("the same by ICP of points")
            .child("away", "", motion_fields(), &R::plain_away)
            .number("", "from where it fits", from_si(2, "mm"), [](const R& r) { return r.plain_away.distance; })
            .number("", "rotated", fixed(2, "°"), [](const R& r) { return r.plain_away.angle_deg; })
            .number("median_to_points_mm", "", from_si(2, "mm"), &R::plain_to_points)
            .number("median_mm", "median distance there", from_si(2, "mm"), &R::plain_median);
    return all;
}

const Fields<analysis::RegisteredRegion>& region_fields() {
    using R = analysis::RegisteredRegion;
    static const Fields<R> all =
        Fields<R>("part that is displaced against the rest")
            .number("area_mm2", "area", from_si(0, "mm²"), &R::area)
            .integer("points", "", &R::points)
            .child("away", "", motion_fields(), &R::away)
            .number("", "from where it fits by itself", from_si(2, "mm"), [](const R& r) { return r.away.distance; })
            .number("", "rotated", fixed(2, "°"), [](const R& r) { return r.away.angle_deg; })
            .part(placed_fields(), [](const R& r) { return PlacedRegistration{&r.registration, r.registration.pose}; })
            .child("point_to_point", "plain ICP of points", plain_fields(), [](const R& r) -> const R& { return r; });
    return all;
}

std::optional<std::string> verdict_of(const RegisteredFiles& r) {
    if (!r.found->judged) return std::nullopt;
    switch (r.found->judged->verdict) {
        case fit::RegistrationVerdict::fit: return "fit";
        case fit::RegistrationVerdict::ambiguous: return "ambiguous";
        case fit::RegistrationVerdict::none: break;
    }
    return "none";
}

/// The meaning of a verdict that is not a fit.
std::string verdict_note(const RegisteredFiles& r) {
    const std::string verdict = verdict_of(r).value_or("");
    return verdict == "ambiguous" ? "other poses fit about as well"
           : verdict == "none"    ? "no pose brings the surfaces together"
                                  : "";
}

}  // namespace

const Fields<SnappedFiles>& snap_fields() {
    using S = SnappedFiles;
    static const Fields<S> all =
        Fields<S>("fit of a fragment to another one")
            .part(fit_fields(), [](const S& s) -> const Fit& { return s.found->fit; })
            .notes("", "note", notes_of)
            .child("moved", "", motion_fields(), [](const S& s) { return s.found->moved; })
            .flag("as_scanned", "", [](const S& s) { return s.found->as_scanned; })
            .number("time_ms", "time", from_si(0, "ms"), [](const S& s) { return s.found->seconds; })
            .child("paint", "", paint_fields(),
                   [](const S& s) { return Sides<std::string>{s.found->moving.paint, s.found->fixed.paint}; })
            .child("as_scanned_mm2", "", area_fields(),
                   [](const S& s) { return Sides<double>{s.found->moving.as_scanned, s.found->fixed.as_scanned}; })
            .child("painted_mm2", "", painted_fields(),
                   [](const S& s) { return Sides<std::vector<double>>{s.found->moving.areas, s.found->fixed.areas}; });
    return all;
}

const Fields<RegisteredFiles>& registration_fields() {
    using R = RegisteredFiles;
    static const Fields<R> all =
        Fields<R>("registration of a surface to another one")
            .part(placed_fields(), [](const R& r) { return PlacedRegistration{&r.found->registration, r.found->pose}; })
            .text("verdict", "verdict", verdict_of)
            .omitted()
            .text("", "note", verdict_note)
            .number("rms_mm", "rms", from_si(2, "mm"),
                    [](const R& r) { return r.found->judged ? std::optional(r.found->judged->score) : std::nullopt; })
            .omitted()
            .rows("rivals", "other poses, best first", rival_fields(), rivals_of)
            .omitted([](const R& r) { return r.found->judged.has_value(); })
            .text("", "other poses",
                  [](const R& r) {
                      return std::string(r.found->judged && r.found->judged->rivals.empty() ? "none was found" : "");
                  })
            .vector("plane_normal", "", fixed(4),
                    [](const R& r) { return r.found->plane ? std::optional(r.found->plane->normal) : std::nullopt; })
            .omitted()
            .number("plane_offset_mm", "", from_si(2, "mm"),
                    [](const R& r) { return r.found->plane ? std::optional(r.found->plane->offset) : std::nullopt; })
            .omitted()
            .child("region", "displaced part", region_fields(),
                   [](const R& r) -> const auto& { return r.found->region; })
            .omitted([](const R& r) { return r.has_region; })
            .text("", "displaced part",
                  [](const R& r) { return std::string(r.has_region && !r.found->region ? "none" : ""); });
    return all;
}

}  // namespace tactus::report
