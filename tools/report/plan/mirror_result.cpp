// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/mirror_result.hpp"

#include "tools/report/bone/pose_fields.hpp"

#include <fmt/format.h>

namespace tactus::report {

namespace {

using analysis::FacesThere;
using analysis::MirrorComparison;

const Fields<FacesThere>& faces_fields() {
    using F = FacesThere;
    static const Fields<F> all =
        Fields<F>("contact with the main fragment")
            .number("contact_mm2", "", from_si(0, "mm²"), &F::contact)
            .number("gap_median_mm", "", from_si(2, "mm"),
                    [](const F& f) { return f.facing > 0.0 ? std::optional(f.median) : std::nullopt; })
            .number("deepest_mm", "", from_si(2, "mm"), &F::deepest)
            .number("overlap_mm3", "", from_si(0, "mm³"), &F::overlap);
    return all;
}

const Fields<MirrorComparison>& moments_fields() {
    using C = MirrorComparison;
    static const Fields<C> all = Fields<C>("contact before, and at the best pose")
                                     .child("before", "", faces_fields(), &C::before)
                                     .child("after", "", faces_fields(), &C::after);
    return all;
}

const Fields<ComparedFragment>& compared_fields() {
    using C = ComparedFragment;
    const auto before = [](auto member) { return [member](const C& c) { return c.found.before.*member; }; };
    const auto there = [](auto member) { return [member](const C& c) { return c.found.after.*member; }; };
    static const Fields<C> all =
        Fields<C>("fragment beside the target")
            .text("fragment", "fragment", &C::fragment)
            .child("away", "", motion_fields(), [](const C& c) { return c.found.away; })
            .number("", "from its best pose", from_si(2, "mm"), [](const C& c) { return c.found.away.distance; })
            .number("", "rotated", fixed(2, "°"), [](const C& c) { return c.found.away.angle_deg; })
            .number("median_before_mm", "median", from_si(2, "mm"),
                    [](const C& c) { return c.found.registration.before; })
            .number("median_after_mm", "median there", from_si(2, "mm"),
                    [](const C& c) { return c.found.registration.median; })
            .number("", "touching", from_si(0, "mm²"), before(&FacesThere::contact))
            .number("", "touching there", from_si(0, "mm²"), there(&FacesThere::contact))
            .number("", "overlap", from_si(0, "mm³"), before(&FacesThere::overlap))
            .number("", "overlap there", from_si(0, "mm³"), there(&FacesThere::overlap))
            .number("", "deepest", from_si(2, "mm"), before(&FacesThere::deepest))
            .number("", "deepest there", from_si(2, "mm"), there(&FacesThere::deepest))
            .child("faces", "", moments_fields(), &C::found)
            .child("pose", "", pose_fields(), [](const C& c) { return c.found.registration.pose; });
    return all;
}

struct Asymmetry {
    double angle, distance;
};

const Fields<Asymmetry>& asymmetry_fields() {
    static const Fields<Asymmetry> all = Fields<Asymmetry>("motion that a mirror alone leaves")
                                             .number("angle_deg", "", from_si(2, "°"), &Asymmetry::angle)
                                             .number("distance_mm", "", from_si(2, "mm"), &Asymmetry::distance);
    return all;
}

}  // namespace

const Fields<LaidTarget>& laid_target_fields() {
    using L = LaidTarget;
    static const Fields<L> all =
        Fields<L>("target of a plan")
            .titled([](const L& l) {
                return fmt::format("{} on {}", l.is_mirrored ? "mirrored side" : "same side", l.main);
            })
            .warnings(
                "", [](const L& l) { return l.doubt.empty() ? std::vector<std::string>() : std::vector{l.doubt}; },
                "problem")
            .text("on", "", &L::main)
            .flag("mirrored", "", &L::is_mirrored)
            .text("doubt", "", [](const L& l) { return l.doubt.empty() ? std::nullopt : std::optional(l.doubt); })
            .number("residual_mm", "median", from_si(2, "mm"), [](const L& l) { return l.fit->registration.median; })
            .number("residual_p90_mm", "90 % within", from_si(2, "mm"),
                    [](const L& l) { return l.fit->registration.p90; })
            .vector("plane_normal", "", fixed(4), [](const L& l) { return l.fit->plane.normal; })
            .number("plane_offset_mm", "", from_si(2, "mm"), [](const L& l) { return l.fit->plane.offset; })
            .child("asymmetry", "", asymmetry_fields(),
                   [](const L& l) { return Asymmetry{l.fit->rotation, l.fit->glide}; })
            .rows("others", "fragments beside it", compared_fields(), &L::others);
    return all;
}

}  // namespace tactus::report
