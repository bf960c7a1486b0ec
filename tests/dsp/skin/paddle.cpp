// SPDX-License-Identifier: Apache-2.0
#include "dsp/skin/paddle.hpp"

#include "dsp/core/error.hpp"
#include "tests/dsp/reconstruction/small_flap.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

using namespace tactus;
using reconstruction::milli;
using skin::DrapedPaddle;
using skin::DrapeSettings;

namespace {

/// An ellipse in the plane z = `height`.
std::vector<Vec3> ellipse(double a, double b, double height, const Vec3& centre = Vec3(0.0)) {
    std::vector<Vec3> curve;
    for (int n = 0; n < 48; ++n) {
        const double angle = 2.0 * std::numbers::pi * n / 48.0;
        curve.push_back(centre + Vec3(a * std::cos(angle), b * std::sin(angle), height));
    }
    return curve;
}

struct PaddleCase {
    reconstruction::FibulaInputs inputs = reconstruction::small_inputs();
    reconstruction::FibulaPlan plan = reconstruction::plan_fibula(inputs);
    reconstruction::Flap flap;
    DrapeSettings settings;

    PaddleCase() {
        const double middle = 0.5 * (plan.segments[0].along_line[0] + plan.segments[0].along_line[1]);
        flap.paddle = reconstruction::SkinPaddle{on_line(middle) + Vec3(0.0, 25 * milli, 0.0), 60 * milli, 40 * milli};
        flap.perforators = {{"first", on_line(middle + 5 * milli) + Vec3(0.0, 7 * milli, 0.0)},
                            {"at the ankle", on_line(middle - 100 * milli)}};
        settings.sheet.columns = 19;
        settings.sheet.rows = 13;
    }
    Vec3 on_line(double along) const { return inputs.line_point + along * inputs.line_direction; }
    DrapedPaddle drape(const std::vector<Vec3>& defect, const rope::Obstacle* bone = nullptr) const {
        return skin::drape(inputs, plan, flap, defect, bone, settings);
    }
};

}  // namespace

TEST_CASE("a paddle that is larger than a flat defect covers it, and a smaller one the part that its size says") {
    PaddleCase made;
    made.flap.perforators.clear();
    const std::vector<Vec3> rectangle{{-0.02, -0.01, 0.0}, {0.02, -0.01, 0.0}, {0.02, 0.01, 0.0}, {-0.02, 0.01, 0.0}};
    const DrapedPaddle whole = made.drape(rectangle);
    CHECK(whole.is_settled);
    CHECK(whole.coverage == 1.0);
    CHECK(whole.defect_area == Approx(8e-4));
    CHECK(whole.area == Approx(whole.area_flat).epsilon(1e-3));
    CHECK(whole.touching == 0.0);
    CHECK(whole.fold == 0.0);
    made.flap.paddle->length = 20 * milli;
    made.flap.paddle->width = 10 * milli;
    CHECK(made.drape(rectangle).coverage == Approx(0.25).margin(0.03));
    made.flap.paddle->length = 60 * milli;
    CHECK(made.drape(rectangle).coverage == Approx(0.5).margin(0.05));
}

TEST_CASE("the slack of a perforator is its length less the distance from its bone to the skin") {
    PaddleCase made;
    const DrapedPaddle draped =
        made.drape(ellipse(15 * milli, 10 * milli, 0.0, {-20 * milli, -20 * milli, 20 * milli}));
    REQUIRE(draped.ropes.size() == 1);
    const skin::PaddleRope& rope = draped.ropes[0];
    CHECK(rope.name == "first");
    CHECK(draped.unused == std::vector<std::string>{"at the ankle"});
    CHECK(rope.along == Approx(5 * milli));
    const Vec3 bone = made.plan.segments[0].donor_to_target.apply(made.flap.perforators[0].at);
    CHECK(glm::length(rope.bone - bone) < 1e-12);
    CHECK(rope.slack == Approx(50 * milli - glm::length(rope.skin - bone)).margin(1 * milli));
    CHECK(rope.slack > 0.0);
    CHECK(rope.tension == 0.0);
}

TEST_CASE("a perforator that does not reach pulls at the paddle, which is sutured to the defect") {
    PaddleCase made;
    const std::vector<Vec3> far = ellipse(15 * milli, 10 * milli, 0.0, {-20 * milli, -110 * milli, 0.0});
    const DrapedPaddle pulled = made.drape(far);
    REQUIRE(pulled.ropes.size() == 1);
    const skin::PaddleRope& rope = pulled.ropes[0];
    CHECK(rope.slack < -10 * milli);
    CHECK(rope.tension > 0.3);
    CHECK(rope.tension ==
          Approx(made.settings.rope_stiffness * (glm::length(rope.skin - rope.bone) - made.settings.rope_length)));
    made.flap.perforators.clear();
    CHECK(made.drape(far).coverage == 1.0);
}

