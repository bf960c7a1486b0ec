// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/guide.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/cutting_guide/guide_checks.hpp"
#include "dsp/cutting_guide/guide_solid.hpp"
#include "dsp/cutting_guide/thin_parts.hpp"
#include "dsp/geometry/closest_point.hpp"
#include "dsp/geometry/surface_volume.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

namespace tactus::cutting_guide {

namespace {

// m: bodies that are subtracted side by side overlap by this much, so that no skin is left between them.
constexpr double overlap = 2e-6;
constexpr double ledge = 3e-3;  // m: what is free in front of a ledge
constexpr double crumb = 8e-9;  // m³: smaller parts fall off and are removed
constexpr double loose = 500e-9;  // m³: smaller parts may come off when thin ones are left out
constexpr double max_samples = 150e6;
constexpr std::size_t max_rounds = 3;  // of leaving out what is thin
// m: of the grid of the bone. Neither this nor its origin depends on the voxel, so that a coarser mesh is one of the
// same solid.
constexpr double bone_spacing = 0.5 * mm;
constexpr int slide_steps = 8;  // of a hole

/// A cut in the frame of the guide.
struct Slot {
    Vec3 origin, normal;
    double low_y = infinity, high_y = -infinity, top = -infinity;  // of the bone in the plane
    double bottom = infinity;  // of the block: below the widest place of the bone, where no thin edge can be left
    double end_y = 0.0;  // of the block, at the open end of the slot
    Sides sides = Sides::three;
    std::optional<std::size_t> faces{};  // the cut with which it shares a free space, without a strip between them

    double out_of(const Vec3& p) const { return glm::dot(normal, p - origin); }
    /// x at which the plane passes through (y, z).
    double x_at(double y, double z) const {
        return origin.x - (normal.y * (y - origin.y) + normal.z * (z - origin.z)) / normal.x;
    }
};

/// A hole at one of the places along its slide, in steps.
struct PlacedHole {
    const GuideHole* hole;
    int step;
    MadeHole made;
    Body body;
};

/// The solid without the parts that were dropped from its mesh.
struct KeptSolid {
    const GuideSolid& solid;
    const geometry::TriangleTree& tree;  ///< of the mesh
    const geometry::TriangleSurface* mesh;  ///< null: none were dropped

    bool has(const Vec3& p) const { return solid.value(p) < 0.0 && (!mesh || winding(*mesh, p) > 0.5); }
    /// Whether a point on the solid's surface is one of the mesh, whose triangles lie up to `sag` within round faces.
    bool is_near(const Vec3& p) const {
        constexpr double sag = 0.2 * mm;
        return !mesh || tree.nearest(p, sag).distance < sag;
    }

private:
    /// By solid angles (Van Oosterom, Strackee 1983): 1 inside, 0 outside.
    static double winding(const geometry::TriangleSurface& surface, const Vec3& p) {
        double sum = 0.0;
        for (const auto& t : surface.triangles) {
            const auto from = [&](std::size_t n) { return surface.vertices[static_cast<std::size_t>(t[n])] - p; };
            const Vec3 a = from(0), b = from(1), c = from(2);
            const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
            sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                              x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
        }
        return sum / (2.0 * pi);
    }
};

void check(const GuideSettings& s) {
    const auto positive = [](double value, const char* what) {
        if (!(value > 0.0 && value < 1.0)) throw Error(fmt::format("a guide needs a {} above 0", what));
    };
    positive(s.thickness, "thickness"), positive(s.blade, "thickness of the blade"), positive(s.depth, "depth of slot");
    positive(s.wall, "thickness of walls"), positive(s.voxel, "voxel"), positive(s.rail, "thickness of its rail");
    if (!(s.offset > 0.0)) throw Error("a guide needs an offset above 0 from the bone: without it, it does not seat");
    if (!(s.clearance > 0.0))
        throw Error("a slot needs a clearance above 0 on either side of its blade: without it, the blade jams");
    if (!(s.wrap > 0.1 && s.wrap < 6.0)) throw Error("a guide wraps the bone by 6 to 340 degrees");
    if (!(s.text_depth < s.rail)) throw Error("the text is as deep as the rail is thick");
}

class Maker {
public:
    Maker(const GuideDesign& design, const RunJobs& run) : design_(design), set_(design.settings), run_(run) {}

