// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include "tools/analysis/plan/case_warnings.hpp"

#include "assets/mesh/mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/self_intersection.hpp"
#include "dsp/reconstruction/clearance.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/margin_wall.hpp"
#include "tools/analysis/cutting_guide/guide_text.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus::analysis {

namespace {

using cutting_guide::GuideCut;
using cutting_guide::GuideDesign;
using cutting_guide::GuideHole;

Vec3 turned(const Vec3& v, const Vec3& axis, double angle) { return glm::angleAxis(angle, axis) * v; }

void add_letters(std::vector<GuideCut>& cuts) {
    for (std::size_t n = 0; n < cuts.size(); ++n) cuts[n].letter = static_cast<char>('A' + n);
}

/// Screws of plates and implants in the frame of the jaw; `place` gives a hole for each that belongs to the bone.
template <class Place>
void add_predictive(const reconstruction::Flap& flap, const Place& place) {
    for (const reconstruction::Plate& plate : flap.plates)
        for (std::size_t n = 0; n < plate.screws.size(); ++n)
            place(plate.screws[n].head, plate.screws[n].axis, 0.5 * plate.screws[n].diameter,
                  fmt::format("screw {} of plate '{}'", n + 1, plate.name));
    for (const reconstruction::DentalImplant& implant : flap.implants)
        place(implant.head, implant.axis, 0.5 * implant.diameter, fmt::format("implant '{}'", implant.name));
}

/// m of base from the axis of a screw: the least wall stands around its hole.
double room_around_screw(const cutting_guide::GuideSettings& set) {
    return set.screw_radius + std::max(2.5 * mm, set.min_wall + 0.5 * mm);
}

/// m of base from a cut on, along `out`, so that a screw and its driver pass the wall of the slot at any height: the wall
/// leans by `out` against the removal. `slot`: what of its width lies on that side.
double room_for_screw(const GuideDesign& design, const Vec3& out, double slot) {
    const cutting_guide::GuideSettings& set = design.settings;
    const double lean = std::max(0.0, -glm::dot(out, glm::normalize(design.removal)));
    return slot + set.wall + lean * (set.depth + 10.0 * mm) + 2.0 * room_around_screw(set);
}

GuideDesign of_fibula(const FlapStudy& study, const GuideChoice& choice) {
    const reconstruction::FibulaInputs& in = study.inputs();
    const reconstruction::DonorBone donor(in);
    const reconstruction::FibulaPlan& plan = study.fibula();
    GuideDesign design;
    design.settings = choice.settings;
    design.settings.offset = choice.offset.value_or(0.5 * mm);
    design.bone = donor.surface();
    const Vec3 axis = donor.axis(), medial = donor.frame()[0], front(0.0, -1.0, 0.0);
    // From lateral to the front.
    const double sense = glm::dot(glm::cross(axis, -medial), front) > 0.0 ? 1.0 : -1.0;
    design.removal = turned(-medial, axis, sense * choice.turn);
    // The rail lies in front of the bone: the vessels run behind it.
    const bool is_upwards = glm::dot(-glm::cross(design.removal, axis), turned(front, axis, sense * choice.turn)) > 0.0;
    design.along = is_upwards ? axis : -axis;
    double low = infinity, high = -infinity;
    for (std::size_t n = 0; n < plan.segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
            const reconstruction::FibulaSegment& s = plan.segments[n];
            const Vec3 out = glm::normalize(s.donor_plane[end].normal);
            const bool is_far = s.along_line[end] > s.along_line[1 - end];
            design.cuts.push_back({{s.donor_plane[end].origin, is_far ? out : -out},
                                   fmt::format("segment {} at plane {}", n + 1, n + end + 1)});
            low = std::min(low, s.along_line[end]), high = std::max(high, s.along_line[end]);
        }
    std::ranges::sort(design.cuts, {}, [&](const GuideCut& c) { return glm::dot(c.plane.origin, design.along); });
    add_letters(design.cuts);
    const auto from_point = [&](double s) { return donor.at(s); };
    const auto end_beyond = [&](bool is_low) {
        const GuideCut& cut = (glm::dot(design.along, axis) > 0.0) == is_low ? design.cuts.front() : design.cuts.back();
        return std::max(design.settings.end, room_for_screw(design, cut.plane.normal, design.settings.slot_width()) /
                                                 std::abs(glm::dot(cut.plane.normal, axis)));
    };
    const double from = std::max(low - end_beyond(true), donor.whole().low + 2.0 * mm),
                 to = std::min(high + end_beyond(false), donor.whole().high - 2.0 * mm);
    design.base.push_back({from_point(0.0), axis, from, to});
    const double inside = room_around_screw(design.settings);
    for (const double s : {from + inside, to - inside})
        design.holes.push_back({from_point(s), -design.removal, design.settings.screw_radius,
                                fmt::format("screw at {:.0f} mm on the line", s / mm), false});
    add_predictive(study.flap(), [&](const Vec3& head, const Vec3& along, double radius, const std::string& name) {
        for (const reconstruction::FibulaSegment& s : plan.segments) {
            const Pose back = s.donor_to_target.inverse();
            const Vec3 at = back.apply(head);
            const double place = donor.along(at);
            if (place < std::min(s.along_line[0], s.along_line[1]) ||
                place > std::max(s.along_line[0], s.along_line[1]))
                continue;
            if (glm::length(at - donor.at(place)) > 25.0 * mm) continue;
            design.holes.push_back({at, back.rotate(along), radius, name, true});
        }
    });
    return design;
}

GuideDesign of_jaw(const FlapStudy& study, const GuideChoice& choice) {
    const reconstruction::FibulaInputs& in = study.inputs();
    if (!in.jaw) throw Error("the plan has no mesh of the jaw: a guide for the jaw needs one ('jaw' of the inputs)");
    std::vector<reconstruction::Plane> planes = reconstruction::resection_planes(in);
    if (planes.empty()) throw Error("the plan does not cut the jaw: its resection is 'none'");
    if (choice.cut > static_cast<int>(planes.size()))
        throw Error(fmt::format("--cut {}: the plan cuts the jaw by {} planes", choice.cut, planes.size()));
    if (choice.cut > 0) planes = {planes[static_cast<std::size_t>(choice.cut) - 1]};
    GuideDesign design;
    design.settings = choice.settings;
    design.settings.offset = choice.offset.value_or(0.3 * mm);
    // The walls end below the teeth; the blade goes on in the plane.
    design.settings.cover = choice.jaw_cover;
    design.bone = *in.jaw;
    Vec3 middle(0.0), at(0.0), out(0.0);
    for (const Vec3& v : in.jaw->vertices) middle += v / static_cast<double>(in.jaw->vertices.size());
    for (const reconstruction::Plane& p : planes) {
        at += p.origin / static_cast<double>(planes.size());
        Vec3 aside = p.origin - middle;
        aside.z = 0.0;
        aside -= glm::dot(aside, p.normal) * p.normal;
        if (glm::length(aside) > 0.0) out += glm::normalize(aside);
    }
    design.along = planes.size() > 1 ? planes.back().origin - planes.front().origin : planes.front().normal;
    design.along = glm::normalize(design.along);
    out -= glm::dot(out, design.along) * design.along;
    if (!(glm::length(out) > 0.1)) throw Error("the plan does not show where the outside of the jaw is");
    design.removal = turned(glm::normalize(out), design.along, choice.turn);
    // The rail lies below the jaw.
    if (glm::cross(design.removal, design.along).z < 0.0) design.along = -design.along;
    for (std::size_t n = 0; n < planes.size(); ++n)
        design.cuts.push_back({{planes[n].origin, glm::normalize(planes[n].normal)},
                               choice.cut == 2 || n > 0 ? "the last plane of the jaw" : "the first plane of the jaw"});
    std::ranges::sort(design.cuts, {}, [&](const GuideCut& c) { return glm::dot(c.plane.origin, design.along); });
    add_letters(design.cuts);
    // The base ends at the plane: the blade passes along its face above the walls.
    const double beyond = design.settings.offset + design.settings.thickness;
    for (const GuideCut& c : design.cuts) {
        const double reach =
            std::max(design.settings.wall + design.settings.end, room_for_screw(design, -c.plane.normal, 0.0));
        design.base.push_back({c.plane.origin, c.plane.normal, -reach, beyond, c.plane});
        const Vec3 aside = glm::normalize(glm::cross(design.removal, c.plane.normal)),
                   place = c.plane.origin - (reach - room_around_screw(design.settings)) * c.plane.normal;
        // On a curved jaw the base is narrow at its end: there the holes move towards the cut and each other.
        const double room = reach - room_for_screw(design, -c.plane.normal, 0.0);
        for (const double side : {-5.0 * mm, 5.0 * mm})
            design.holes.push_back({place + side * aside, -design.removal, design.settings.screw_radius,
                                    fmt::format("screw beside cut {}", c.letter), false,
                                    room * c.plane.normal - 0.25 * side * aside});
    }
    add_predictive(study.flap(), [&](const Vec3& head, const Vec3& along, double radius, const std::string& name) {
        const bool is_kept = std::ranges::any_of(design.cuts, [&](const GuideCut& c) {
            const double t = glm::dot(head - c.plane.origin, c.plane.normal);
            return t < 0.0 && glm::length(head - c.plane.origin) < 40.0 * mm;
        });
        if (is_kept) design.holes.push_back({head, along, radius, name, true});
    });
    return design;
}

/// Vessels of the flap and then its perforators, as the guide must keep clear of them.
std::vector<cutting_guide::Tube> tubes_of(const reconstruction::Flap& flap, const GuideChoice& choice) {
    std::vector<cutting_guide::Tube> tubes;
    for (const reconstruction::FlapVessel& vessel : flap.vessels) tubes.push_back({vessel.points, vessel.radius});
    for (const reconstruction::Perforator& p : flap.perforators)
        tubes.push_back({{p.at}, choice.limits.perforator_radius});
    return tubes;
}

/// Those that come near enough to be named.
std::vector<NearVessel> vessels_near(const PlannedGuide& guide, const geometry::TriangleTree& tree,
                                     const reconstruction::Flap& flap, const GuideChoice& choice) {
    constexpr double reach = 10.0 * mm;
    std::vector<NearVessel> found;
    auto measured = guide.made.tubes.begin();
    for (const reconstruction::FlapVessel& vessel : flap.vessels) {
        const NearVessel near{fmt::format("vessel '{}'", vessel.name), measured->distance, measured->at};
        if (near.away < std::max(choice.limits.vessel, choice.limits.touch)) found.push_back(near);
        ++measured;
    }
    const cutting_guide::BaseSpan& line = guide.design.base.front();
    for (const reconstruction::Perforator& p : flap.perforators) {
        NearVessel near{fmt::format("perforator '{}'", p.name), measured->distance, p.at, true};
        ++measured;
        Vec3 out = p.at - line.point;
        out -= glm::dot(out, line.axis) * line.axis;
        if (glm::length(out) > 0.0)
            near.is_covered = tree.sweep(p.at, reach * glm::normalize(out), choice.limits.perforator_radius) < 1.0;
        if (near.is_covered || near.away < std::max(choice.limits.perforator, choice.limits.touch))
            found.push_back(std::move(near));
    }
    return found;
}

/// m from a hole's rim to a cut, if the hole is beside it.
std::optional<double> hole_to_cut(const GuideHole& hole, const GuideCut& cut) {
    if (glm::length(hole.at - cut.plane.origin) > 30.0 * mm) return {};
    return std::abs(glm::dot(hole.at - cut.plane.origin, cut.plane.normal)) - hole.radius;
}

/// "near slot C": the one whose walls are nearest; without slots the nearest fragment.
std::string near_slot(const PlannedGuide& guide, const Vec3& p) {
    if (guide.made.slots.empty()) {
        const auto away = [&](const cutting_guide::BaseSpan& b) { return glm::length(b.on->at - p); };
        const auto nearest = std::ranges::min_element(guide.design.base, {}, away) - guide.design.base.begin();
        return fmt::format("near fragment '{}'", guide.held[static_cast<std::size_t>(nearest)].name);
    }
    const cutting_guide::GuideCut& cut = guide.made.slots[cutting_guide::nearest_slot(guide.made.slots, p)].cut;
    return fmt::format("near slot {} ({})", cut.letter, cut.name);
}

std::string place_of(const Vec3& p) { return fmt::format("{:.1f}, {:.1f}, {:.1f} mm", p.x / mm, p.y / mm, p.z / mm); }

/// "touches vessel 'artery'". An overlap that would print as 0.00 mm is a touch.
std::string meeting_of(const NearVessel& v) {
    if (v.is_covered) return fmt::format("covers the place where the bone is left by {}", v.name);
    if (v.away > -0.005 * mm) return fmt::format("touches {}", v.name);
    return fmt::format("overlaps {} by {:.2f} mm", v.name, -v.away / mm);
}

void warn_clinically(PlannedGuide& guide) {
    const GuideLimits& limits = guide.choice.limits;
    const auto warn = [&](const char* code, std::string text) { guide.warnings.push_back({code, std::move(text)}); };
    const cutting_guide::Seat& seat = guide.seat;
    if (seat.play > limits.max_play)
        warn(
            "seat-play",
            seat.play >= cutting_guide::max_play
                ? std::string("the bone does not hold the guide along one direction, as along a smooth shaft: mark its "
                              "place by a screw or a distance from the end of the bone")
                : fmt::format("with a gap of {:.3g} mm the guide can move by {:.1f} mm on the bone",
                              limits.seat_gap / mm, seat.play / mm));
    if (seat.play_angle > limits.max_turn)
        warn("seat-angle", fmt::format("with a gap of {:.3g} mm the guide can turn by {:.1f}° on the bone",
                                       limits.seat_gap / mm, seat.play_angle / degree));
    if (seat.contact_share() < limits.min_contact_share)
        warn("contact", fmt::format("only {:.0f} % of the faces that look at the bone touch it; the others lie over "
                                    "undercuts",
                                    100.0 * seat.contact_share()));
    for (const cutting_guide::MadeSlot& slot : guide.made.slots)
        if (!slot.play)
            warn("ledge",
                 fmt::format("slot {} is a ledge: it does not hold the blade on the removed side", slot.cut.letter));
    if (guide.overhang > limits.max_overhang_share)
        warn("overhang",
             fmt::format("{:.0f} % of the surface hangs over by more than {:.0f}° when the guide is printed "
                         "with the bone's side up",
                         100.0 * guide.overhang, limits.overhang / degree));
    for (const GuideHole& hole : guide.made.holes)
        for (const GuideCut& cut : guide.design.cuts)
            if (const auto away = hole_to_cut(hole, cut); away && *away < limits.hole_to_cut)
                warn("hole-near-cut", fmt::format("{} lies {:.1f} mm from cut {}", hole.name, *away / mm, cut.letter));
    for (const NearVessel& v : guide.vessels)
        if (const double limit = v.is_perforator ? limits.perforator : limits.vessel; v.away < limit)
            warn(v.is_perforator ? "perforator" : "vessel",
                 fmt::format("{} runs {:.2f} mm from the guide, less than {:.3g} mm", v.name, v.away / mm, limit / mm));
}

}  // namespace

