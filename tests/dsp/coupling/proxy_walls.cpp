// SPDX-License-Identifier: Apache-2.0
// What proxies must never do: go through a wall, however thin it is and however the hand or the wall moves.
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/coupling/surface_proxy.hpp"
#include "tests/dsp/coupling/held.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

/// A closed shell of `wall` about a ball of air.
struct HollowBall {
    double radius, wall;
    double distance(const Vec3& p) const { return std::abs(glm::length(p) - radius) - 0.5 * wall; }
    Vec3 low() const { return Vec3(-radius - wall); }
    Vec3 high() const { return Vec3(radius + wall); }
};

Vec3 random_place(const Random& random, std::uint64_t n, double reach) {
    return reach * (2.0 * Vec3(random.uniform(3 * n), random.uniform(3 * n + 1), random.uniform(3 * n + 2)) - 1.0);
}

}  // namespace

TEST_CASE("jumps of the hand up to 75 mm never take a proxy out of a hollow ball with a wall of 0.35 mm", "[slow]") {
    const HollowBall shape{8.0 * mm, 0.35 * mm};
    const Random random{3};
    for (const double voxel : {0.35 * mm, 0.2 * mm}) {
        const contact::Voxmap map = test::map_of(shape, voxel, 1.2 * mm);
        const geometry::TriangleTree tree(geometry::iso_surface(map.grid, 0.0f, false));
        for (const bool by_triangles : {false, true})
            for (const double radius : {0.0, 0.5 * mm}) {
                // Sampled every 0.35 mm such a wall has holes, but none that a ball of 1 mm fits through.
                if (radius == 0.0 && voxel > 0.6 * shape.wall) continue;
                const coupling::ProxySurface surface{by_triangles ? nullptr : &map, by_triangles ? &tree : nullptr, {}};
                coupling::SurfaceProxy proxy;
                proxy.settings.shape.radius = radius;
                proxy.reset({0.0, 0.0, 0.0});
                double farthest = 0.0;
                for (std::uint64_t n = 0; n < 300; ++n) {
                    const double reach = n % 3 == 0 ? 75.0 * mm : n % 3 == 1 ? 12.0 * mm : 8.0 * mm;
                    farthest = std::max(farthest,
                                        glm::length(proxy.update(random_place(random, n, reach), {&surface, 1}).proxy));
                }
                CAPTURE(voxel, by_triangles, radius, farthest / mm);
                CHECK(farthest < shape.radius - radius);
                CHECK(farthest > 7.0 * mm - radius);
            }
    }
}

TEST_CASE("a jump over a ball never dips into it, on its field and on its triangles") {
    const double size = 20.0 * mm;
    const contact::Voxmap map = test::map_of(contact::Ball{size}, 0.35 * mm, 4.0 * mm);
    const geometry::TriangleTree tree(geometry::iso_surface(map.grid, 0.0f, false));
    for (const bool by_triangles : {false, true})
        for (const double radius : {0.0, 0.5 * mm, 2.0 * mm}) {
            const coupling::ProxySurface surface{by_triangles ? nullptr : &map, by_triangles ? &tree : nullptr, {}};
            coupling::SurfaceProxy proxy;
            proxy.settings.shape.radius = radius;
            proxy.reset({0.0, 0.0, 30.0 * mm});
            double nearest = 1.0;
            for (int n = 0; n < 400; ++n) {
                // 75 mm in one tick, through the middle and past it, then on.
                const Vec3 goal(0.3 * mm * (n % 7), 2.0 * mm, n % 20 < 10 ? -45.0 * mm : 30.0 * mm);
                nearest = std::min(nearest, glm::length(proxy.update(goal, {&surface, 1}).proxy));
            }
            CAPTURE(by_triangles, radius, nearest / mm);
            CHECK(nearest > size + radius - 0.003 * mm);
        }
}

TEST_CASE("a plate that is moved through a resting hand takes the proxy with it") {
    const contact::Voxmap map = test::map_of(contact::Box{{20.0 * mm, 20.0 * mm, 1.0 * mm}}, 0.25 * mm);
    const geometry::TriangleTree tree(geometry::iso_surface(map.grid, 0.0f, false));
    for (const bool by_triangles : {false, true})
        for (const double speed : {0.1, 2.0}) {
            coupling::SurfaceProxy proxy;
            proxy.settings.shape.radius = 0.5 * mm;
            proxy.reset({0.0, 0.0, 0.0});
            for (int n = 0; n * speed < 8.0; ++n) {
                const Pose at{{0.0, 0.0, -3.0 * mm + speed * 1e-3 * n}, {1.0, 0.0, 0.0, 0.0}};
                const coupling::ProxySurface surface{by_triangles ? nullptr : &map, by_triangles ? &tree : nullptr, at};
                proxy.update({0.0, 0.0, 0.0}, {&surface, 1});
                REQUIRE(proxy.state().proxy.z > at.position.z + 0.99 * mm);
                REQUIRE(proxy.state().force.z >= 0.0);
            }
            CHECK(proxy.state().force.z > 3.9);
        }
}

TEST_CASE("in a notch between triangles a proxy rests in the edge, touching both walls, and is silent") {
    // Two walls that meet at a right angle along y, open upwards; made of few large triangles.
    geometry::TriangleSurface walls;
    const double w = 10.0 * mm;
    walls.vertices = {{-w, -w, w}, {0, -w, 0}, {w, -w, w}, {-w, w, w}, {0, w, 0}, {w, w, w}};
    walls.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    const geometry::TriangleTree tree(walls);
    const coupling::ProxySurface surface{nullptr, &tree, {}};
    const double radius = 1.0 * mm;
    coupling::SurfaceProxy proxy;
    proxy.settings.shape.radius = radius;
    proxy.reset({1.0 * mm, 0.0, 5.0 * mm});
    const Vec3 goal(0.2 * mm, 0.3 * mm, -2.0 * mm);
    for (int n = 0; n < 20; ++n) proxy.update(goal, {&surface, 1});
    const Vec3 rest = proxy.state().proxy;
    CHECK(glm::length(rest - Vec3(0.0, goal.y, radius * std::sqrt(2.0))) < 1e-3 * mm);
    CHECK(std::abs(proxy.state().force.y) < 1e-3);
    for (int n = 0; n < 1000; ++n) REQUIRE(glm::length(proxy.update(goal, {&surface, 1}).proxy - rest) < 1e-9);
}

TEST_CASE("over the edge of a block of triangles a ball rolls as over a rounded one") {
    geometry::TriangleSurface block;
    for (int n = 0; n < 8; ++n)
        block.vertices.push_back(5.0 * mm * Vec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1));
    block.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const geometry::TriangleTree tree(block);
    const coupling::ProxySurface surface{nullptr, &tree, {}};
    const double radius = 2.0 * mm;
    coupling::SurfaceProxy proxy;
    proxy.settings.shape.radius = radius;
    proxy.reset({0.0, 0.0, 9.0 * mm});
    const Vec3 edge(5.0 * mm, 0.0, 5.0 * mm);
    for (int n = 0; n <= 900; ++n) {
        // On a circle about the edge, 1.5 mm off it: half a millimetre inside of the ball's reach.
        const double a = 0.5 * 3.14159265358979 * n / 900.0;
        const Vec3 out(std::sin(a), 0.0, std::cos(a));
        const coupling::ProxyState& now = proxy.update(edge + 1.5 * mm * out, {&surface, 1});
        REQUIRE(glm::length(now.proxy - edge) == Approx(radius).margin(1e-3 * mm));
        REQUIRE(glm::length(now.force / 1000.0 - 0.5 * mm * out) < 0.005 * mm);
    }
}