    MadeGuide make() {
        check(set_);
        if ((design_.cuts.empty() && design_.fragments.empty()) || design_.base.empty())
            throw Error("a guide needs at least one base, and cuts or fragments");
        if (!design_.fragments.empty() && set_.offset + set_.thickness - set_.relief < set_.min_thickness())
            throw Error(
                fmt::format("the base is too thin over a fracture line, where {:.1f} mm of it are relieved: a "
                            "thicker base or a smaller relief leaves more",
                            set_.relief / mm));
        make_frame();
        find_slots();
        find_heights();
        find_grid();
        const geometry::TriangleTree tree(bone_);
        const double cap = set_.offset + set_.thickness + 2.0 * mm;
        const SeatedBone bone(bone_, tree, low_ - Vec3(1.0 * mm), high_ + Vec3(1.0 * mm), bone_spacing, cap, run_);
        find_patches(bone);
        lift_rail(bone);
        GuideSolid solid(bone);
        add_parts(solid);
        add_cuts(solid, bone);
        geometry::Contour contour = contour_of(solid, bone);
        keep_walls(contour.surface);
        made_.flipped = contour.flipped, made_.smoothed = contour.smoothed;
        for (Vec3& v : contour.surface.vertices) v = made_.frame.apply(v);
        made_.surface = std::move(contour.surface);
        return std::move(made_);
    }

private:
    /// Without what is thinner than it may be.
    geometry::Contour contour_of(GuideSolid& solid, const SeatedBone& bone) {
        const volume::Grid grid = layout();
        const std::vector<Body> texts = text_bodies();
        const double limit = set_.min_thickness() - wall_slack;
        // Walls between letters are as thin as their strokes are near: they do not hold the guide together.
        const double face = rail_y_ - set_.rail, skin = face + set_.text_depth + 0.05 * mm;
        const auto counts = [&](const Vec3& p) {
            return p.y > skin || (slots_.empty() && (p.y < face - 0.05 * mm || p.z < top_ - rail_height(set_)));
        };
        std::vector<bool> is_trimmed_at(slots_.size());
        double whole_before = 0.0;  // with the loose parts; 0: nothing was left out since
        for (;;) {
            const std::size_t plain = solid.cuts.size();
            solid.cuts.insert(solid.cuts.end(), texts.begin(), texts.end());
            geometry::Contour contour = geometry::dual_contour(grid, solid, thin_cuts_.empty() ? crumb : loose, run_);
            solid.cuts.resize(plain);
            if (contour.surface.triangles.empty())
                throw Error("nothing is left of the guide: it does not reach the bone");
            const double volume = geometry::volume_of(contour.surface), whole = volume + contour.crumb_volume;
            if (whole_before > 0.0) made_.thin_volume += std::max(0.0, whole_before - whole);
            whole_before = 0.0;
            const geometry::TriangleTree tree(contour.surface);
            const Walls walls = walls_of(contour.surface, tree, limit, counts, run_);
            if (walls.is_thin() && thin_cuts_.size() < max_rounds) {
                for (const ThinWall& wall : slots_.empty() ? std::vector<ThinWall>{} : walls.thin)
                    is_trimmed_at[nearest_slot(made_.slots, made_.frame.apply(wall.at))] = true;
                whole_before = whole;
                thin_cuts_.push_back(thin_parts(solid, tree, walls, limit, run_));
                subtract(solid);
                continue;
            }
            if (!check_holes(solid, bone, tree, limit)) continue;
            for (PlacedHole& hole : holes_) made_.holes.push_back(std::move(hole.made));
            made_.wall = walls.thinnest;
            if (made_.wall) made_.wall->at = made_.frame.apply(made_.wall->at);
            made_.tapers = walls.tapers;
            for (auto& taper : made_.tapers)
                if (taper) taper->at = made_.frame.apply(taper->at);
            made_.thin_volume += contour.crumb_volume;
            made_.thin_share = made_.thin_volume / (volume + made_.thin_volume);
            made_.loose_parts = contour.crumbs;
            note_trimmed(is_trimmed_at, contour.crumb_volume);
            const KeptSolid kept{solid, tree, contour.crumbs > 0 ? &contour.surface : nullptr};
            for (const Tube& tube : design_.tubes) made_.tubes.push_back(distance_to(tube, kept));
            return contour;
        }
    }

    /// The mesh finds the place: that of the points along the tube, 0.25 mm apart, which is nearest to the guide or
    /// deepest in it. Outside of the guide, the nearest points on the solid and on the line of the tube are then sought
    /// in turn, so that the distance does not depend on the mesh: its triangles are up to voxel² / 8 / radius within
    /// round faces.
    TubeDistance distance_to(const Tube& tube, const KeptSolid& kept) const {
        constexpr double step = 0.25 * mm;
        std::vector<Vec3> line;
        for (const Vec3& p : tube.points) line.push_back(to_guide_.apply(p));
        if (line.size() == 1) line.push_back(line.front());
        double least = max_tube_distance + tube.radius;
        Vec3 at = line.front(), on_guide(0.0);
        std::size_t piece = line.size();
        for (std::size_t n = 0; n + 1 < line.size(); ++n) {
            const int steps = 1 + static_cast<int>(glm::length(line[n + 1] - line[n]) / step);
            for (int k = 0; k <= steps; ++k) {
                const Vec3 p = glm::mix(line[n], line[n + 1], static_cast<double>(k) / steps);
                const bool is_within = kept.has(p);
                if (!is_within && least < 0.0) continue;
                const auto near = is_within ? kept.tree.nearest(p) : kept.tree.nearest(p, least);
                const double here = is_within ? -near.distance : near.distance;
                if (here < least) least = here, at = p, on_guide = near.point, piece = n;
            }
        }
        for (int round = 0; round < 20 && least > 0.0 && piece < line.size(); ++round) {
            on_guide = nearest_on(kept, at, on_guide);
            const Vec3 before = at;
            for (std::size_t n = piece > 0 ? piece - 1 : 0; n < std::min(piece + 2, line.size() - 1); ++n)
                if (const Vec3 q = geometry::closest_on_segment(on_guide, line[n], line[n + 1]);
                    glm::length(q - on_guide) < glm::length(at - on_guide))
                    at = q;
            least = glm::length(at - on_guide);
            if (glm::length(at - before) < 0.1 * tube_tolerance) break;
        }
        return {std::min(least - tube.radius, max_tube_distance), made_.frame.apply(at)};
    }