const char* name_of(GuideBone bone) {
    switch (bone) {
        case GuideBone::fibula: return "fibula";
        case GuideBone::jaw: return "jaw";
        case GuideBone::reduction: return "reduction";
    }
    return "";
}

GuideDesign design_guide(const FlapStudy& study, const std::string& title, const GuideChoice& choice) {
    GuideDesign design = choice.bone == GuideBone::fibula ? of_fibula(study, choice) : of_jaw(study, choice);
    const Vec3 x = design.along;
    bool to_right = false;
    std::string side;
    if (choice.bone == GuideBone::fibula) {
        // The donor's line runs from the foot to the knee.
        to_right = glm::dot(x, study.inputs().line_direction) < 0.0;
        side = study.inputs().leg == reconstruction::Leg::left ? "L" : "R";
    } else {
        to_right = x.y < 0.0;
        Vec3 middle(0.0);
        for (const Vec3& v : design.bone.vertices) middle += v / static_cast<double>(design.bone.vertices.size());
        const auto is_left = [&](const GuideCut& c) { return c.plane.origin.x > middle.x; };
        side = std::ranges::all_of(design.cuts, is_left)    ? "L"
               : std::ranges::none_of(design.cuts, is_left) ? "R"
                                                            : "LR";
    }
    std::string letters;
    for (const GuideCut& cut : design.cuts) letters += cut.letter;
    add_texts(design, title, choice, side, to_right, letters);
    return design;
}

