// SPDX-License-Identifier: Apache-2.0
// How stiff contact is may not depend on how densely a surface is sampled, unless a patch asks for a stiffness per point.
#include "dsp/contact/shape.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/coupling/scene.hpp"
#include "nodes/contact/body_parts.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

/// Stiffness in N/m of a box of 10 mm, with points `spacing` m apart, that is pressed 0.3 mm into a table.
double stiffness_of(double spacing, const std::vector<std::pair<const char*, const char*>>& settings) {
    const contact::Box table{Vec3(40.0, 40.0, 10.0) * mm}, box{Vec3(10.0 * mm)};
    const nodes::BodyParts under(contact::make_pointshell(table.points(2.0 * mm)),
                                 contact::voxmap_of(table, 0.5 * mm, 3.0 * mm), {}, false);
    const nodes::BodyParts on(contact::make_pointshell(box.points(spacing)),
                              contact::voxmap_of(box, 0.5 * mm, 3.0 * mm), {}, false);
    coupling::Scene scene;
    scene.count = 2;
    scene.objects[0] = {under.body(), {{0.0, 0.0, -5.0 * mm}, {1, 0, 0, 0}}};
    scene.objects[1] = {on.body(), {}};
    NodeHarness node("voxmap_contact", test::servo);
    node.set("held", "1");
    for (const auto& [name, text] : settings) node.set(name, text);
    node.feed("scene", scene);
    node.feed("pose", Pose{{0.0, 0.0, 4.7 * mm}, {1, 0, 0, 0}});
    node.prepare();
    node.run(1);
    return node.last<double>("stiffness");
}

}  // namespace

TEST_CASE("a body is equally stiff with points 1, 0.5 and 0.25 mm apart, 40 N/mm for each mm² that touches") {
    for (const double spacing : {1.0 * mm, 0.5 * mm, 0.25 * mm}) {
        // The lower face and 0.3 mm of the sides: 112 mm². A row of points more or less of the sides makes the difference.
        CAPTURE(spacing);
        CHECK(stiffness_of(spacing, {}) == Approx(112.0 * 40e3).epsilon(0.08));
        CHECK(stiffness_of(spacing, {{"area_stiffness", "5 N/mm^3"}}) == Approx(112.0 * 5e3).epsilon(0.08));
    }
}

TEST_CASE("a stiffness per point that a patch gives counts instead") {
    for (const double spacing : {1.0 * mm, 0.5 * mm}) {
        const double per_side = 10.0 * mm / spacing + 1.0;
        CAPTURE(spacing);
        CHECK(stiffness_of(spacing, {{"point_stiffness", "10 N/mm"}}) ==
              Approx(per_side * per_side * 10e3).epsilon(0.01));
    }
}

TEST_CASE("a body whose points stand for no area is refused") {
    const contact::Box box{Vec3(10.0 * mm)};
    std::vector<contact::SurfacePoint> points = box.points(1.0 * mm);
    points[7].area = 0.0;
    const auto make = [&] {
        const nodes::BodyParts parts(contact::make_pointshell(points), contact::voxmap_of(box, 0.5 * mm, 3.0 * mm), {},
                                     false);
        return parts.body();
    };
    CHECK_NOTHROW(make());  // one of many is an edge
    for (contact::SurfacePoint& p : points) p.area = 0.0;
    CHECK_THROWS_WITH(make(), Catch::Matchers::ContainsSubstring("no area"));
}