    /// The point on the surface of the solid nearest to `p`, from `start` near it: steps along the surface towards `p`,
    /// each led back onto the surface by the normal, while they come nearer.
    static Vec3 nearest_on(const KeptSolid& kept, const Vec3& p, const Vec3& start) {
        const GuideSolid& solid = kept.solid;
        const auto onto = [&](Vec3 q) {
            for (int n = 0; n < 4; ++n) q -= solid.value(q) * solid.normal(q);
            return q;
        };
        // At an edge of two faces the steps may end beside the solid.
        const auto is_on = [&](const Vec3& q) {
            return std::abs(solid.value(q)) < 0.1 * tube_tolerance && kept.is_near(q);
        };
        Vec3 found = onto(start);
        if (!is_on(found)) return start;
        for (int n = 0; n < 30; ++n) {
            const Vec3 normal = solid.normal(found), to = p - found;
            const Vec3 next = onto(found + 0.5 * (to - glm::dot(to, normal) * normal));
            if (!is_on(next) || !(glm::length(p - next) < glm::length(to) - 1e-3 * tube_tolerance)) break;
            found = next;
        }
        return found;
    }

    void note_trimmed(const std::vector<bool>& is_trimmed_at, double loose_volume) {
        std::string letters;
        for (std::size_t n = 0; n < slots_.size(); ++n)
            if (is_trimmed_at[n]) letters += fmt::format("{}{}", letters.empty() ? "" : ", ", design_.cuts[n].letter);
        if (!letters.empty() || (slots_.empty() && !thin_cuts_.empty()))
            made_.notes.push_back(fmt::format(
                "parts thinner than {:.1f} mm{} are left out: {:.1f} % of the guide's volume",
                set_.min_thickness() / mm, letters.empty() ? "" : " near slot " + letters, 100.0 * made_.thin_share));
        if (made_.loose_parts > 0)
            made_.notes.push_back(fmt::format("{} loose part{} of {:.0f} mm³ in all {} dropped", made_.loose_parts,
                                              made_.loose_parts == 1 ? "" : "s", loose_volume * 1e9,
                                              made_.loose_parts == 1 ? "is" : "are"));
    }

    /// A slot of which too little is left beside the kept one becomes a ledge.
    void keep_walls(const geometry::TriangleSurface& surface) {
        geometry::TriangleSurface placed = surface;
        for (Vec3& v : placed.vertices) v = made_.frame.apply(v);
        for (MadeSlot& slot : made_.slots) {
            if (slot.sides == Sides::one) continue;
            const SlotFit fit = refit_slot(placed, slot);
            if (fit.other_area >= set_.min_wall_share * slot.area()) continue;
            made_.notes.push_back(
                fmt::format("of the second wall of slot {} {:.0f} % are left, less than {:.0f} %: the blade is held on "
                            "the kept side "
                            "only",
                            slot.cut.letter, 100.0 * fit.other_area / slot.area(), 100.0 * set_.min_wall_share));
            slot.sides = Sides::one, slot.play.reset();
        }
    }

    void make_frame() {
        const Vec3 z = glm::normalize(design_.removal);
        Vec3 x = design_.along - glm::dot(design_.along, z) * z;
        if (!(glm::length(x) > 0.2 * glm::length(design_.along)))
            throw Error("the guide would be taken off along itself: choose another approach");
        x = glm::normalize(x);
        const Vec3 y = glm::cross(z, x);
        Vec3 middle(0.0);
        for (const GuideCut& c : design_.cuts) middle += c.plane.origin / static_cast<double>(design_.cuts.size());
        if (design_.cuts.empty())
            for (const BaseSpan& b : design_.base) middle += b.point / static_cast<double>(design_.base.size());
        made_.frame = {middle, glm::normalize(glm::quat_cast(Mat3(x, y, z)))};
        to_guide_ = made_.frame.inverse();
        bone_ = design_.bone;
        for (Vec3& v : bone_.vertices) v = to_guide_.apply(v);
    }

    void find_slots() {
        for (const GuideCut& c : design_.cuts) {
            Slot s;
            s.origin = to_guide_.apply(c.plane.origin), s.normal = to_guide_.rotate(glm::normalize(c.plane.normal));
            s.sides = set_.sides;
            const double tilt = std::asin(std::clamp(std::abs(s.normal.z), 0.0, 1.0)),
                         across = std::abs(s.normal.x) / std::max(1e-9, std::hypot(s.normal.x, s.normal.y));
            if (tilt > set_.max_lean || across < std::cos(set_.max_lean))
                throw Error(fmt::format(
                    "no blade can come along the approach into the plane of cut {} ({}): they are {:.0f}° apart; "
                    "choose another approach",
                    c.letter, c.name, tilt > set_.max_lean ? tilt / degree : std::acos(across) / degree));
            const reconstruction::Plane plane{s.origin, s.normal};
            const reconstruction::Section section = reconstruction::section_of(bone_, plane, &s.origin);
            if (section.points.empty())
                throw Error(fmt::format("the plane of cut {} ({}) does not meet the bone", c.letter, c.name));
            for (const Vec3& p : section.points) s.top = std::max(s.top, p.z);
            // The block must reach beyond the bone along its whole thickness.
            for (const double out : {0.0, -set_.wall, set_.slot_width() + set_.wall}) {
                const reconstruction::Plane beside{s.origin + out * s.normal, s.normal};
                const reconstruction::Section cut = reconstruction::section_of(bone_, beside, &beside.origin);
                for (const Vec3& p : cut.points) s.low_y = std::min(s.low_y, p.y), s.high_y = std::max(s.high_y, p.y);
            }
            for (const Vec3& p : section.points)
                if (p.y < s.low_y + 1.0 * mm || p.y > s.high_y - 1.0 * mm)
                    s.bottom = std::min(s.bottom, p.z - 1.0 * mm);
            s.bottom = std::min(s.bottom, s.top - 3.0 * mm);
            s.end_y = set_.cover < 1.0 ? s.low_y + set_.cover * (s.high_y - s.low_y)
                                       : s.high_y + std::max(set_.beyond, set_.offset + set_.min_wall + 0.2 * mm);
            slots_.push_back(s);
        }
    }