TEST_CASE("the paddle lies on bone that stands out of the defect, and the fold over it is measured") {
    PaddleCase made;
    made.flap.perforators.clear();
    made.settings.sheet.thickness = 4 * milli;
    made.settings.sheet.bending_young = 1e3;
    made.settings.pressure = 1000.0;
    const auto curve = ellipse(25 * milli, 16 * milli, 0.0);
    // A bone of 10 mm across the defect, half of it above the plane.
    const rope::Cylinder round({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 10 * milli),
        thin({0.0, 0.0, -2 * milli}, {0.0, 1.0, 0.0}, 4 * milli);
    const DrapedPaddle over_round = made.drape(curve, &round), over_thin = made.drape(curve, &thin);
    for (const DrapedPaddle* draped : {&over_round, &over_thin}) {
        CHECK(draped->is_settled);
        CHECK(draped->touching > 0.0);
        CHECK(draped->fold > 0.0);
        CHECK(draped->fold < 1.5);
    }
    for (const Vec3& p : over_round.positions) CHECK(std::hypot(p.x, p.z) > 12 * milli - 0.3 * milli);
    // On a circle of R + t/2 the direction turns by t / (R + t/2) over one thickness; nodes are 2 to 3.3 mm apart.
    CHECK(over_round.fold == Approx(4.0 / 12.0).epsilon(0.35));
}

TEST_CASE("the paddle lies on the side of the defect that is away from the bone, whichever way the curve runs") {
    PaddleCase made;
    made.flap.perforators.clear();
    const rope::Ball bone({0.0, 0.0, -30 * milli}, 25 * milli);
    std::vector<Vec3> curve = ellipse(20 * milli, 12 * milli, 0.0);
    const DrapedPaddle one = made.drape(curve, &bone);
    std::ranges::reverse(curve);
    const DrapedPaddle other = made.drape(curve, &bone);
    CHECK(one.normal.z == Approx(1.0));
    CHECK(other.normal.z == Approx(1.0));
    CHECK(one.coverage == Approx(other.coverage).margin(1e-3));
}

TEST_CASE("a bone whose distance is known only nearby has the paddle on its outer side") {
    /// As a distance field: flat beyond 20 mm.
    struct Field final : rope::Obstacle {
        rope::Ball ball{{0.0, 0.0, -20 * milli}, 18 * milli};
        double distance(const Vec3& place, Vec3& normal) const noexcept override {
            const double d = ball.distance(place, normal);
            if (d < 20 * milli) return d;
            normal = Vec3(0.0);
            return 20 * milli;
        }
    };
    PaddleCase made;
    made.flap.perforators.clear();
    const Field bone;
    std::vector<Vec3> curve = ellipse(20 * milli, 12 * milli, 0.0);
    const DrapedPaddle one = made.drape(curve, &bone);
    std::ranges::reverse(curve);
    const DrapedPaddle other = made.drape(curve, &bone);
    CHECK(one.normal.z == Approx(1.0));
    CHECK(other.normal.z == Approx(1.0));
}

TEST_CASE("a paddle that is wider than long lies with its width along the defect") {
    PaddleCase made;
    made.flap.perforators.clear();
    made.flap.paddle->length = 30 * milli;
    made.flap.paddle->width = 60 * milli;
    CHECK(made.drape(ellipse(28 * milli, 12 * milli, 0.0)).coverage > 0.99);
}

TEST_CASE("bone does not pass between the nodes of a large or heavily pressed paddle") {
    PaddleCase made;
    made.flap.perforators.clear();
    made.flap.paddle->length = 200 * milli;
    made.flap.paddle->width = 80 * milli;
    made.settings.pressure = 5000.0;
    const rope::Cylinder ridge({0.0, 0.0, -2 * milli}, {0.0, 1.0, 0.0}, 6 * milli);
    for (const Vec3& p : made.drape(ellipse(60 * milli, 30 * milli, 0.0), &ridge).positions)
        REQUIRE(std::hypot(p.x, p.z + 2 * milli) > (6.0 + 0.6 * 5.0) * milli);
}

TEST_CASE("the shell of a draped paddle is closed, has its volume, and faces outwards") {
    PaddleCase made;
    made.flap.perforators.clear();
    const DrapedPaddle draped = made.drape(ellipse(25 * milli, 16 * milli, 0.0));
    const geometry::TriangleSurface shell = skin::shell_of(draped, 10 * milli);
    std::map<std::pair<int, int>, int> edges;
    double volume = 0.0;
    for (const auto& t : shell.triangles) {
        for (int k = 0; k < 3; ++k) ++edges[{t[static_cast<std::size_t>(k)], t[static_cast<std::size_t>((k + 1) % 3)]}];
        const auto v = [&](int k) { return shell.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
        volume += glm::dot(v(0), glm::cross(v(1), v(2))) / 6.0;
    }
    for (const auto& [edge, count] : edges) {
        REQUIRE(count == 1);
        REQUIRE(edges.contains({edge.second, edge.first}));
    }
    CHECK(volume == Approx(draped.area * 10 * milli).epsilon(0.01));
}

TEST_CASE("a defect or a paddle that cannot be laid is refused with the reason") {
    PaddleCase made;
    using Catch::Matchers::ContainsSubstring;
    CHECK_THROWS_WITH(made.drape({{0, 0, 0}, {0.01, 0, 0}}), ContainsSubstring("needs three"));
    CHECK_THROWS_WITH(made.drape({{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}}), ContainsSubstring("encloses 0.0 mm2"));
    CHECK_THROWS_WITH(made.drape({{0, 0, 0}, {0.01, 0, 0}, {0.0, std::nan(""), 0}}), ContainsSubstring("not finite"));
    made.flap.paddle->at = made.on_line(0.1);
    CHECK_THROWS_WITH(made.drape(ellipse(0.02, 0.01, 0.0)), ContainsSubstring("lies on the donor's line"));
    made.flap.paddle.reset();
    CHECK_THROWS_WITH(made.drape(ellipse(0.02, 0.01, 0.0)), ContainsSubstring("no skin paddle"));
}
