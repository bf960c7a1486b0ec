// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/dual_contour.hpp"

#include "dsp/geometry/self_intersection.hpp"
#include "tests/dsp/geometry/closed_mesh.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace tactus;
using geometry::TriangleSurface;

namespace {

// Boxes united, balls subtracted.
struct Blocks final : geometry::ImplicitSolid {
    struct Box {
        Pose pose;
        Vec3 half{0.0};
    };
    struct Ball {
        Vec3 centre{0.0};
        double radius = 0.0;
    };
    std::vector<Box> boxes;
    std::vector<Ball> holes;

    double evaluate(const Vec3& p, Vec3& normal) const {
        double least = 1.0;
        for (const Box& b : boxes) {
            const Vec3 q = b.pose.inverse().apply(p);
            double most = -1.0;
            Vec3 of_box(0.0);
            for (int axis = 0; axis < 3; ++axis)
                if (const double d = std::abs(q[axis]) - b.half[axis]; d > most) {
                    most = d;
                    of_box = Vec3(0.0);
                    of_box[axis] = q[axis] < 0.0 ? -1.0 : 1.0;
                }
            if (most < least) least = most, normal = b.pose.rotate(of_box);
        }
        for (const Ball& h : holes)
            if (const double d = h.radius - glm::length(p - h.centre); d > least)
                least = d, normal = -glm::normalize(p - h.centre);
        return least;
    }
    double value(const Vec3& p) const noexcept override {
        Vec3 ignored(0.0);
        return evaluate(p, ignored);
    }
    Vec3 normal(const Vec3& p) const noexcept override {
        Vec3 n(0.0);
        evaluate(p, n);
        return n;
    }
};

volume::Grid cube(int samples, double side) {
    volume::Grid grid;
    grid.size = {samples, samples, samples};
    grid.origin = Vec3(-0.5 * side);
    grid.spacing = Vec3(side / (samples - 1));
    return grid;
}

}  // namespace

TEST_CASE("a turned box has exact faces and sharp edges") {
    Blocks solid;
    solid.boxes.push_back(
        {{Vec3(0.3e-3, -0.2e-3, 0.1e-3), glm::normalize(Quat(0.8, 0.3, -0.4, 0.2))}, Vec3(4e-3, 3e-3, 2.5e-3)});
    const geometry::Contour made = geometry::dual_contour(cube(40, 14e-3), solid, 1e-12);
    CHECK(test::flaws_of(made.surface) == "none");
    CHECK(test::volume_of(made.surface) == Approx(8.0 * 4e-3 * 3e-3 * 2.5e-3).epsilon(5e-4));
    // Faces are exact. Where an edge cuts off the corner of a cell beside it, the vertex of that cell cannot reach it.
    const double cell = 14e-3 / 39.0;
    std::vector<double> off;
    Vec3 corner(0.0);
    for (const Vec3& v : made.surface.vertices) {
        off.push_back(std::abs(solid.value(v)));
        corner = glm::max(corner, glm::abs(solid.boxes[0].pose.inverse().apply(v)));
    }
    std::ranges::sort(off);
    CHECK(off[off.size() * 98 / 100] < 1e-9);
    CHECK(off.back() < 0.65 * cell);
    CHECK(glm::length(corner - solid.boxes[0].half) < 0.1 * cell);
}

TEST_CASE("contours of random solids are closed, wound and do not intersect themselves") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int n = 0; n < 12; ++n) {
        Blocks solid;
        for (int b = 0; b < 5; ++b)
            solid.boxes.push_back({{3.5e-3 * Vec3(number(random), number(random), number(random)),
                                    glm::normalize(Quat(number(random), number(random), number(random), 0.1))},
                                   Vec3(0.4e-3) + 1.5e-3 * Vec3(1.0 + number(random), 1.0 + number(random), 0.2)});
        for (int b = 0; b < 6; ++b)
            solid.holes.push_back({3e-3 * Vec3(number(random), number(random), number(random)), 1.0e-3});
        INFO(n);
        const geometry::Contour made = geometry::dual_contour(cube(36, 14e-3), solid, 0.0);
        CHECK(test::flaws_of(made.surface) == "none");
        CHECK(geometry::self_intersections(made.surface).size() == 0);
    }
}

TEST_CASE("small parts of a contour are removed and cavities filled") {
    Blocks solid;
    solid.boxes.push_back({{}, Vec3(3e-3)});
    solid.boxes.push_back({{Vec3(5e-3, 5e-3, 5e-3), Quat(1, 0, 0, 0)}, Vec3(0.5e-3)});
    solid.holes.push_back({Vec3(0.0), 0.6e-3});
    const geometry::Contour all = geometry::dual_contour(cube(40, 14e-3), solid, 1e-13),
                            few = geometry::dual_contour(cube(40, 14e-3), solid, 8e-9);
    CHECK(test::parts_of(all.surface) == 2);
    CHECK(all.voids == 1);
    CHECK(test::parts_of(few.surface) == 1);
    CHECK(few.crumbs == 1);
    CHECK(few.voids == 1);
    CHECK(test::volume_of(few.surface) == Approx(216e-9).epsilon(1e-3));
}