    void find_heights() {
        rail_y_ = infinity, top_ = -infinity;
        for (const Slot& s : slots_) {
            rail_y_ = std::min(rail_y_, s.low_y - set_.beyond);
            top_ = std::max(top_, s.top + set_.depth);
        }
        if (slots_.empty()) find_bridge();
        find_rail();
    }

    /// The rail stands on the bases in the middle of the bone.
    void find_bridge() {
        rail_y_ = 0.5 * set_.rail;
        const auto [from, to] = base_range();
        double highest = -infinity;
        for (const auto& triangle : bone_.triangles) {
            std::vector<Vec3> part;
            for (const int v : triangle) part.push_back(bone_.vertices[static_cast<std::size_t>(v)]);
            for (const double sign : {-1.0, 1.0}) {
                clip(part, Vec3(sign < 0.0 ? to : from, 0.0, 0.0), Vec3(sign, 0.0, 0.0));
                clip(part, Vec3(0.0, -sign * rail_y_, 0.0), Vec3(0.0, sign, 0.0));
            }
            for (const Vec3& p : part) highest = std::max(highest, p.z);
        }
        if (!std::isfinite(highest)) throw Error("no bone lies below the bridge of the guide: choose another approach");
        top_ = highest + set_.offset + set_.thickness + rail_height(set_);
    }

    /// x of the ends of all bases.
    std::pair<double, double> base_range() const {
        double from = infinity, to = -infinity;
        for (const BaseSpan& b : design_.base)
            for (const double t : {b.from, b.to}) {
                const double x = to_guide_.apply(b.point + t * b.axis).x;
                from = std::min(from, x), to = std::max(to, x);
            }
        return {from, to};
    }

    // Along x the rail reaches over all blocks, and is as long as its texts.
    void find_rail() {
        rail_low_ = top_ - rail_height(set_);
        double low = infinity, high = -infinity;
        if (slots_.empty()) std::tie(low, high) = base_range();
        for (const Slot& s : slots_)
            for (const double z : {rail_low_, top_})
                for (const double y : {rail_y_ - set_.rail, rail_y_}) {
                    const double x = s.x_at(y, z), thick = (set_.wall + set_.slot_width()) / std::abs(s.normal.x);
                    low = std::min(low, x - thick), high = std::max(high, x + thick);
                }
        // A letter lies on the kept side of its cut.
        for (std::size_t n = 0; n < design_.letters.size(); ++n) {
            const double x = letter_x(n);
            low = std::min(low, x - 1.0 * mm), high = std::max(high, x + design_.letters[n].width + 1.0 * mm);
        }
        double wanted = 0.0;
        for (const GuideText& t : design_.text) wanted = std::max(wanted, t.width + 4.0 * mm);
        if (high - low < wanted) {
            // Towards the middle of the base.
            double middle = 0.0;
            for (const BaseSpan& b : design_.base)
                middle += to_guide_.apply(b.point + 0.5 * (b.from + b.to) * b.axis).x /
                          static_cast<double>(design_.base.size());
            const double more = wanted - (high - low);
            const double before = std::clamp(0.5 * (low + high) - middle + 0.5 * more, 0.0, more);
            low -= before, high += more - before;
        }
        rail_from_ = low, rail_to_ = high;
    }

    double letter_x(std::size_t n) const {
        if (slots_.empty()) {
            const BaseSpan& b = design_.base[n];
            return to_guide_.apply(b.on ? b.on->at : b.point).x - 0.5 * design_.letters[n].width;
        }
        const Slot& s = slots_[n];
        const double x = s.x_at(rail_y_ - set_.rail, top_ - 0.5 * rail_height(set_));
        return s.normal.x > 0.0 ? x - 1.0 * mm - design_.letters[n].width : x + 1.0 * mm;
    }

    /// Keeps what lies in front of a plane.
    static void clip(std::vector<Vec3>& polygon, const Vec3& origin, const Vec3& normal) {
        std::vector<Vec3> kept;
        for (std::size_t n = 0; n < polygon.size(); ++n) {
            const Vec3 &p = polygon[n], &q = polygon[(n + 1) % polygon.size()];
            const double a = glm::dot(p - origin, normal), b = glm::dot(q - origin, normal);
            if (a >= 0.0) kept.push_back(p);
            if ((a < 0.0) != (b < 0.0)) kept.push_back(glm::mix(p, q, a / (a - b)));
        }
        polygon = std::move(kept);
    }

