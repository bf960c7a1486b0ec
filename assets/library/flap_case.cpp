// SPDX-License-Identifier: Apache-2.0
#include "assets/library/flap_case.hpp"

#include "assets/library/flap_bones.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "dsp/reconstruction/section.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::library {

namespace {

using geometry::TriangleSurface;
using reconstruction::Leg;

constexpr double artery_radius = 1.5 * mm, vein_radius = 1.8 * mm;
constexpr double beside_bone = 2.0 * mm;  // between vessel and bone

/// A long bone along z, as seen by whoever follows it.
struct LongBone {
    const TriangleSurface& surface;
    Vec3 low{0.0}, high{0.0};  // ends of its axis: at the ankle and at the knee
    Vec3 medial{0.0}, posterior{0.0, 1.0, 0.0};

    double length() const { return glm::length(high - low); }
    Vec3 along() const { return glm::normalize(high - low); }
    Vec3 at(double share) const { return low + share * (high - low); }
};

LongBone long_bone(const TriangleSurface& surface, Leg leg) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& v : surface.vertices) low = std::min(low, v.z), high = std::max(high, v.z);
    if (!(high - low > 0.2 && high - low < 0.6))
        throw Error(fmt::format("the fibula is {:.0f} mm along z; one of 200 to 600 mm is needed, whole, in LPS axes",
                                (high - low) * 1e3));
    // The axis through the shaft's sections, and on to both ends.
    std::array<Vec3, 2> centre;
    for (std::size_t n = 0; n < 2; ++n) {
        const double z = low + (n == 0 ? 0.3 : 0.7) * (high - low);
        const reconstruction::Section section = reconstruction::section_of(surface, {{0.0, 0.0, z}, {0.0, 0.0, 1.0}});
        if (section.points.empty()) throw Error("the fibula has no shaft");
        centre[n] = section.centre;
    }
    const Vec3 slope = (centre[1] - centre[0]) / (centre[1].z - centre[0].z);
    if (glm::length(slope) > 1.2) throw Error("the fibula does not lie along z; turn it into LPS axes");
    LongBone bone{surface, centre[0] + (low - centre[0].z) * slope, centre[0] + (high - centre[0].z) * slope, {}};
    const Vec3 inwards(leg == Leg::left ? -1.0 : 1.0, 0.0, 0.0), along = bone.along();
    bone.posterior = glm::normalize(bone.posterior - glm::dot(bone.posterior, along) * along);
    bone.medial = glm::normalize(inwards - glm::dot(inwards, along) * along);
    bone.medial = glm::normalize(bone.medial - glm::dot(bone.medial, bone.posterior) * bone.posterior);
    return bone;
}

struct Level {
    Vec3 centre{0.0};
    std::vector<Vec3> outline;

    /// How far the bone reaches from its centre in a direction, m.
    double reach(const Vec3& direction) const {
        double most = 0.0;
        for (const Vec3& p : outline) most = std::max(most, glm::dot(p - centre, direction));
        return most;
    }
};

Level level_of(const LongBone& bone, double share) {
    const Vec3 near = bone.at(share);
    reconstruction::Section section = reconstruction::section_of(bone.surface, {near, bone.along()}, &near);
    if (section.points.empty()) throw Error(fmt::format("the fibula has no section at {:.0f} %", share * 100.0));
    return {section.centre, std::move(section.points)};
}

Vec3 direction_of(const LongBone& bone, double angle) {
    return std::cos(angle) * bone.medial + std::sin(angle) * bone.posterior;
}

constexpr double behind = 0.7;  // rad from medial towards posterior: where the vessels run without muscles

/// Where the artery's centre lies at a level.
Vec3 place_of(const LongBone& bone, const Level& level, const std::vector<geometry::TriangleTree>& muscles) {
    const auto beside = [&](double angle, double gap) {
        const Vec3 out = direction_of(bone, angle);
        return level.centre + (level.reach(out) + gap) * out;
    };
    const double gap = artery_radius + beside_bone;
    if (muscles.empty()) return beside(behind, gap);
    // Equally far from both muscles, and as near to all three as can be.
    Vec3 best(0.0);
    double least = std::numeric_limits<double>::infinity();
    for (int a = 0; a <= 60; ++a)
        for (int g = 0; g <= 8; ++g) {
            const Vec3 p = beside(-0.4 + 0.04 * a, gap + g * mm);
            const double one = muscles[0].nearest(p).distance, other = muscles[1].nearest(p).distance;
            const double cost = std::abs(one - other) + 0.5 * (one + other) + 0.3 * g * mm;
            if (cost < least) least = cost, best = p;
        }
    return best;
}