void refuse_guide(const PlannedGuide& guide) {
    const mesh::MeshTopology& topology = guide.topology;
    if (!topology.is_watertight())
        throw Error(fmt::format("the guide's mesh is not closed: {} open, {} crowded, {} flipped edges",
                                topology.boundary_edges, topology.non_manifold_edges, topology.flipped_edges));
    if (!(guide.volume > 0.0)) throw Error("the guide's mesh is inside out");
    if (topology.components != 1)
        throw Error(
            fmt::format("the guide falls into {} parts: another approach (--turn), a wider base (--wrap), "
                        "three sides (--sides 3) or one guide per cut of a jaw (--cut) may join them",
                        topology.components));
    if (guide.intersections > 0)
        throw Error(fmt::format("the guide's mesh intersects itself in {} places", guide.intersections));
    const cutting_guide::GuideSettings& set = guide.design.settings;
    const double wanted = set.min_thickness() - cutting_guide::wall_slack;
    if (guide.made.wall && guide.made.wall->thickness < wanted) {
        throw Error(fmt::format(
            "a wall {} is {:.2f} mm thick, less than {:.3g} mm (the thinnest part to print, {:.3g} mm, "
            "less {:.3g} mm), at {}: more space between the segments ('between_space_mm' of the inputs), a narrower "
            "slot "
            "(--blade, --clearance), three sides (--sides 3) or another approach (--turn) may leave more of it",
            near_slot(guide, guide.made.wall->at), guide.made.wall->thickness / mm, wanted / mm,
            set.min_thickness() / mm, cutting_guide::wall_slack / mm, place_of(guide.made.wall->at)));
    }
    if (guide.made.thin_share > guide.choice.limits.max_thin_share)
        throw Error(fmt::format(
            "{:.1f} % of the guide's volume are left out as thinner than {:.1f} mm, more than {:.3g} %: a "
            "thicker base (--thickness), thicker walls of the slots (--wall), more space between the segments "
            "('between_space_mm' of the inputs) or a lower least wall (--min-wall) keep more of it",
            100.0 * guide.made.thin_share, set.min_thickness() / mm, 100.0 * guide.choice.limits.max_thin_share));
    if (!guide.seat.is_path_free) {
        throw Error(fmt::format("bone is in the way of the guide along its approach {}, at {}: turn it (--turn)",
                                near_slot(guide, guide.seat.blocked_at), place_of(guide.seat.blocked_at)));
    }
    if (guide.seat.min_distance < set.offset - 0.1 * mm)
        throw Error(
            fmt::format("the guide comes within {:.2f} mm of the bone, closer than its offset of {:.2f} mm: a "
                        "larger offset (--offset) may mend that",
                        guide.seat.min_distance / mm, set.offset / mm));
    if (!(guide.seat.contact_area > 0.0))
        throw Error("the guide does not touch the bone: choose another approach (--turn) or a wider base (--wrap)");
    for (const HeldFragment& held : guide.held) {
        if (held.contact_area < guide.choice.limits.min_region)
            throw Error(fmt::format(
                "the base touches fragment '{}' on {:.0f} mm², less than {:.3g} mm²: another approach (--turn), a "
                "longer or wider base (--end, --wrap) may reach it; else leave it out (--fragments)",
                held.name, held.contact_area * 1e6, guide.choice.limits.min_region * 1e6));
        if (held.holes == 0)
            throw Error(
                fmt::format("no hole for a screw fits into the base on fragment '{}': a longer base (--end), "
                            "thinner screws (--screw) or another approach (--turn) may make room; else leave "
                            "it out (--fragments)",
                            held.name));
    }
    for (const NearVessel& v : guide.vessels) {
        if (v.away >= guide.choice.limits.touch && !v.is_covered) continue;
        throw Error(fmt::format(
            "the guide {}, at {}: another approach (--turn), a narrower base (--wrap) or segments from another part of "
            "the bone avoid it",
            meeting_of(v), place_of(v.at)));
    }
    for (const GuideHole& hole : guide.made.holes)
        for (const GuideCut& cut : guide.design.cuts)
            if (const auto away = hole_to_cut(hole, cut); away && *away < 0.0)
                throw Error(fmt::format("{} meets cut {} ({}): move it in the plan, or give a smaller --screw",
                                        hole.name, cut.letter, cut.name));
    for (std::size_t n = 0; n < guide.refits.size(); ++n) {
        const cutting_guide::SlotFit& fit = guide.refits[n];
        const cutting_guide::MadeSlot& slot = guide.made.slots[n];
        if (const double share = fit.kept_area / slot.area(); share < set.min_wall_share)
            throw Error(fmt::format(
                "of the wall of slot {} ({}) that lies on plan, {:.0f} % are left beside its neighbour, less than "
                "{:.3g} %: more space between the segments ('between_space_mm' of the inputs), a lower "
                "slot (--depth), or another approach (--turn) leaves more",
                slot.cut.letter, slot.cut.name, 100.0 * share, 100.0 * set.min_wall_share));
        if (std::abs(fit.offset) > 0.05 * mm || fit.angle > 0.1 * degree)
            throw Error(
                fmt::format("slot {} lies {:.2f} mm and {:.2f}° off the plan, more than 0.05 mm or 0.1°: a finer "
                            "grid (--voxel) or another approach (--turn) may mend that",
                            guide.made.slots[n].cut.letter, fit.offset / mm, fit.angle / degree));
        if (guide.made.slots[n].sides != cutting_guide::Sides::one && !(fit.width > 0.0))
            throw Error(fmt::format("slot {} lacks its second wall", guide.made.slots[n].cut.letter));
        if (fit.width > 0.0 && std::abs(fit.width - guide.made.slots[n].width) > 0.05 * mm)
            throw Error(fmt::format("slot {} is {:.2f} mm wide instead of {:.2f} mm", guide.made.slots[n].cut.letter,
                                    fit.width / mm, guide.made.slots[n].width / mm));
    }
}

