// SPDX-License-Identifier: Apache-2.0
// Templates for plates on bones of known shape.
#include "dsp/cutting_guide/plate_template.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/self_intersection.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "tests/dsp/geometry/closed_mesh.hpp"
#include "tests/dsp/reconstruction/donors.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <random>

using namespace tactus;
using namespace tactus::cutting_guide;

namespace {

/// A plate on an arch of bone, a thick ring in a random place, with a step in the middle.
TemplateDesign random_template(unsigned seed, double step = 0.0) {
    std::mt19937 random(seed);
    const auto from = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double radius = from(28.0, 45.0) * mm, thick = from(8.0, 11.0) * mm, wave = from(0.0, 0.4) * mm;
    const Pose pose{Vec3(from(-0.1, 0.1), from(-0.1, 0.1), from(-0.1, 0.1)),
                    glm::normalize(Quat(from(-1, 1), from(-1, 1), from(-1, 1), from(-1, 1)))};
    TemplateDesign design;
    // Half of a torus about z; the outside of angle a along it.
    constexpr int along = 160, around = 48;
    const auto thickness = [&](double a) { return thick + wave * std::sin(9.0 * a) + (a > 0.5 * pi ? step : 0.0); };
    for (int i = 0; i <= along; ++i)
        for (int j = 0; j < around; ++j) {
            const double a = pi * i / along, b = 2.0 * pi * j / around, r = radius + thickness(a) * std::cos(b);
            design.bone.vertices.push_back(pose.apply({r * std::cos(a), r * std::sin(a), thickness(a) * std::sin(b)}));
        }
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            const int p = i * around + j, q = i * around + (j + 1) % around;
            design.bone.triangles.push_back({p, p + around, q});
            design.bone.triangles.push_back({q, p + around, q + around});
        }
    reconstruction::Plate& plate = design.plate;
    plate.name = "plate";
    const double begin = from(0.3, 0.8), end = from(2.0, 2.8);
    for (int n = 0; n <= 14; ++n) {
        const double a = begin + (end - begin) * n / 14.0;
        const Vec3 out(std::cos(a), std::sin(a), 0.0);
        plate.points.push_back(pose.apply((radius + thickness(a)) * out));
        plate.outward.push_back(pose.rotate(out));
        if (n % 3 == 1) plate.screws.push_back({plate.points.back(), -plate.outward.back(), 10.0 * mm, 2.4 * mm});
    }
    design.settings.voxel = 0.45 * mm;
    design.settings.marks = seed % 2 == 0 ? HoleMarks::pins : HoleMarks::dimples;
    return design;
}

MadeTemplate checked(const TemplateDesign& design) {
    MadeTemplate made = make_template(design, run_in_turn);
    CHECK(test::flaws_of(made.surface) == "none");
    CHECK(test::parts_of(made.surface) == 1);
    CHECK(test::volume_of(made.surface) > 0.0);
    CHECK(geometry::self_intersections(made.surface).size() == 0);
    CHECK(made.marks.size() == design.plate.screws.size());
    return made;
}

/// Of the mesh, along a line from outside at a point of the plate; m.
double height_over(const geometry::TriangleTree& tree, const Vec3& at, const Vec3& out) {
    constexpr double far = 15.0 * mm;
    return far - 2.0 * far * tree.sweep(at + far * out, -2.0 * far * out, 1e-9);
}

}  // namespace