/// Each point becomes the mean of its neighbours within two, ends kept.
std::vector<Vec3> smoothed(const std::vector<Vec3>& line) {
    std::vector<Vec3> to = line;
    for (std::size_t n = 1; n + 1 < line.size(); ++n) {
        const std::size_t most = std::min({n, line.size() - 1 - n, std::size_t{2}});
        Vec3 sum(0.0);
        for (std::size_t k = n - most; k <= n + most; ++k) sum += line[k];
        to[n] = sum / static_cast<double>(2 * most + 1);
    }
    return to;
}

vessel::Branch branch_of(const std::vector<Vec3>& line, double radius) {
    vessel::Branch branch;
    for (std::size_t n = 0; n < line.size(); ++n) {
        vessel::Node node;
        node.position = line[n];
        node.direction = glm::normalize(n + 1 < line.size() ? line[n + 1] - line[n] : line[n] - line[n - 1]);
        node.radius = radius;
        node.confidence = 1.0;
        if (n > 0) node.along = branch.nodes.back().along + glm::length(line[n] - line[n - 1]);
        branch.nodes.push_back(node);
    }
    branch.end = vessel::End::length;
    return branch;
}

/// Beside the bone from 85 % down to 12 %; above 78 % it turns medially towards the posterior tibial artery, where it
/// begins.
std::vector<Vec3> course_of(const LongBone& bone, const std::vector<geometry::TriangleTree>& muscles) {
    constexpr double first = 0.85, last = 0.12, turns = 0.78, step = 4.0 * mm;
    const int count = static_cast<int>(std::ceil((first - last) * bone.length() / step));
    std::vector<Vec3> line;
    for (int n = 0; n <= count; ++n) {
        const double share = first + (last - first) * n / count,
                     over = std::max(0.0, (share - turns) / (first - turns));
        line.push_back(place_of(bone, level_of(bone, share), muscles) + 14.0 * mm * over * over * bone.medial);
    }
    line = smoothed(smoothed(line));
    // Smoothing cuts corners of the bone.
    const geometry::TriangleTree surface(bone.surface);
    for (Vec3& p : line) {
        constexpr double gap = artery_radius + beside_bone;
        const geometry::TriangleTree::Near near = surface.nearest(p);
        const bool is_inside = glm::dot(p - near.point, near.normal) < 0.0;
        if (!(near.distance > 0.0) || (near.distance >= gap && !is_inside)) continue;
        p = near.point + (is_inside ? -gap : gap) / near.distance * (p - near.point);
    }
    return line;
}

void add_perforators(FlapCase& made, const LongBone& bone, std::uint64_t seed) {
    const Random random{seed * 6007};
    constexpr std::array<double, 5> middle{0.24, 0.38, 0.50, 0.62, 0.76};
    for (std::size_t n = 0; n < middle.size(); ++n) {
        // The one at the middle stays within 2 cm of it.
        const double share = middle[n] + (random.uniform(n) - 0.5) * (n == 2 ? 0.06 : 0.08);
        const Level level = level_of(bone, share);
        const Vec3 mark = level.centre + (level.reach(bone.posterior) + 19.0 * mm) * bone.posterior -
                          (level.reach(-bone.medial) + 8.0 * mm) * bone.medial;
        const auto& main = made.artery.branches[0].nodes;
        std::size_t from = 0;
        for (std::size_t k = 1; k < main.size(); ++k)
            if (std::abs(glm::dot(main[k].position - level.centre, bone.along())) <
                std::abs(glm::dot(main[from].position - level.centre, bone.along())))
                from = k;
        // Behind the bone, then outwards in the septum to the skin.
        const Vec3 a = main[from].position, c = mark;
        const Vec3 b = level.centre + (level.reach(bone.posterior) + 6.0 * mm) * bone.posterior;
        std::vector<Vec3> line;
        for (int k = 0; k <= 12; ++k) {
            const double t = k / 12.0, s = 1.0 - t;
            line.push_back(s * s * a + 2.0 * s * t * b + t * t * c);
        }
        vessel::Branch branch = branch_of(line, 0.3 * mm);
        branch.parent = 0;
        branch.parent_node = static_cast<int>(from);
        made.artery.branches.push_back(std::move(branch));
        made.perforators.push_back({fmt::format("perforator {}", n + 1), mark});
    }
}

/// From the chin's right side to the left angle: the proximal end, where the pedicle leaves, is at the left angle, near
/// the vessels of the left side.
void add_planes(reconstruction::FibulaInputs& inputs) {
    constexpr std::array<double, 4> angles{-0.40, 0.17, 0.70, 1.19};
    for (std::size_t n = 0; n < angles.size(); ++n) {
        reconstruction::JawPlane plane;
        // The segments are flush with the lower border.
        plane.origin = arch_point(angles[n]) - Vec3(0.0, 0.0, 7.0 * mm);
        if (n == 0 || n + 1 == angles.size()) plane.normal = arch_direction(angles[n]);
        inputs.planes.push_back(plane);
    }
}