PlannedGuide measured_guide(GuideDesign design, const GuideChoice& choice) {
    const RunJobs run = on_threads();
    PlannedGuide guide;
    guide.bone = choice.bone;
    guide.design = std::move(design);
    guide.choice = choice;
    guide.made = cutting_guide::make_guide(guide.design, run);
    const geometry::TriangleSurface& surface = guide.made.surface;
    const geometry::TriangleTree bone(guide.design.bone);
    guide.topology = mesh::topology_of(surface);
    guide.intersections = geometry::self_intersections(surface, 100, run).size();
    guide.volume = mesh::volume_of(surface);
    guide.seat =
        cutting_guide::seat_of(surface, bone, glm::normalize(guide.design.removal), guide.design.settings.offset,
                               choice.limits.seat_gap, choice.limits.free_path, run);
    guide.overhang =
        cutting_guide::overhang_share(surface, -glm::normalize(guide.design.removal), choice.limits.overhang);
    for (const cutting_guide::MadeSlot& slot : guide.made.slots)
        guide.refits.push_back(cutting_guide::refit_slot(surface, slot));
    return guide;
}

PlannedGuide measured_guide(const FlapStudy& study, const std::string& title, const GuideChoice& choice) {
    GuideDesign design = design_guide(study, title, choice);
    if (choice.bone == GuideBone::fibula) design.tubes = tubes_of(study.flap(), choice);
    PlannedGuide guide = measured_guide(std::move(design), choice);
    guide.kerf = study.inputs().kerf;
    if (guide.bone == GuideBone::fibula)
        guide.vessels = vessels_near(guide, geometry::TriangleTree(guide.made.surface), study.flap(), choice);
    return guide;
}