    void find_grid() {
        low_ = Vec3(rail_from_, rail_y_ - set_.rail, rail_low_);
        high_ = Vec3(rail_to_, rail_y_, top_);
        const auto add = [&](const Vec3& p) { low_ = glm::min(low_, p), high_ = glm::max(high_, p); };
        for (const Slot& s : slots_) {
            const double wide = (set_.wall + set_.slot_width()) / std::abs(s.normal.x);
            for (const double y : {rail_y_ - set_.rail, s.end_y})
                for (const double z : {s.bottom, top_})
                    for (const double sign : {-1.0, 1.0}) add(Vec3(s.x_at(y, z) + sign * wide, y, z));
        }
        const double shell = set_.offset + set_.thickness + 0.5 * mm;
        for (const BaseSpan& b : design_.base) {
            const Vec3 point = to_guide_.apply(b.point), axis = to_guide_.rotate(b.axis);
            const Vec3 up = glm::normalize(Vec3(0.0, 0.0, 1.0) - axis.z * axis);
            for (const auto& triangle : bone_.triangles) {
                std::vector<Vec3> part;
                for (const int v : triangle) part.push_back(bone_.vertices[static_cast<std::size_t>(v)]);
                // Of a large triangle all of it counts within the span, whatever the angles of its corners are.
                const bool is_large = std::max({glm::length(part[0] - part[1]), glm::length(part[1] - part[2]),
                                                glm::length(part[2] - part[0])}) > 5.0 * mm;
                clip(part, point + (b.from - 8.0 * mm) * axis, axis);
                clip(part, point + (b.to + 8.0 * mm) * axis, -axis);
                for (Vec3 v : part) {
                    const Vec3 r = v - point - glm::dot(v - point, axis) * axis;
                    const double away = glm::length(r);
                    if (away > 40.0 * mm) {
                        if (!is_large) continue;
                        v += (40.0 * mm / away - 1.0) * r;
                    }
                    const double angle = std::acos(std::clamp(glm::dot(r, up) / std::max(1e-9, away), -1.0, 1.0));
                    if (!is_large && angle > 0.5 * set_.wrap + 0.2) continue;
                    add(v - Vec3(shell)), add(v + Vec3(shell));
                }
            }
        }
        low_ -= 2.0 * set_.voxel, high_ += 2.0 * set_.voxel;
        const Vec3 size = (high_ - low_) / set_.voxel;
        if (!(size.x * size.y * size.z < max_samples))
            throw Error(fmt::format(
                "the guide would be {:.0f} x {:.0f} x {:.0f} mm, too much for a voxel of {:.2f} mm: make one guide per "
                "cut, or take a coarser voxel",
                (high_.x - low_.x) / mm, (high_.y - low_.y) / mm, (high_.z - low_.z) / mm, set_.voxel / mm));
    }

    // The rail must clear the bone along its whole length; the blocks rise with it.
    void lift_rail(const SeatedBone& bone) {
        const double most = bone.top_within(Vec3(rail_from_, rail_y_ - set_.rail, 0.0), Vec3(rail_to_, rail_y_, 0.0));
        const double lift = most + set_.rail_clearance - rail_low_;
        if (!(lift > 0.0)) return;
        if (lift > set_.max_lift)
            throw Error(
                fmt::format("bone stands {:.0f} mm in the way of the rail that {}: choose another approach, or make {}",
                            lift / mm, slots_.empty() ? "bridges the fractures" : "joins the slots",
                            slots_.empty() ? "guides of fewer fragments" : "one guide per cut"));
        const std::string higher = slots_.empty()
                                       ? fmt::format("the bridge is {:.1f} mm higher, so that its text", lift / mm)
                                       : fmt::format("the slots are {:.1f} mm deeper, so that the rail", lift / mm);
        made_.notes.push_back(higher + " clears the bone");
        top_ += lift;
        find_rail();
        high_.z = std::max(high_.z, top_ + 2.0 * set_.voxel);
        cover_rail();
    }

    void cover_rail() {
        low_.x = std::min(low_.x, rail_from_ - 2.0 * set_.voxel);
        high_.x = std::max(high_.x, rail_to_ + 2.0 * set_.voxel);
    }

    volume::Grid layout() const {
        volume::Grid grid;
        grid.origin = low_;
        grid.spacing = Vec3(set_.voxel);
        for (int axis = 0; axis < 3; ++axis)
            grid.size[static_cast<std::size_t>(axis)] =
                static_cast<int>(std::ceil((high_[axis] - low_[axis]) / set_.voxel)) + 1;
        return grid;
    }

    /// What the base lies on. The rail keeps off the base: where they only graze, they would join by a thin web.
    void find_patches(const SeatedBone& bone) {
        const double reach = set_.offset + set_.thickness;
        std::vector<geometry::TriangleTree> fragments;
        for (geometry::TriangleSurface fragment : design_.fragments) {
            for (Vec3& v : fragment.vertices) v = to_guide_.apply(v);
            fragments.emplace_back(fragment);
        }
        find_relief(bone, fragments);
        const auto is_on = [&](const BaseSpan& b, const Vec3& p) {
            if (!b.on) return true;
            const double away = fragments[b.on->fragment].nearest(p, 2.0 * mm).distance;
            for (std::size_t n = 0; n < fragments.size(); ++n)
                if (n != b.on->fragment && fragments[n].nearest(p, away).distance < away) return false;
            return std::isfinite(away);
        };
        for (const BaseSpan& b : design_.base) {
            const Vec3 point = to_guide_.apply(b.point), axis = to_guide_.rotate(b.axis);
            const Vec3 up = glm::normalize(Vec3(0.0, 0.0, 1.0) - axis.z * axis);
            // Its round edge lies within the wrap, and in the middle of its height at the ends of the span, as far as the
            // patch is not too narrow for it.
            const double inset = std::min(0.5 * reach, 0.4 * (b.to - b.from)), half = 0.5 * set_.wrap;
            const auto belongs = [&](const Vec3& p, const Vec3& normal) {
                const double t = glm::dot(p - point, axis);
                if (t < b.from + inset || t > b.to - inset || !is_on(b, p)) return false;
                const Vec3 r = p - point - t * axis;
                const double away = glm::length(r);
                if (!(away > 0.0)) return false;
                const double angle = std::acos(std::clamp(glm::dot(r, up) / away, -1.0, 1.0));
                if (angle < 0.4 * half) return true;
                // As far away from the middle along the surface as the edge is wide.
                const Vec3 around = glm::dot(r, glm::cross(axis, up)) < 0.0 ? -axis : axis;
                const Vec3 step = glm::cross(around, normal);
                if (!(glm::length(step) > 0.1)) return false;
                const Vec3 edge =
                    r + reach * glm::normalize(glm::dot(step, glm::cross(around, r)) < 0.0 ? -step : step);
                return glm::dot(edge, up) > std::cos(half) * glm::length(edge);
            };
            const Vec3 at = b.on ? to_guide_.apply(b.on->at) : point + 0.5 * (b.from + b.to) * axis;
            patches_.push_back(std::make_shared<const Patch>(bone.patch_of(belongs, at, run_)));
        }
        if (slots_.empty()) return;
        double low = rail_y_;
        for (const auto& patch : patches_) low = std::min(low, patch->low.y - reach - 1.0 * mm);
        rail_y_ = low;
        low_.y = std::min(low_.y, rail_y_ - set_.rail - 2.0 * set_.voxel);
        find_rail();
        cover_rail();
    }