TEST_CASE("a template is closed, one part, and its bed lies on the bone between the marks") {
    for (unsigned seed = 0; seed < 6; ++seed) {
        INFO("seed " << seed);
        const TemplateDesign design = random_template(seed);
        const MadeTemplate made = checked(design);
        CHECK(made.bone_share == Approx(1.0));
        CHECK(made.on_bone_share > 0.98);
        const geometry::TriangleTree tree(made.surface), bone(design.bone);
        for (std::size_t n = 0; n < design.plate.points.size(); ++n) {
            const Vec3 &at = design.plate.points[n], &out = design.plate.outward[n];
            if (n == 0 || n + 1 == design.plate.points.size()) continue;  // the curve is smooth, and ends beside them
            const double sign = design.settings.marks == HoleMarks::pins ? 1.0 : -1.0;
            const double wanted = height_over(bone, at, out) + (n % 3 == 1 ? sign * design.settings.mark : 0.0);
            CHECK(height_over(tree, at, out) / mm == Approx(wanted / mm).margin(0.06));
            // Beside the middle, below the plate.
            const Vec3 next = design.plate.points[n + 1 < design.plate.points.size() ? n + 1 : n - 1];
            const Vec3 aside = glm::normalize(glm::cross(next - at, out));
            const Vec3 beside = at + 0.4 * design.plate.width * aside;
            CHECK(height_over(tree, beside, out) / mm == Approx(height_over(bone, beside, out) / mm).margin(0.12));
        }
    }
}

TEST_CASE("a template spans a step of the bone and never lies below it") {
    const TemplateDesign design = random_template(3, 2.0 * mm);
    const MadeTemplate made = checked(design);
    CHECK(made.on_bone_share < 0.995);
    CHECK(made.max_span > 0.2 * mm);
    CHECK(made.max_span < 2.0 * mm);
    const geometry::TriangleTree tree(made.surface);
    for (const Vec3& v : design.bone.vertices) {
        // Bone below the plate that stands out of the template.
        for (std::size_t n = 1; n + 1 < design.plate.points.size(); ++n) {
            const Vec3 r = v - design.plate.points[n], out = design.plate.outward[n];
            const double away = glm::length(r - glm::dot(r, out) * out);
            if (n % 3 == 1 || away > 1.5 * mm || glm::dot(r, out) < -3.0 * mm) continue;
            CHECK(height_over(tree, v, out) > -0.1 * mm);
        }
    }
}

TEST_CASE("the text of a template reads from left to right with the bed up") {
    TemplateDesign design = random_template(2);
    // An L: the corner beside its foot is not engraved.
    design.text = {{{{0.0, 0.0}, {12e-3, 0.0}, {12e-3, 2e-3}, {1.5e-3, 2e-3}, {1.5e-3, 4e-3}, {0.0, 4e-3}}}, 12e-3};
    const MadeTemplate made = checked(design);
    const geometry::TriangleTree tree(made.surface);
    const auto& points = design.plate.points;
    const Vec3 middle = points[7], out = design.plate.outward[7], along = glm::normalize(points[8] - points[6]),
               aside = glm::cross(along, out);
    // Seen along `aside`, with `out` up, right is against `along`.
    const auto depth = [&](double right, double up) {
        const Vec3 at = middle - right * along + (up + 1.0 * mm - design.settings.thickness) * out;
        const Vec3 from = at - 10.0 * mm * aside;
        return 10.0 * mm * tree.sweep(from, 10.0 * mm * aside, 1e-9) - (10.0 * mm - 0.5 * made.width);
    };
    CHECK(depth(-4.5 * mm, 0.0) > 0.4 * mm);
    CHECK(depth(4.0 * mm, 0.0) > 0.4 * mm);
    CHECK(depth(-4.5 * mm, 2.4 * mm) > 0.4 * mm);
    CHECK(depth(4.0 * mm, 2.4 * mm) < 0.2 * mm);
}

TEST_CASE("a template that cannot be made is refused with the reason") {
    TemplateDesign design = random_template(2);
    design.settings.thickness = 60.0 * mm;
    CHECK_THROWS_WITH(make_template(design, run_in_turn), Catch::Matchers::ContainsSubstring("bends with a radius"));
    design = random_template(2);
    design.plate.screws[0].diameter = 1.0 * mm;
    CHECK_THROWS_WITH(make_template(design, run_in_turn), Catch::Matchers::ContainsSubstring("dimples mark"));
    design = random_template(2);
    design.plate.points.resize(1);
    CHECK_THROWS_WITH(make_template(design, run_in_turn), Catch::Matchers::ContainsSubstring("two points"));
    design = random_template(2);
    design.settings.voxel = 0.01 * mm;
    CHECK_THROWS_WITH(make_template(design, run_in_turn), Catch::Matchers::ContainsSubstring("coarser voxel"));
}