std::vector<NamedPoint> sites() {
    std::vector<NamedPoint> all;
    for (const double side : {1.0, -1.0}) {
        const char* name = side > 0.0 ? "left" : "right";
        // The facial vessels cross the lower border before the angle; the others lie in the neck.
        all.push_back({fmt::format("facial artery, {}", name), Vec3(side * 37.0, 8.0, -24.0) * mm});
        all.push_back({fmt::format("facial vein, {}", name), Vec3(side * 38.0, 15.0, -26.0) * mm});
        all.push_back({fmt::format("superior thyroid artery, {}", name), Vec3(side * 22.0, 14.0, -58.0) * mm});
        all.push_back({fmt::format("internal jugular vein, {}", name), Vec3(side * 30.0, 24.0, -52.0) * mm});
    }
    return all;
}

/// Rolls the donor so that the vessels of the middle segment face the tongue, and a little downwards.
double roll_for(const reconstruction::FibulaInputs& inputs, const LongBone& bone, const std::vector<Vec3>& course) {
    const reconstruction::FibulaPlan plan = reconstruction::plan_fibula(inputs);
    const std::size_t middle = plan.segments.size() / 2;
    const reconstruction::FibulaSegment& segment = plan.segments[middle];
    const Vec3 donor = 0.5 * (segment.donor_plane[0].origin + segment.donor_plane[1].origin);
    const auto beside = std::ranges::min_element(
        course, {}, [&](const Vec3& p) { return std::abs(glm::dot(p - donor, bone.along())); });
    const Vec3 axis = glm::normalize(inputs.planes[middle + 1].origin - inputs.planes[middle].origin);
    const auto across = [&](Vec3 v) { return v - glm::dot(v, axis) * axis; };
    const Vec3 from = across(segment.donor_to_target.rotate(*beside - donor));
    const Vec3 inside =
        Vec3(0.0, 5.0 * mm, 0.0) - 0.5 * (inputs.planes[middle].origin + inputs.planes[middle + 1].origin);
    const Vec3 to = across(glm::normalize(Vec3(inside.x, inside.y, 0.0)) + Vec3(0.0, 0.0, -0.5));
    return std::atan2(glm::dot(glm::cross(from, to), axis), glm::dot(from, to));
}

}  // namespace

FlapCase make_flap(const FlapOptions& options) {
    if (options.between.size() != 0 && options.between.size() != 2)
        throw Error("the vessels run between two muscles: give none or two");
    if (!options.between.empty() && !options.fibula)
        throw Error("muscles lie beside a fibula of a person: give it, too");
    FlapCase made;
    made.notes = {
        "synthetic: not a patient; vessels, perforators and recipient sites are placed by rules, not measured",
        "for research, not a medical device"};
    made.jaw = make_jaw_surface();
    made.tumour = make_tumour_surface();
    made.fibula = options.fibula ? *options.fibula : make_fibula_surface();
    const Leg given = options.fibula ? options.fibula_leg : Leg::left;
    std::vector<TriangleSurface> muscles = options.between;
    if (given != options.leg) {
        made.fibula = mirrored(std::move(made.fibula));
        for (TriangleSurface& muscle : muscles) muscle = mirrored(std::move(muscle));
        made.notes.push_back(options.leg == Leg::right ? "the right leg is the mirror image of a left one"
                                                       : "the left leg is the mirror image of a right one");
    }
    made.notes.push_back(options.fibula ? muscles.empty()
                                              ? "the fibula is the one that was given; its vessels run behind "
                                                "and medial of it, as no muscles were given"
                                              : "the fibula is the one that was given; its vessels run where "
                                                "both muscles are equally near"
                                        : "the fibula is generated by formula");
    const LongBone bone = long_bone(made.fibula, options.leg);
    std::vector<geometry::TriangleTree> trees;
    for (const TriangleSurface& muscle : muscles) trees.emplace_back(muscle);
    const std::vector<Vec3> course = course_of(bone, trees);
    std::vector<Vec3> beside;
    for (const Vec3& p : course) beside.push_back(p + 3.6 * mm * glm::normalize(bone.posterior + bone.medial));
    made.artery.branches.push_back(branch_of(course, artery_radius));
    made.vein.branches.push_back(branch_of(beside, vein_radius));
    add_perforators(made, bone, options.seed);
    made.sites = sites();
    made.inputs.leg = options.leg;
    made.inputs.line_point = bone.at(0.5);
    made.inputs.line_direction = bone.along();
    add_planes(made.inputs);
    made.inputs.donor = made.fibula;
    made.inputs.roll = roll_for(made.inputs, bone, course);
    made.inputs.donor.reset();
    return made;
}

}  // namespace tactus::library