    /// What is near two fragments.
    void find_relief(const SeatedBone& bone, const std::vector<geometry::TriangleTree>& fragments) {
        std::vector<std::shared_ptr<const Patch>> near;
        for (const geometry::TriangleTree& tree : fragments)
            near.push_back(bone.distance_from(tree, set_.relief + 2.0 * bone_spacing, run_));
        const auto within = [&](std::size_t n) {
            Term term{Term::Kind::near, Vec3(0.0), Vec3(0.0), set_.relief};
            term.patch = near[n];
            return term;
        };
        const auto limit = static_cast<float>(set_.relief);
        for (std::size_t n = 0; n < near.size(); ++n)
            for (std::size_t m = 0; m < n; ++m) {
                const auto &a = near[m]->distance.grid.values, &b = near[n]->distance.grid.values;
                bool do_meet = false;
                for (std::size_t k = 0; k < a.size() && !do_meet; ++k) do_meet = a[k] < limit && b[k] < limit;
                if (do_meet) slot_cuts_.push_back({within(m), within(n)});
            }
    }

    void add_parts(GuideSolid& solid) {
        const Term above{Term::Kind::above, Vec3(0.0), Vec3(0.0), set_.offset};
        bool is_beyond_cuts = true;
        for (std::size_t n = 0; n < patches_.size(); ++n) {
            Term near{Term::Kind::near, Vec3(0.0), Vec3(0.0), set_.offset + set_.thickness};
            near.patch = patches_[n];
            solid.parts.push_back({std::move(near), above});
            if (const auto& until = design_.base[n].until) {
                solid.parts.back().push_back(plane(to_guide_.rotate(until->normal), to_guide_.apply(until->origin)));
                is_beyond_cuts = false;
            }
        }
        const double width = set_.slot_width();
        for (const Slot& s : slots_) {
            const auto block = [&](double out, double to) {
                solid.parts.push_back({plane(s.normal, s.origin + out * s.normal),
                                       plane(-s.normal, s.origin - set_.wall * s.normal), side(1, 1.0, s.end_y),
                                       side(1, -1.0, rail_y_ - set_.rail), side(2, 1.0, to), side(2, -1.0, s.bottom),
                                       above});
            };
            if (s.sides != Sides::one) {
                block(width + set_.wall, top_);
            } else {
                block(0.0, top_);
                // Beyond a ledge a low wall joins the base to the rail.
                if (is_beyond_cuts) block(std::max(width, ledge) + set_.wall, s.top + set_.offset + set_.thickness);
            }
        }
        add_rail(solid, rail_from_, rail_to_, rail_low_);
    }

    void add_rail(GuideSolid& solid, double from, double to, double low) const {
        solid.parts.push_back({side(0, 1.0, to),
                               side(0, -1.0, from),
                               side(1, 1.0, rail_y_),
                               side(1, -1.0, rail_y_ - set_.rail),
                               side(2, 1.0, top_),
                               side(2, -1.0, low),
                               {Term::Kind::above, Vec3(0.0), Vec3(0.0), set_.rail_clearance}});
    }

    /// Without slots the rail reaches down to the bases, over which it stands.
    void add_bridge(GuideSolid& solid, const SeatedBone& bone) const {
        double from = infinity, to = -infinity, low = infinity;
        for (const auto& patch : patches_) from = std::min(from, patch->low.x), to = std::max(to, patch->high.x);
        for (double x = from; x <= to; x += bone_spacing)
            if (const double top = bone.top(x, 0.0); std::isfinite(top)) low = std::min(low, top);
        add_rail(solid, from, to, low);
    }

    void add_cuts(GuideSolid& solid, const SeatedBone& bone) {
        const double width = set_.slot_width();
        solid.cuts = slot_cuts_;
        if (slots_.empty()) add_bridge(solid, bone);
        drop_strips(solid);
        for (std::size_t n = 0; n < slots_.size(); ++n) {
            const Slot& s = slots_[n];
            const double open = s.sides == Sides::one && !s.faces ? std::max(width, ledge) : width;
            Body between{plane(s.normal, s.origin + open * s.normal), plane(-s.normal, s.origin)};
            if (s.faces) between.push_back(beyond_crossing(s, slots_[*s.faces], width));
            Body body = between;
            body.push_back(side(1, -1.0, rail_y_));
            solid.cuts.push_back(std::move(body));
            if (set_.sides != Sides::three) {
                between.push_back(side(2, 1.0, rail_low_));
                solid.cuts.push_back(std::move(between));
            }
            note_slot(n);
        }
        slot_cuts_ = solid.cuts;
        for (const GuideHole& hole : design_.holes) place_hole(solid, bone, hole, 0, "the guide does not surround it");
    }

