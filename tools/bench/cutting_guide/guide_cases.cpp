// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/cutting_guide/guide_cases.hpp"

#include "assets/library/flap_bones.hpp"
#include "assets/library/mandible.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/reconstruction/donor_bone.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::bench {

namespace {

using reconstruction::FibulaInputs;
using reconstruction::JawPlane;

/// Numbers of one stream, in order.
class Draws {
public:
    explicit Draws(std::uint64_t seed) : random_{seed} {}
    double from(double low, double high) { return low + (high - low) * random_.uniform(next_++); }
    int of(int count) { return std::min(count - 1, static_cast<int>(from(0.0, count))); }

private:
    Random random_;
    std::uint64_t next_ = 0;
};

Vec3 middle_of(const geometry::TriangleSurface& surface) {
    Vec3 middle(0.0);
    for (const Vec3& v : surface.vertices) middle += v / static_cast<double>(surface.vertices.size());
    return middle;
}

/// The place of a jaw's arch in the direction `angle` from the chin towards the left, seen from behind its middle.
std::optional<Vec3> on_arch(const geometry::TriangleSurface& jaw, const Vec3& middle, double angle) {
    const Vec3 out(std::sin(angle), -std::cos(angle), 0.0), along(std::cos(angle), std::sin(angle), 0.0);
    Vec3 sum(0.0);
    int count = 0;
    for (const Vec3& v : jaw.vertices) {
        const Vec3 r = v - middle;
        if (std::abs(glm::dot(r, along)) > 1.5 * mm || glm::dot(r, out) < 5.0 * mm) continue;
        sum += v, ++count;
    }
    if (count < 8) return {};
    return sum / static_cast<double>(count);
}

std::optional<FibulaInputs> random_plan(Draws& draw, const geometry::TriangleSurface& jaw) {
    FibulaInputs in;
    const int segments = 1 + draw.of(4);
    const double first = draw.from(-1.6, 1.2), last = first + segments * draw.from(0.3, 0.75);
    // The arch of a part of a jaw is seen from behind its ends.
    Vec3 middle = middle_of(jaw), low = middle, high = middle;
    for (const Vec3& v : jaw.vertices) low = glm::min(low, v), high = glm::max(high, v);
    middle.y = std::min(high.y, low.y + 60.0 * mm);
    std::vector<Vec3> at;
    for (int n = 0; n <= segments; ++n) {
        const auto place = on_arch(jaw, middle, first + (last - first) * n / segments);
        if (!place) return {};
        at.push_back(*place);
    }
    for (std::size_t n = 0; n < at.size(); ++n) {
        JawPlane plane{at[n], {}, {}};
        if (n == 0 || n + 1 == at.size()) {
            const Vec3 towards = glm::normalize(n == 0 ? at[1] - at[0] : at[n] - at[n - 1]);
            const Vec3 aside = glm::normalize(glm::cross(towards, Vec3(0.0, 0.0, 1.0)));
            plane.normal = glm::angleAxis(draw.from(-0.3, 0.3), Vec3(0.0, 0.0, 1.0)) *
                           (glm::angleAxis(draw.from(-0.3, 0.3), aside) * towards);
        }
        in.planes.push_back(plane);
    }
    in.leg = draw.of(2) == 0 ? reconstruction::Leg::left : reconstruction::Leg::right;
    in.donor = library::make_fibula_surface();
    if (in.leg == reconstruction::Leg::right) in.donor = library::mirrored(std::move(*in.donor));
    in.between = draw.from(1.5, 8.0) * mm, in.distal_margin = draw.from(70.0, 95.0) * mm;
    in.roll = draw.from(-0.5, 0.5);
    Vec3 foot(0.0), knee(0.0);
    double bottom = infinity, top = -infinity;
    for (const Vec3& v : in.donor->vertices) bottom = std::min(bottom, v.z), top = std::max(top, v.z);
    int feet = 0, knees = 0;
    for (const Vec3& v : in.donor->vertices) {
        if (std::abs(v.z - bottom - 0.25 * (top - bottom)) < 5.0 * mm) foot += v, ++feet;
        if (std::abs(v.z - bottom - 0.75 * (top - bottom)) < 5.0 * mm) knee += v, ++knees;
    }
    in.line_point = foot / static_cast<double>(feet);
    in.line_direction = glm::normalize(knee / static_cast<double>(knees) - in.line_point);
    in.jaw = jaw;
    return in;
}

}  // namespace

std::vector<NamedBone> bundled_jaws() {
    return {{"jaw", library::make_jaw_surface()},
            {"jaw with a canal", mesh::export_surface(library::make_mandible().distance)}};
}

RandomGuide random_guide(std::uint64_t number, const geometry::TriangleSurface& jaw, bool for_jaw, double voxel) {
    Draws draw(number);
    for (int attempt = 0; attempt < 200; ++attempt) {
        std::optional<FibulaInputs> in = random_plan(draw, jaw);
        if (!in) continue;
        try {
            reconstruction::plan_fibula(*in);
        } catch (const Error&) {
            continue;
        }
        RandomGuide made{std::move(*in), {}};
        analysis::GuideChoice& choice = made.choice;
        cutting_guide::GuideSettings& set = choice.settings;
        choice.bone = for_jaw ? analysis::GuideBone::jaw : analysis::GuideBone::fibula;
        choice.cut = for_jaw ? draw.of(3) : 0;
        choice.turn = draw.from(-25.0, 25.0) * degree;
        choice.offset = draw.from(0.2, 0.8) * mm;
        choice.label = fmt::format("P-{:04}", number);
        set.blade = draw.from(0.3, 1.0) * mm, set.clearance = draw.from(0.15, 0.4) * mm;
        set.sides = static_cast<cutting_guide::Sides>(1 + draw.of(3));
        set.thickness = draw.from(3.0, 5.0) * mm, set.wall = draw.from(2.5, 4.0) * mm;
        set.wrap = draw.from(90.0, 150.0) * degree, set.depth = draw.from(8.0, 15.0) * mm;
        set.voxel = voxel;
        return made;
    }
    throw Error(fmt::format("guide {}: no valid plan in 200 attempts", number));
}

}  // namespace tactus::bench
