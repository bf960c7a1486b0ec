// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/fibula_result.hpp"

#include "dsp/core/constants.hpp"
#include "tools/report/reconstruction/flap_drawing.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

namespace tactus::report {

namespace {

using reconstruction::CurveSplit;
using reconstruction::FibulaPlan;
using reconstruction::FibulaSegment;
using reconstruction::FibulaWarning;

/// A segment with the joint after it.
struct NumberedSegment {
    const FibulaPlan* plan;
    std::size_t n;

    const FibulaSegment& segment() const { return plan->segments[n]; }
    template <class Value>
    std::optional<double> joint(const std::vector<Value>& of_joints) const {
        return n < of_joints.size() ? std::optional<double>(of_joints[n]) : std::nullopt;
    }
};

/// One of the two cuts of a segment.
struct NumberedCut {
    const FibulaCuts* cuts;
    std::size_t n, end;

    const FibulaSegment& segment() const { return cuts->plan->segments[n]; }
};

/// Rows of a pose as a matrix; lengths in mm.
ResultEntry::Series matrix_of(const Pose& pose) {
    return {16,
            [pose, turn = glm::mat3_cast(pose.orientation)](std::size_t n) {
                const int row = static_cast<int>(n / 4), column = static_cast<int>(n % 4);
                if (row == 3) return column == 3 ? 1.0 : 0.0;
                return column == 3 ? pose.position[row] / mm : turn[column][row];
            },
            4};
}

const Fields<NumberedSegment>& segment_fields() {
    using S = NumberedSegment;
    const auto of = [](auto member) { return [member](const S& s) { return s.segment().*member; }; };
    static const Fields<S> all =
        Fields<S>("segment of a fibula")
            .integer("", "segment", [](const S& s) { return s.n + 1; })
            .number("length_centre_mm", "length", from_si(2, "mm"), of(&FibulaSegment::length_centre))
            .number("length_shortest_mm", "shortest", from_si(2, "mm"), of(&FibulaSegment::length_shortest))
            .number("length_longest_mm", "longest", from_si(2, "mm"), of(&FibulaSegment::length_longest))
            .vector("tilt_deg", "", from_si(2, "°"), of(&FibulaSegment::tilt))
            .vector("lean_medial_deg", "", from_si(1, "°"), of(&FibulaSegment::lean_medial))
            .vector("lean_anterior_deg", "", from_si(1, "°"), of(&FibulaSegment::lean_anterior))
            .vector("area_mm2", "", from_si(0, "mm²"), of(&FibulaSegment::area))
            .number("end_angle_deg", "between its cuts", from_si(2, "°"), of(&FibulaSegment::end_angle))
            .points("donor_to_target", [](const S& s) { return matrix_of(s.segment().donor_to_target); })
            .rows("donor_planes", "", plane_fields(), of(&FibulaSegment::donor_plane))
            .vector("along_line_mm", "", from_si(2, "mm"), of(&FibulaSegment::along_line))
            .number("", "then a wedge", from_si(2, "°"), [](const S& s) { return s.joint(s.plan->wedges); })
            .number("", "bone between the cuts", from_si(2, "mm"),
                    [](const S& s) { return s.n < s.plan->clearances.size() ? s.plan->clearances[s.n] : std::nullopt; })
            .number("", "cuts meet", from_si(0, "mm²"),
                    [](const S& s) { return s.n < s.plan->contact.size() ? s.plan->contact[s.n] : std::nullopt; });
    return all;
}

const Fields<NumberedCut>& cut_fields() {
    using C = NumberedCut;
    const auto of = [](auto member) { return [member](const C& c) { return (c.segment().*member)[c.end]; }; };
    static const Fields<C> all =
        Fields<C>("cut of a fibula")
            .text(
                "", "cut",
                [](const C& c) { return fmt::format("segment {}, at plane {} of the jaw", c.n + 1, c.n + c.end + 1); })
            .number("", "from the ankle's end", from_si(1, "mm"),
                    [](const C& c) {
                        return c.cuts->inputs->donor
                                   ? std::optional(c.segment().along_line[c.end] - ankle_end(*c.cuts->inputs))
                                   : std::nullopt;
                    })
            .number("", "on the line", from_si(2, "mm"), of(&FibulaSegment::along_line))
            .number("", "tilt", from_si(2, "°"), of(&FibulaSegment::tilt))
            .number("", "leans medially", from_si(1, "°"), of(&FibulaSegment::lean_medial))
            .number("", "leans anteriorly", from_si(1, "°"), of(&FibulaSegment::lean_anterior))
            .number("", "area", from_si(0, "mm²"), of(&FibulaSegment::area));
    return all;
}

std::vector<NumberedSegment> segments_of(const FibulaCuts& of) {
    std::vector<NumberedSegment> all;
    for (std::size_t n = 0; n < of.plan->segments.size(); ++n) all.push_back({of.plan, n});
    return all;
}

std::vector<NumberedCut> cuts_of(const FibulaCuts& of) {
    std::vector<NumberedCut> all;
    for (std::size_t n = 0; n < of.plan->segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) all.push_back({&of, n, end});
    return all;
}

const Fields<CurveSplit>& curve_fields() {
    static const Fields<CurveSplit> all = Fields<CurveSplit>("curve of a jaw from its segments")
                                              .number("rms", "rms", from_si(2, "mm"), &CurveSplit::rms)
                                              .number("greatest", "greatest", from_si(2, "mm"), &CurveSplit::greatest);
    return all;
}

const Fields<FibulaWarning>& numbered_warning_fields() {
    static const Fields<FibulaWarning> all =
        Fields<FibulaWarning>("warning of a segment")
            .part(fibula_warning_fields(), [](const FibulaWarning& w) -> const FibulaWarning& { return w; })
            .integer("segment", "",
                     [](const FibulaWarning& w) { return w.segment < 0 ? std::nullopt : std::optional(w.segment); });
    return all;
}

struct DerivedSegment {
    const analysis::CutsOfPieces* found;
    std::size_t n;
};

const Fields<DerivedSegment>& derived_segment_fields() {
    using S = DerivedSegment;
    static const Fields<S> all = Fields<S>("segment that is cut anew")
                                     .text("segment", "segment", [](const S& s) { return s.found->segments[s.n]; })
                                     .number("length_before_mm", "length before", from_si(2, "mm"),
                                             [](const S& s) { return s.found->before.segments[s.n].length_centre; })
                                     .number("length_mm", "length", from_si(2, "mm"),
                                             [](const S& s) { return s.found->cuts.plan.segments[s.n].length_centre; })
                                     .number("from_placed_mm", "from where it was placed", from_si(2, "mm"),
                                             [](const S& s) { return s.found->cuts.moved[s.n]; })
                                     .number("from_placed_deg", "rotated from there", from_si(2, "°"),
                                             [](const S& s) { return s.found->cuts.turned[s.n]; });
    return all;
}

}  // namespace

std::vector<std::string> texts_of(const std::vector<FibulaWarning>& warnings) {
    std::vector<std::string> texts;
    for (const FibulaWarning& w : warnings) texts.push_back(w.text);
    return texts;
}

const Fields<reconstruction::Plane>& plane_fields() {
    using reconstruction::Plane;
    static const Fields<Plane> all = Fields<Plane>("plane")
                                         .vector("origin_mm", "", from_si(3, "mm"), &Plane::origin)
                                         .vector("normal", "", fixed(6), &Plane::normal);
    return all;
}

const Fields<FibulaWarning>& fibula_warning_fields() {
    static const Fields<FibulaWarning> all =
        Fields<FibulaWarning>("warning")
            .text("code", "", [](const FibulaWarning& w) { return std::string(reconstruction::name_of(w.code)); })
            .text("text", "", &FibulaWarning::text);
    return all;
}

const Fields<FibulaCuts>& fibula_tables() {
    static const Fields<FibulaCuts> all = Fields<FibulaCuts>("segments and cuts of a fibula")
                                              .rows("segments", "segments of the fibula", segment_fields(), segments_of)
                                              .rows("", "osteotomies of the fibula", cut_fields(), cuts_of);
    return all;
}

const Fields<FibulaCuts>& fibula_fields() {
    using C = FibulaCuts;
    const auto of = [](auto member) { return [member](const C& c) { return c.plan->*member; }; };
    static const Fields<C> all =
        Fields<C>("cuts of a fibula")
            .warnings("", [](const C& c) { return texts_of(c.plan->warnings); })
            .number("", "curve of the jaw from its segments, rms", from_si(2, "mm"),
                    [](const C& c) {
                        return c.inputs->from_curve ? std::optional(c.inputs->from_curve->rms) : std::nullopt;
                    })
            .number("", "at most", from_si(2, "mm"),
                    [](const C& c) {
                        return c.inputs->from_curve ? std::optional(c.inputs->from_curve->greatest) : std::nullopt;
                    })
            .part(fibula_tables(), [](const C& c) -> const C& { return c; })
            .vector("wedges_deg", "", from_si(2, "°"), of(&FibulaPlan::wedges))
            .vector("off_bisector_deg", "", from_si(2, "°"), of(&FibulaPlan::off_bisector))
            .vector("rolls_deg", "", from_si(2, "°"), of(&FibulaPlan::rolls))
            .vector("clearances_mm", "", from_si(2, "mm"), of(&FibulaPlan::clearances))
            .vector("contact_mm2", "", from_si(0, "mm²"), of(&FibulaPlan::contact))
            .number("", "kerf", from_si(1, "mm"), [](const C& c) { return c.inputs->kerf; })
            .number("kerf_loss_mm3", "bone lost to the kerf", from_si(0, "mm³"), of(&FibulaPlan::kerf_loss))
            .points("joints_mm",
                    [](const C& c) {
                        return c.inputs->from_curve ? series_of(c.inputs->from_curve->joints, mm)
                                                    : ResultEntry::Series{};
                    })
            .omitted()
            .child("contour_deviation_mm", "", curve_fields(),
                   [](const C& c) -> const std::optional<CurveSplit>& { return c.inputs->from_curve; })
            .omitted()
            .number("left_distal_mm", "left at the ankle", from_si(2, "mm"), of(&FibulaPlan::left_distal))
            .number("left_proximal_mm", "left at the knee", from_si(2, "mm"), of(&FibulaPlan::left_proximal))
            .rows("warnings", "", numbered_warning_fields(), of(&FibulaPlan::warnings))
            .text("", "note", [](const C&) { return std::string(research_note); });
    return all;
}

const Fields<DerivedCuts>& derived_cuts_fields() {
    using D = DerivedCuts;
    static const Fields<D> all =
        Fields<D>("cuts of a reconstruction from where its segments were placed")
            .titled([](const D& d) { return fmt::format("{}: alternative '{}'", d.plan, d.alternative); })
            .warnings("", [](const D& d) { return texts_of(d.found->made.fibula.warnings); })
            .text("alternative", "", &D::alternative)
            .flag("other_parts_of_donor", "", [](const D& d) { return d.found->cuts.is_spaced_anew; })
            .text("", "donor",
                  [](const D& d) {
                      return std::string(d.found->cuts.is_spaced_anew ? "the placed pieces overlap in it: the segments "
                                                                        "are cut from other parts of it"
                                                                      : "");
                  })
            .rows("segments", "segments", derived_segment_fields(),
                  [](const D& d) {
                      std::vector<DerivedSegment> all_of;
                      for (std::size_t n = 0; n < d.found->segments.size(); ++n) all_of.push_back({d.found, n});
                      return all_of;
                  })
            .rows("warnings", "", fibula_warning_fields(), [](const D& d) { return d.found->made.fibula.warnings; })
            .text("", "note", [](const D&) { return std::string(research_note); });
    return all;
}

}  // namespace tactus::report