    /// Negative where the plane of `a`, moved out by `out`, has passed that of `b`, at any x. With the width of its slot:
    /// only there the blade of `a` needs room in the wall of `b`, whose face is on plan.
    static Term beyond_crossing(const Slot& a, const Slot& b, double out = 0.0) {
        const double ratio = b.normal.x / a.normal.x;
        Vec3 normal = b.normal - ratio * a.normal;
        const double size = glm::length(normal),
                     d = glm::dot(b.normal, b.origin) - ratio * (glm::dot(a.normal, a.origin) + out);
        // Parallel planes cross nowhere.
        if (size < 1e-6) return {Term::Kind::plane, Vec3(0.0), Vec3(0.0), -1.0};
        return {Term::Kind::plane, normal / size, Vec3(0.0), d / size + overlap};
    }

    /// A strip between the slots of two cuts that face each other is left out when it is too thin to print.
    void drop_strips(GuideSolid& solid) {
        for (std::size_t n = 0; n + 1 < slots_.size(); ++n) {
            Slot &a = slots_[n], &b = slots_[n + 1];
            if (a.out_of(b.origin) <= 0.0 || b.out_of(a.origin) <= 0.0) continue;
            double least = infinity;
            for (const double y : {rail_y_, std::max(a.end_y, b.end_y)})
                for (const double z : {std::min(a.top, b.top), top_}) {
                    const double sign = b.origin.x > a.origin.x ? 1.0 : -1.0;
                    least = std::min(least, sign * (b.x_at(y, z) - a.x_at(y, z)));
                }
            const double open = set_.sides == Sides::one ? std::max(ledge, set_.slot_width()) : set_.slot_width();
            const double strip = least - 2.0 * open;
            if (strip >= set_.min_wall) continue;
            const char x = design_.cuts[n].letter, y = design_.cuts[n + 1].letter;
            made_.notes.push_back(fmt::format(
                "{} the blade is held on the kept side of either only",
                strip > 0.0
                    ? fmt::format("the strip between slots {} and {} would be {:.1f} mm thick and is left out;", x, y,
                                  strip / mm)
                    : fmt::format("slots {} and {} meet within the guide; there is no strip between them, and", x, y)));
            a.sides = b.sides = Sides::one;
            a.faces = n + 1, b.faces = n;
            // Their blocks are made already: the space between the two planes is free.
            solid.cuts.push_back({plane(-a.normal, a.origin), plane(-b.normal, b.origin), side(1, -1.0, rail_y_)});
            // Where the planes have crossed, a wedge stands between them, which begins with an edge.
            if (Term gap = beyond_crossing(a, b); gap.n != Vec3(0.0)) {
                // One that does not reach the rail would be loose.
                const bool is_held = std::ranges::any_of(std::array{rail_low_, top_}, [&](double z) {
                    return a.x_at(rail_y_, z) > b.x_at(rail_y_, z) + set_.min_wall;
                });
                const Vec3 across = b.normal - b.normal.x / a.normal.x * a.normal;
                gap.n = -gap.n, gap.d = -gap.d + set_.min_wall * std::abs(b.normal.x) / glm::length(across);
                solid.cuts.push_back({plane(a.normal, a.origin + overlap * a.normal),
                                      plane(b.normal, b.origin + overlap * b.normal), side(1, -1.0, rail_y_)});
                if (is_held) solid.cuts.back().push_back(gap);
            }
        }
    }

    void note_slot(std::size_t n) {
        const Slot& s = slots_[n];
        MadeSlot slot;
        slot.cut = design_.cuts[n];
        slot.width = set_.slot_width();
        slot.depth = top_ - s.top;
        slot.length = s.end_y - rail_y_;
        slot.sides = s.sides;
        if (s.sides != Sides::one) slot.play = std::atan((slot.width - set_.blade) / slot.depth);
        const double y = 0.5 * (rail_y_ + s.end_y), z = s.top + 0.5 * slot.depth;
        slot.middle = made_.frame.apply(Vec3(s.x_at(y, z), y, z));
        slot.deep = made_.frame.rotate(glm::normalize(Vec3(0.0, 0.0, 1.0) - s.normal.z * s.normal));
        slot.wide = glm::cross(made_.frame.rotate(s.normal), slot.deep);
        made_.slots.push_back(std::move(slot));
    }

    /// The middle of the base in front of a hole, if the guide surrounds it there.
    std::optional<Vec3> surrounded(const GuideSolid& solid, const SeatedBone& bone, const Vec3& at, const Vec3& axis,
                                   double radius) const {
        const double level = set_.offset + 0.5 * set_.thickness;
        // Out of the bone against the axis, until the middle of the base.
        double t = -10.0 * mm;
        while (t < 25.0 * mm && bone.value(at - t * axis) < level) t += 0.1 * mm;
        if (!(t < 25.0 * mm)) return {};
        const Vec3 middle = at - t * axis;
        const Vec3 u = glm::normalize(
                       glm::cross(axis, std::abs(axis.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0))),
                   v = glm::cross(axis, u);
        // A wall is left around it.
        const double ring = radius + set_.min_wall + 0.1 * mm;
        for (int k = 0; k < 12; ++k) {
            const double a = k * pi / 6.0;
            if (!(solid.value(middle + ring * (std::cos(a) * u + std::sin(a) * v)) < 0.0)) return {};
        }
        return middle;
    }

