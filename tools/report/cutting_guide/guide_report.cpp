// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cutting_guide/guide_report.hpp"

#include "dsp/core/constants.hpp"
#include "tools/analysis/cutting_guide/guide_limits.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/report/cutting_guide/guide_drawing.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace tactus::report {

display::PictureMesh flat_mesh(const geometry::TriangleSurface& surface, const Vec3& colour) {
    geometry::TriangleSurface split;
    for (const auto& t : surface.triangles) {
        const int first = static_cast<int>(split.vertices.size());
        for (const int v : t) split.vertices.push_back(surface.vertices[static_cast<std::size_t>(v)]);
        split.triangles.push_back({first, first + 1, first + 2});
    }
    return render::picture_mesh(split, {}, {&colour, 1});
}

const Fields<analysis::GuideWarning>& guide_warning_fields() {
    using W = analysis::GuideWarning;
    static const Fields<W> all = Fields<W>("warning of a guide").text("code", "", &W::code).text("text", "", &W::text);
    return all;
}

namespace {

constexpr Vec3 guide_colour(0.35, 0.62, 0.72), bone_colour(0.90, 0.86, 0.76), letter_colour(0.10, 0.20, 0.30);
constexpr double around = 15.0 * mm;  // of bone that is shown beyond the guide

geometry::TriangleSurface near_guide(const analysis::PlannedGuide& guide) {
    Vec3 low(infinity), high(-infinity);
    for (const Vec3& v : guide.made.surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    geometry::TriangleSurface shown;
    for (const auto& t : guide.design.bone.triangles) {
        bool is_near = true;
        const int first = static_cast<int>(shown.vertices.size());
        for (const int v : t) {
            const Vec3& p = guide.design.bone.vertices[static_cast<std::size_t>(v)];
            for (int axis = 0; axis < 3; ++axis)
                is_near &= p[axis] > low[axis] - around && p[axis] < high[axis] + around;
            shown.vertices.push_back(p);
        }
        if (is_near) shown.triangles.push_back({first, first + 1, first + 2});
        else shown.vertices.resize(static_cast<std::size_t>(first));
    }
    return shown;
}

/// A slot with its walls as they are in the mesh.
struct FittedSlot {
    const cutting_guide::MadeSlot* slot;
    const cutting_guide::SlotFit* fit;
};

const Fields<FittedSlot>& slot_fields() {
    using S = FittedSlot;
    const auto slot = [](auto member) { return [member](const S& s) { return s.slot->*member; }; };
    const auto width = [](const S& s) { return s.fit->width > 0.0 ? std::optional(s.fit->width) : std::nullopt; };
    using Made = cutting_guide::MadeSlot;
    static const Fields<S> all =
        Fields<S>("slot of a guide")
            .text("letter", "slot", [](const S& s) { return std::string(1, s.slot->cut.letter); })
            .text("cut", "cut", [](const S& s) { return s.slot->cut.name; })
            .child("plane", "", plane_fields(), [](const S& s) -> const auto& { return s.slot->cut.plane; })
            .integer("sides", "sides", [](const S& s) { return static_cast<int>(s.slot->sides); })
            .number("width_mm", "", from_si(2, "mm"), width)
            .text("", "width, mm",
                  [width](const S& s) { return width(s) ? fmt::format("{:.2f}", *width(s) / mm) : "ledge"; })
            .number("depth_mm", "depth", from_si(1, "mm"), slot(&Made::depth))
            .number("length_mm", "length", from_si(1, "mm"), slot(&Made::length))
            .number("offset_mm", "off the plan", from_si(3, "mm").with_sign(), [](const S& s) { return s.fit->offset; })
            .number("angle_error_deg", "angle off the plan", from_si(3, "°"), [](const S& s) { return s.fit->angle; })
            .number("play_deg", "", from_si(1, "°"), slot(&Made::play))
            .text("", "play of the blade, °",
                  [](const S& s) { return s.slot->play ? fmt::format("{:.1f}", *s.slot->play / degree) : "not held"; });
    return all;
}

const Fields<cutting_guide::MadeHole>& hole_fields() {
    using H = cutting_guide::MadeHole;
    static const Fields<H> all =
        Fields<H>("hole of a guide")
            .text("name", "hole", [](const H& h) { return h.name; })
            .vector("at_mm", "", from_si(2, "mm"), [](const H& h) { return h.at; })
            .vector("axis", "", fixed(4), [](const H& h) { return h.axis; })
            .number("diameter_mm", "diameter", from_si(1, "mm"), [](const H& h) { return 2.0 * h.radius; })
            .number("wall_mm", "wall around it", from_si(2, "mm"), [](const H& h) { return h.wall; })
            .flag("predictive", "", [](const H& h) { return h.is_predictive; })
            .text("", "for",
                  [](const H& h) { return std::string(h.is_predictive ? "drilled for later" : "fixes the guide"); });
    return all;
}

const Fields<analysis::HeldFragment>& held_fields() {
    using H = analysis::HeldFragment;
    static const Fields<H> all = Fields<H>("fragment that a guide holds")
                                     .text("letter", "mark", [](const H& h) { return std::string(1, h.letter); })
                                     .text("name", "fragment", &H::name)
                                     .number("contact_mm2", "contact", from_si(0, "mm²"), &H::contact_area)
                                     .integer("holes", "holes for screws", [](const H& h) { return h.holes; })
                                     .number("play_mm", "play before it is screwed", from_si(1, "mm"), &H::play)
                                     .number("play_deg", "", from_si(1, "°"), &H::play_angle);
    return all;
}

const Fields<analysis::FractureGap>& fracture_fields() {
    using G = analysis::FractureGap;
    static const Fields<G> all = Fields<G>("fracture that a guide bridges")
                                     .text("first", "fragment", &G::first)
                                     .text("second", "and", &G::second)
                                     .number("gap_mm", "gap, median", from_si(2, "mm"), &G::gap)
                                     .number("overlap_mm3", "overlap", from_si(0, "mm³"), &G::overlap);
    return all;
}

const Fields<cutting_guide::Taper>& taper_fields() {
    using T = cutting_guide::Taper;
    static const Fields<T> all = Fields<T>("thin end of a wall whose faces are not parallel")
                                     .number("thickness_mm", "thickness", from_si(2, "mm"), &T::thickness)
                                     .number("angle_deg", "angle of its faces", from_si(0, "°"), &T::angle)
                                     .vector("at_mm", "", from_si(2, "mm"), [](const T& t) { return t.at; });
    return all;
}

std::vector<cutting_guide::Taper> tapers_of(const analysis::PlannedGuide& g) {
    std::vector<cutting_guide::Taper> all;
    for (const auto& taper : g.made.tapers)
        if (taper) all.push_back(*taper);
    return all;
}

const Fields<analysis::NearVessel>& vessel_fields() {
    using V = analysis::NearVessel;
    static const Fields<V> all = Fields<V>("vessel or perforator near a guide")
                                     .text("name", "vessel", &V::name)
                                     .number("distance_mm", "from the guide", from_si(2, "mm"), &V::away)
                                     .vector("at_mm", "", from_si(2, "mm"), &V::at)
                                     .flag("perforator", "", &V::is_perforator);
    return all;
}

const Fields<analysis::PlannedGuide>& seating_fields() {
    using G = analysis::PlannedGuide;
    static const Fields<G> all =
        Fields<G>("seat of a guide on its bone")
            .flag("free", "", [](const G& g) { return g.seat.is_path_free; })
            .vector("removal", "", fixed(4), [](const G& g) { return glm::normalize(g.design.removal); })
            .number("min_distance_mm", "", from_si(2, "mm"), [](const G& g) { return g.seat.min_distance; })
            .number("offset_mm", "", from_si(2, "mm"), [](const G& g) { return g.design.settings.offset; });
    return all;
}

bool is_held(const analysis::PlannedGuide& g) { return g.seat.play < cutting_guide::max_play; }

const Fields<analysis::PlannedGuide>& seat_play_fields() {
    using G = analysis::PlannedGuide;
    static const Fields<G> all =
        Fields<G>("play of a guide on its bone, at a gap of seat_gap_mm of 'limits'")
            .number("mm", "", from_si(1, "mm"), [](const G& g) { return g.seat.play; })
            .number("deg", "", from_si(1, "°"), [](const G& g) { return g.seat.play_angle; })
            .vector("direction", "", fixed(3), [](const G& g) { return g.seat.play_direction; })
            .flag("is_held", "", is_held);
    return all;
}

std::optional<double> greatest_play(const analysis::PlannedGuide& g) {
    std::optional<double> play;
    for (const cutting_guide::MadeSlot& slot : g.made.slots)
        if (slot.play) play = std::max(play.value_or(0.0), *slot.play);
    return play;
}

std::vector<FittedSlot> slots_of(const analysis::PlannedGuide& g) {
    std::vector<FittedSlot> all;
    for (std::size_t n = 0; n < g.made.slots.size(); ++n) all.push_back({&g.made.slots[n], &g.refits[n]});
    return all;
}

struct SourcedValue {
    std::string measure, value, from;
};

const Fields<SourcedValue>& sourced_fields() {
    static const Fields<SourcedValue> all = Fields<SourcedValue>("value and its source")
                                                .text("", "measure", &SourcedValue::measure)
                                                .text("", "value", &SourcedValue::value)
                                                .text("", "from", &SourcedValue::from);
    return all;
}

/// Sizes of the design, with their sources.
std::vector<SourcedValue> sizes_of(const analysis::PlannedGuide& g) {
    const cutting_guide::GuideSettings& set = g.design.settings;
    const auto in_mm = [](double metres) { return fmt::format("{:.2f} mm", metres / mm); };
    const cutting_guide::GuideSettings usual;
    const reconstruction::FibulaInputs inputs;
    // A value has the source of the default that it equals; any other was given.
    const auto is = [](double value, double other) { return std::abs(value - other) < 1e-6 * other; };
    const auto from = [&](double value, double other, const char* source) {
        return std::string(is(value, other) ? source : "given");
    };
    const char* planner = "BoneReconstructionPlanner";
    const bool on_fibula = g.bone == analysis::GuideBone::fibula;
    std::vector<SourcedValue> all{
        {"distance from the bone", in_mm(set.offset),
         from(set.offset, (on_fibula ? 0.5 : 0.3) * mm, on_fibula ? "for periosteum, remembered" : planner)},
        {"thickness of the base", in_mm(set.thickness), from(set.thickness, usual.thickness, planner)},
        {"covers of the outline", fmt::format("{:.0f}°", set.wrap / degree), from(set.wrap, usual.wrap, planner)},
        {"hole of a screw", in_mm(2.0 * set.screw_radius), from(set.screw_radius, usual.screw_radius, planner)},
    };
    if (g.bone == analysis::GuideBone::reduction) return all;
    const std::vector<SourcedValue> of_slots{
        {"depth of a slot", in_mm(set.depth), from(set.depth, usual.depth, planner)},
        {"wall of a slot", in_mm(set.wall), from(set.wall, usual.wall, planner)},
        {"blade", in_mm(set.blade),
         !is(set.blade, g.kerf)    ? "given"
         : is(g.kerf, inputs.kerf) ? "the plan's kerf, a placeholder"
                                   : "the plan's kerf"},
        {"clearance per side of the blade", in_mm(set.clearance),
         is(set.clearance, usual.clearance) ? "of a printer by light (sla)"
                                            : from(set.clearance, 0.4 * mm, "of a printer by filament (fdm)")},
    };
    all.insert(all.end(), of_slots.begin(), of_slots.end());
    return all;
}

/// Thresholds, and sizes without an option of their own, with their sources.
std::vector<SourcedValue> limits_of(const analysis::PlannedGuide& g) {
    std::vector<SourcedValue> all;
    const analysis::GuideChoice usual;
    for (const analysis::GuideLimit& limit : analysis::guide_limits()) {
        const bool is_usual = std::abs(limit.of(g.choice) - limit.of(usual)) < 1e-6 * limit.si;
        all.push_back(
            {std::string(limit.about), limit.text_of(g.choice), std::string(is_usual ? limit.source : "given")});
    }
    return all;
}

const Fields<analysis::GuideChoice>& limit_fields() {
    static const Fields<analysis::GuideChoice> all = [] {
        Fields<analysis::GuideChoice> made("thresholds of a guide");
        for (const analysis::GuideLimit& limit : analysis::guide_limits())
            made.number(limit.key, "", limit.unit == "%" ? fixed(0, "%", "1") : from_si(1, std::string(limit.unit)),
                        [&limit](const analysis::GuideChoice& c) { return limit.of(c); });
        return made;
    }();
    return all;
}

const Fields<analysis::PlannedGuide>& planned_fields() {
    using G = analysis::PlannedGuide;
    static const Fields<G> all =
        Fields<G>("guide for the cuts of a plan")
            .remark([](const G& g) {
                return std::string("For research, not a medical device. ") +
                       (g.bone == analysis::GuideBone::reduction
                            ? "The base lies on the fragments where the plan has them."
                            : "The wall of each slot on the kept side lies on the plan: a blade that is held against "
                              "it cuts on plan.");
            })
            .warnings("",
                      [](const G& g) {
                          std::vector<std::string> texts;
                          for (const analysis::GuideWarning& w : g.warnings) texts.push_back(w.text);
                          return texts;
                      })
            .pictures(guide_pictures)
            .figure(
                "to scale, as measured in the mesh", [](const G&) { return true; }, guide_drawing)
            .text("bone", "guide for the", [](const G& g) { return std::string(analysis::name_of(g.bone)); })
            .flag("closed", "closed", [](const G& g) { return g.topology.is_watertight(); })
            .integer("parts", "parts", [](const G& g) { return g.topology.components; })
            .integer("triangles", "triangles", [](const G& g) { return g.made.surface.triangles.size(); })
            .number("volume_mm3", "volume", from_si(0, "mm³"), &G::volume)
            .number("wall_min_mm", "thinnest wall", from_si(2, "mm"),
                    [](const G& g) { return g.made.wall ? std::optional(g.made.wall->thickness) : std::nullopt; })
            .text("", "thinnest wall", [](const G& g) { return std::string(g.made.wall ? "" : "above 6 mm"); })
            .number("thin_share", "volume left out as too thin", fixed(1, "%", "1"),
                    [](const G& g) { return g.made.thin_share; })
            .number("thin_volume_mm3", "", from_si(1, "mm³"), [](const G& g) { return g.made.thin_volume; })
            .integer("loose_parts", "loose parts dropped", [](const G& g) { return g.made.loose_parts; })
            .child("seating", "", seating_fields(), [](const G& g) -> const G& { return g; })
            .rows("slots", "slots", slot_fields(), slots_of)
            .rows("fragments", "fragments", held_fields(), &G::held)
            .rows("fractures", "fractures", fracture_fields(), &G::gaps)
            .rows("tapers", "thin ends of walls", taper_fields(), tapers_of)
            .rows("holes", "holes", hole_fields(), [](const G& g) -> const auto& { return g.made.holes; })
            .rows("vessels", "vessels", vessel_fields(), &G::vessels)
            .number("play_deg", "", from_si(1, "°"), greatest_play)
            .child("seat_play", "", seat_play_fields(), [](const G& g) -> const G& { return g; })
            .text("", "play on the bone, root mean square",
                  [](const G& g) {
                      return is_held(g) ? fmt::format("{:.1f} mm, {:.1f}° at a gap of {:.1f} mm", g.seat.play / mm,
                                                      g.seat.play_angle / degree, g.choice.limits.seat_gap / mm)
                                        : std::string("not held along one direction");
                  })
            .number("contact_share", "faces on the bone that touch it", fixed(0, "%", "1"),
                    [](const G& g) { return g.seat.contact_share(); })
            .number("overhang_share", "surface that hangs over when printed with the bone's side up",
                    fixed(0, "%", "1"), &G::overhang)
            .rows("", "sizes", sourced_fields(), sizes_of)
            .rows("", "limits", sourced_fields(), limits_of)
            .child("limits", "", limit_fields(), [](const G& g) -> const auto& { return g.choice; })
            .rows("warnings", "", guide_warning_fields(), &G::warnings);
    return all;
}

}  // namespace

std::vector<render::LabelledPicture> guide_pictures(const analysis::PlannedGuide& guide) {
    const std::vector<display::PictureMesh> on_bone{flat_mesh(guide.made.surface, guide_colour),
                                                    render::picture_mesh(near_guide(guide), {}, {&bone_colour, 1})};
    const std::vector<display::PictureMesh> alone{flat_mesh(guide.made.surface, guide_colour)};
    std::vector<render::PictureLabel> letters;
    for (const cutting_guide::MadeSlot& s : guide.made.slots)
        letters.push_back({std::string(1, s.cut.letter), s.middle + 0.5 * s.depth * s.deep, letter_colour});
    for (std::size_t n = 0; n < guide.held.size(); ++n)
        letters.push_back({std::string(1, guide.held[n].letter), guide.design.base[n].on->at, letter_colour});
    const Pose& frame = guide.made.frame;
    const Vec3 x = frame.rotate(Vec3(1.0, 0.0, 0.0)), y = frame.rotate(Vec3(0.0, 1.0, 0.0)),
               z = frame.rotate(Vec3(0.0, 0.0, 1.0));
    return {render::labelled_picture(on_bone, glm::normalize(-z + 0.2 * x + 0.3 * y),
                                     "On the bone, from where it is put on", letters),
            render::labelled_picture(on_bone, glm::normalize(y - 0.25 * z), "From the side of its text"),
            render::labelled_picture(on_bone, glm::normalize(-y - 0.5 * z + 0.3 * x),
                                     "From the side where the slots are open", letters),
            render::labelled_picture(alone, glm::normalize(z + 0.3 * x - 0.2 * y), "The side of the bone")};
}

const Fields<MadeGuideFiles>& guide_fields() {
    using M = MadeGuideFiles;
    static const Fields<M> all =
        Fields<M>("guide for the cuts of a plan, and its files")
            .titled([](const M& m) { return m.plan; })
            .part(planned_fields(), [](const M& m) -> const analysis::PlannedGuide& { return *m.guide; })
            .text("file", "file", &M::file)
            .text("task", "task to saw in it",
                  [](const M& m) { return m.task.empty() ? std::nullopt : std::optional(m.task); })
            .omitted()
            .text("", "note", [](const M&) { return std::string(research_note); });
    return all;
}

}  // namespace tactus::report