void warn_of(PlannedGuide& guide) {
    for (const std::string& note : guide.made.notes) guide.warnings.push_back({"changed", note});
    warn_clinically(guide);
}

PlannedGuide plan_guide(const FlapStudy& study, const std::string& title, const GuideChoice& choice) {
    PlannedGuide guide = measured_guide(study, title, choice);
    refuse_guide(guide);
    warn_of(guide);
    const reconstruction::FibulaPlan placed = study.placed_plan();
    for (std::size_t n = 0; n < placed.segments.size(); ++n) {
        const Pose &now = placed.segments[n].donor_to_target, &planned = study.fibula().segments[n].donor_to_target;
        const Vec3 middle = planned.inverse().apply(study.inputs().planes[n].origin);
        if (glm::length(now.apply(middle) - planned.apply(middle)) > max_away ||
            glm::length(glm::cross(now.orientation * Vec3(1.0, 0.0, 0.0), planned.orientation * Vec3(1.0, 0.0, 0.0))) >
                max_turned ||
            glm::length(glm::cross(now.orientation * Vec3(0.0, 0.0, 1.0), planned.orientation * Vec3(0.0, 0.0, 1.0))) >
                max_turned)
            guide.warnings.push_back(
                {"moved",
                 fmt::format("segment {} is not at its planned place: the guide, its cuts and the holes for its screws "
                             "are those of the plan",
                             n + 1)});
    }
    return guide;
}

}  // namespace tactus::analysis