    /// Makes a hole at the first place of its slide, from `step` on, where the guide surrounds it; without one it is
    /// left out.
    void place_hole(GuideSolid& solid, const SeatedBone& bone, const GuideHole& hole, int step, const char* reason) {
        const Vec3 axis = to_guide_.rotate(hole.axis);
        const int last = hole.slide == Vec3(0.0) ? 0 : slide_steps;
        for (; step <= last; ++step) {
            MadeHole moved{hole};
            moved.at += static_cast<double>(step) / slide_steps * hole.slide;
            const auto middle = surrounded(solid, bone, to_guide_.apply(moved.at), axis, hole.radius);
            if (!middle) continue;
            moved.middle = made_.frame.apply(*middle);
            holes_.push_back({&hole,
                              step,
                              std::move(moved),
                              {plane(axis, *middle + 15.0 * mm * axis),
                               plane(-axis, *middle - 25.0 * mm * axis),
                               {Term::Kind::cylinder, axis, *middle, hole.radius}}});
            subtract(solid);
            return;
        }
        made_.notes.push_back(fmt::format("{}: {}, and has no hole for it", hole.name, reason));
    }

    /// Measures the walls around the holes in the mesh, of which `tree` is. A hole whose wall is too thin, because what
    /// was beside it is left out, moves on along its slide or is left out. Returns false if there was one: the mesh is
    /// then out of date.
    bool check_holes(GuideSolid& solid, const SeatedBone& bone, const geometry::TriangleTree& tree, double limit) {
        std::vector<PlacedHole> failed;
        for (PlacedHole& hole : holes_) {
            MadeHole local = hole.made;
            local.axis = to_guide_.rotate(local.axis), local.middle = to_guide_.apply(local.middle);
            hole.made.wall = hole_wall(tree, local);
            if (hole.made.wall < limit) failed.push_back(hole);
        }
        if (failed.empty()) return true;
        std::erase_if(holes_, [&](const PlacedHole& hole) { return hole.made.wall < limit; });
        subtract(solid);
        for (const PlacedHole& hole : failed)
            place_hole(solid, bone, *hole.hole, hole.step + 1, "the guide around it would be too thin");
        return false;
    }

    /// Collects the bodies that are subtracted.
    void subtract(GuideSolid& solid) const {
        solid.cuts = slot_cuts_;
        for (const PlacedHole& hole : holes_) solid.cuts.push_back(hole.body);
        solid.cuts.insert(solid.cuts.end(), thin_cuts_.begin(), thin_cuts_.end());
    }

    std::vector<Body> text_bodies() {
        std::vector<Body> bodies;
        const std::array<double, 3> rows = text_rows(set_);
        const double face = rail_y_ - set_.rail;
        const auto engrave = [&](const GuideText& text, double x, double row) {
            if (text.outlines.empty()) return;
            bodies.push_back(
                {side(1, 1.0, face + set_.text_depth),
                 side(0, -1.0, x - 0.4 * mm),
                 side(0, 1.0, x + text.width + 0.4 * mm),
                 {Term::Kind::text, Vec3(0.0), Vec3(x, 0.0, top_ - row), 0.0, std::make_shared<TextField>(text)}});
            made_.texts.push_back({Vec3(x, face, top_ - row), text});
        };
        for (std::size_t n = 0; n < 2; ++n)
            engrave(design_.text[n], 0.5 * (rail_from_ + rail_to_ - design_.text[n].width), rows[2 * n]);
        for (std::size_t n = 0; n < design_.letters.size(); ++n) engrave(design_.letters[n], letter_x(n), rows[1]);
        return bodies;
    }

    const GuideDesign& design_;
    const GuideSettings& set_;
    const RunJobs& run_;
    MadeGuide made_;
    Pose to_guide_;
    geometry::TriangleSurface bone_;  // in the frame of the guide, as all below
    std::vector<Slot> slots_;
    std::vector<Body> slot_cuts_, thin_cuts_;
    std::vector<PlacedHole> holes_;
    std::vector<std::shared_ptr<const Patch>> patches_;  // of each base
    double rail_y_ = 0.0, rail_low_ = 0.0, rail_from_ = 0.0, rail_to_ = 0.0, top_ = 0.0;
    Vec3 low_{0.0}, high_{0.0};
};

}  // namespace

std::size_t nearest_slot(std::span<const MadeSlot> slots, const Vec3& p) {
    const auto distance = [&](const MadeSlot& s) {
        const Vec3 r = p - s.middle;
        const auto beyond = [](double value, double half) { return std::max(0.0, std::abs(value) - half); };
        return glm::length(Vec3(glm::dot(r, s.cut.plane.normal), beyond(glm::dot(r, s.deep), 0.5 * s.depth),
                                beyond(glm::dot(r, s.wide), 0.5 * s.length)));
    };
    return static_cast<std::size_t>(std::ranges::min_element(slots, {}, distance) - slots.begin());
}

double rail_height(const GuideSettings& s) { return (3.0 + 4.0 * 0.3) * s.text_height; }

std::array<double, 3> text_rows(const GuideSettings& s) {
    return {1.3 * s.text_height, 2.6 * s.text_height, 3.9 * s.text_height};
}

MadeGuide make_guide(const GuideDesign& design, const RunJobs& run) { return Maker(design, run).make(); }

}  // namespace tactus::cutting_guide
