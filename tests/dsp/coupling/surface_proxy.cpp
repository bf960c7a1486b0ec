// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/surface_proxy.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/geometry/closest_point.hpp"
#include "tests/dsp/coupling/held.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

using namespace tactus;

namespace {

const contact::Voxmap& proxy_ball() {
    static const contact::Voxmap map = test::map_of(contact::Ball{25.0 * mm}, 0.35 * mm);
    return map;
}
const geometry::TriangleTree& ball_triangles() {
    static const geometry::TriangleTree tree(geometry::iso_surface(proxy_ball().grid, 0.0f, false));
    return tree;
}
const contact::Voxmap& plate_map() {
    static const contact::Voxmap map = test::map_of(contact::Box{{20.0 * mm, 20.0 * mm, 2.0 * mm}}, 0.25 * mm);
    return map;
}
const geometry::TriangleTree& plate_triangles() {
    static const geometry::TriangleTree tree(geometry::iso_surface(plate_map().grid, 0.0f, false));
    return tree;
}

/// Field and triangles of one body.
std::array<coupling::ProxySurface, 2> both(const contact::Voxmap& map, const geometry::TriangleTree& tree) {
    return {coupling::ProxySurface{&map, nullptr, {}}, coupling::ProxySurface{nullptr, &tree, {}}};
}

}  // namespace

TEST_CASE("a tree of triangles finds what looking at each of them finds") {
    geometry::TriangleSurface surface;
    const Random random{11};
    for (std::uint64_t t = 0; t < 300; ++t) {
        const Vec3 at(random.uniform(10 * t), random.uniform(10 * t + 1), random.uniform(10 * t + 2));
        for (std::uint64_t c = 0; c < 3; ++c) {
            const std::uint64_t n = 10 * t + 3 * c + 5000;
            surface.vertices.push_back(at +
                                       0.2 * Vec3(random.uniform(n), random.uniform(n + 1), random.uniform(n + 2)));
        }
        const int v = static_cast<int>(3 * t);
        surface.triangles.push_back({v, v + 1, v + 2});
    }
    const geometry::TriangleTree tree(surface);
    for (std::uint64_t q = 0; q < 300; ++q) {
        const Vec3 p =
            1.4 * Vec3(random.uniform(90000 + 7 * q), random.uniform(90001 + 7 * q), random.uniform(90002 + 7 * q));
        double least = std::numeric_limits<double>::infinity();
        for (const auto& t : surface.triangles) {
            const Vec3* v = surface.vertices.data();
            least = std::min(least, glm::length(p - geometry::closest_on_triangle(p, v[t[0]], v[t[1]], v[t[2]])));
        }
        CHECK(tree.nearest(p).distance == Approx(least));
        CHECK(tree.nearest(p, 0.5 * least).distance == std::numeric_limits<double>::infinity());
        // A small ball on its way through a triangle meets something no later than there.
        const Vec3 inside = (surface.vertices[0] + surface.vertices[1] + surface.vertices[2]) / 3.0;
        const Vec3 way = 2.0 * (inside - p);
        const double share = tree.sweep(p, way, 1e-6);
        CHECK(share <= 0.5 + 1e-9);
        CHECK(tree.nearest(p + share * way).distance == Approx(least < 1e-6 ? least : 1e-6));
    }
    CHECK(tree.sweep({2, 2, 2}, {1, 1, 1}, 1e-6) == 1.0);
    CHECK(geometry::TriangleTree({}).nearest({0, 0, 0}).distance == std::numeric_limits<double>::infinity());
}

TEST_CASE("the nearest place within half-spaces is on faces, in edges and in corners") {
    const coupling::ProxyPlane x{{1, 0, 0}, 0.0}, y{{0, 1, 0}, 0.0}, z{{0, 0, 1}, 0.5};
    const std::array all{x, y, z};
    CHECK(coupling::nearest_within({1, 1, 1}, {0, 0, 0}, all) == Vec3(1, 1, 1));
    CHECK(glm::length(coupling::nearest_within({-1, 1, 1}, {0, 0, 0}, all) - Vec3(0, 1, 1)) < 1e-12);
    CHECK(glm::length(coupling::nearest_within({-1, -2, 1}, {0, 0, 0}, all) - Vec3(0, 0, 1)) < 1e-12);
    CHECK(glm::length(coupling::nearest_within({-1, -2, -3}, {0, 0, 0}, all) - Vec3(0, 0, -0.5)) < 1e-12);
}

TEST_CASE("sliding over a ball, field or triangles: the force is the spring's along the normal", "[slow]") {
    for (const coupling::ProxySurface& surface : both(proxy_ball(), ball_triangles()))
        for (const double radius : {0.0, 2.0 * mm}) {
            coupling::SurfaceProxy proxy;
            proxy.settings.shape.radius = radius;
            const double out = 25.0 * mm + radius, depth = 2.0 * mm;
            proxy.reset({0.0, 0.0, out + mm});
            double worst_angle = 0.0, worst_size = 0.0;
            for (int n = 0; n < 1200; ++n) {
                const double a = 1e-3 * n, deep = std::min(depth, 0.01 * mm * n);
                const Vec3 normal(std::sin(a) * std::cos(0.7), std::sin(a) * std::sin(0.7), std::cos(a));
                const coupling::ProxyState& now = proxy.update(normal * (out - deep), {&surface, 1});
                if (n < 250) continue;
                const double size = glm::length(now.force);
                worst_angle = std::max(worst_angle, std::acos(std::min(1.0, glm::dot(now.force / size, normal))));
                worst_size = std::max(worst_size, std::abs(size / (1000.0 * depth) - 1.0));
            }
            CAPTURE(surface.triangles != nullptr, radius, worst_angle / degree, worst_size);
            // A point on flat triangles of half a millimetre on a ball of 25 mm: they are up to 0.6 deg off its normal.
            CHECK(worst_angle < (surface.triangles && radius == 0.0 ? 1.5 : 0.5) * degree);
            CHECK(worst_size < 0.01);
        }
}

TEST_CASE("pushed through a thin plate the proxy stays on top, and the force keeps its direction") {
    for (const coupling::ProxySurface& surface : both(plate_map(), plate_triangles()))
        for (const double radius : {0.0, 0.5 * mm})
            for (const double speed : {0.002, 0.2, 2.0}) {
                coupling::SurfaceProxy proxy;
                proxy.settings.shape.radius = radius;
                proxy.settings.max_force = 1e3;
                proxy.reset({2.1 * mm, 1.3 * mm, 5.0 * mm});
                const int ticks = static_cast<int>(15.0 * mm / speed / 1e-3) + 2;
                for (int n = 0; n < ticks; ++n) {
                    const double z = std::max(-10.0 * mm, 5.0 * mm - speed * 1e-3 * n);
                    const coupling::ProxyState& now = proxy.update({2.1 * mm, 1.3 * mm, z}, {&surface, 1});
                    REQUIRE(now.proxy.z > 1.0 * mm + radius - 0.01 * mm);
                    REQUIRE(now.force.z >= 0.0);
                }
                CAPTURE(surface.triangles != nullptr, radius, speed);
                CHECK(proxy.state().force.z == Approx(1000.0 * (11.0 * mm + radius)).epsilon(0.01));
            }
}

TEST_CASE("friction holds within its cone, slides outside of it with the dynamic force") {
    const coupling::ProxySurface surface{&plate_map(), nullptr, {}};
    coupling::SurfaceProxy proxy;
    proxy.settings.static_friction = 0.6;
    proxy.settings.dynamic_friction = 0.4;
    proxy.reset({0.0, 0.0, 2.0 * mm});
    for (int n = 0; n < 100; ++n) proxy.update({0.0, 0.0, (2.0 - 0.02 * n) * mm}, {&surface, 1});
    const double depth = (1.0 - (2.0 - 0.02 * 99)) * mm;
    const Vec3 anchor = proxy.state().proxy;
    // Up to 0.6 of the depth it sticks.
    for (int n = 0; n < 50; ++n) {
        const double x = 0.55 * depth * n / 50.0;
        const coupling::ProxyState& now = proxy.update({x, 0.0, 1.0 * mm - depth}, {&surface, 1});
        REQUIRE(now.sticks);
        REQUIRE(glm::length(now.proxy - anchor) < 0.01 * mm);
    }
    for (int n = 0; n < 300; ++n) {
        const double x = 0.55 * depth + 0.01 * mm * n;
        const coupling::ProxyState& now = proxy.update({x, 0.0, 1.0 * mm - depth}, {&surface, 1});
        if (n < 100) continue;
        REQUIRE_FALSE(now.sticks);
        REQUIRE(-now.force.x / now.force.z == Approx(0.4).epsilon(0.02));
    }
    CHECK(proxy.state().proxy.x > 2.0 * mm);
}

TEST_CASE("friction while sliding is the dynamic one at every speed and rate, on fields and triangles") {
    for (const coupling::ProxySurface& surface : both(plate_map(), plate_triangles()))
        for (const auto& [most, least] : {std::pair{0.6, 0.3}, std::pair{1.0, 0.1}, std::pair{0.5, 0.0}})
            for (const double speed : {0.01, 0.05, 0.2})
                for (const double rate : {500.0, 4000.0}) {
                    // Triangles cost more: the ends of the range.
                    if (surface.triangles && (speed == 0.05 || most == 1.0)) continue;
                    coupling::SurfaceProxy proxy;
                    proxy.settings.static_friction = most;
                    proxy.settings.dynamic_friction = least;
                    proxy.settings.shape.radius = 0.5 * mm;
                    Vec3 hand(-8.0 * mm, 0.3 * mm, 2.0 * mm);
                    for (; hand.z > 0.5 * mm; hand.z -= 0.05 * mm) proxy.update(hand, {&surface, 1});
                    double sum = 0.0, greatest = 0.0, count = 0.0, step = 0.0, last = 0.0;
                    const double way = 4.0 * mm;
                    const int ticks = static_cast<int>(way / speed * rate);
                    for (int n = 0; n < ticks; ++n) {
                        hand.x += speed / rate;
                        const coupling::ProxyState& now = proxy.update(hand, {&surface, 1});
                        const double ratio = -now.force.x / now.force.z;
                        step = std::max(step, std::abs(now.force.x - last));
                        last = now.force.x;
                        greatest = std::max(greatest, ratio);
                        if (n < ticks / 2) continue;
                        sum += ratio;
                        count += 1.0;
                    }
                    CAPTURE(surface.triangles != nullptr, most, least, speed, rate, greatest);
                    CHECK(sum / count == Approx(least).epsilon(0.02).margin(0.001));
                    // It starts at the static one, and falls no faster than the hand moves.
                    CHECK(greatest < 1.01 * most);
                    CHECK(step < 1.1 * 1000.0 * speed / rate + 1e-3);
                }
}

TEST_CASE("a proxy that turned round sticks again before it slides the other way") {
    const coupling::ProxySurface surface{&plate_map(), nullptr, {}};
    coupling::SurfaceProxy proxy;
    proxy.settings.static_friction = 0.6;
    proxy.settings.dynamic_friction = 0.3;
    for (int n = 0; n < 100; ++n) proxy.update({-4.0 * mm, 0.0, (2.0 - 0.015 * n) * mm}, {&surface, 1});
    double forth = 0.0, back = 0.0;
    for (int n = 0; n < 800; ++n) {
        const double x = (n < 400 ? -4.0 + 0.01 * n : -0.01 * (n - 400)) * mm;
        const coupling::ProxyState& now = proxy.update({x, 0.0, 0.5 * mm}, {&surface, 1});
        const double ratio = now.force.x / now.force.z;
        forth = std::min(forth, ratio);
        back = std::max(back, ratio);
    }
    CHECK(-forth == Approx(0.6).epsilon(0.03));
    CHECK(back == Approx(0.6).epsilon(0.03));
    CHECK(proxy.state().force.x / proxy.state().force.z == Approx(0.3).epsilon(0.02));
}

TEST_CASE("texture makes the force of an even slide wave by the length of its waves") {
    const coupling::ProxySurface surface{&plate_map(), nullptr, {}};
    coupling::SurfaceProxy proxy;
    proxy.settings.texture.height = 0.1 * mm;
    proxy.settings.texture.length = 2.0 * mm;
    proxy.reset({-5.0 * mm, 0.0, 2.0 * mm});
    double least = 1e9, greatest = 0.0, first = 0.0;
    for (int n = 0; n < 400; ++n) {
        const double x = -5.0 * mm + 0.02 * mm * std::max(0, n - 100);
        const double z = std::max(0.0, 2.0 - 0.02 * n) * mm;
        const coupling::ProxyState& now = proxy.update({x, 0.0, z}, {&surface, 1});
        if (n < 150) continue;
        if (n == 200) first = now.force.z;
        if (n == 300) CHECK(now.force.z == Approx(first).margin(0.02));
        least = std::min(least, now.force.z);
        greatest = std::max(greatest, now.force.z);
    }
    CHECK(greatest - least == Approx(0.1).epsilon(0.05));
}

TEST_CASE("a texture on triangles holds back neither a ball nor a point that has no friction") {
    for (const double radius : {0.0, 1.0 * mm})
        for (const double height : {4e-3 * mm, 0.1 * mm}) {
            const coupling::ProxySurface surface{nullptr, &plate_triangles(), {}};
            coupling::SurfaceProxy proxy;
            proxy.settings.shape.radius = radius;
            proxy.settings.texture = {height, 2.0 * mm};
            proxy.reset({-4.0 * mm, 0.3 * mm, 4.0 * mm});
            double most = 0.0;
            for (int n = 0; n < 800; ++n) {
                const double x = -4.0 * mm + 0.02 * mm * std::max(0, n - 400);
                // 0.3 mm deep in the plate.
                const double z = std::max(1.7 * mm + radius, 4.0 * mm - 0.02 * mm * n);
                const coupling::ProxyState& now = proxy.update({x, 0.3 * mm, z}, {&surface, 1});
                most = std::max(most, std::abs(now.proxy.x - x));
            }
            CAPTURE(radius, height, most / mm);
            // The slope of the waves is at most 0.32, of a spring that is 0.5 mm long.
            CHECK(most < 0.2 * mm);
        }
}

TEST_CASE("texture reaches its height on flat and curved faces and does not lift the proxy") {
    const contact::Voxmap& ball = proxy_ball();
    for (const double height : {0.1 * mm, 0.3 * mm}) {
        const auto lifts = [&](const contact::Voxmap& map, const Vec3& start, auto&& hand_at, auto&& lift_of) {
            const coupling::ProxySurface surface{&map, nullptr, {}};
            coupling::SurfaceProxy proxy;
            proxy.settings.shape.radius = 1.0 * mm;
            proxy.settings.texture = {height, 4.0 * mm};
            proxy.settings.max_force = 100.0;
            proxy.reset(start);
            double low = 1.0, high = -1.0;
            constexpr int count = 3000;
            for (int n = -200; n < count; ++n) {
                const Vec3 hand = hand_at(std::max(n, 0) / double{count});
                const double lift =
                    lift_of(proxy.update(n < -100 ? hand + 0.5 * (start - hand) : hand, {&surface, 1}).proxy);
                if (n < 0) continue;
                low = std::min(low, lift);
                high = std::max(high, lift);
            }
            CAPTURE(height / mm, low / mm, high / mm);
            CHECK(high == Approx(height).epsilon(0.05));
            CHECK(-low == Approx(height).epsilon(0.05));
            CHECK(std::abs(low + high) < 0.05 * height);
        };
        // The upper face of the plate, 10 mm long and 9 mm wide. Deep below a steep wave a proxy would stay in the troughs.
        lifts(
            plate_map(), {-5.0 * mm, 0.0, 3.0 * mm},
            [](double u) { return Vec3(-5.0 * mm + 10.0 * mm * u, 4.5 * mm * std::sin(200.0 * u), 1.5 * mm); },
            [](const Vec3& at) { return at.z - 2.0 * mm; });
        // A zone about the pole of the ball.
        lifts(
            ball, {0.0, 0.0, 28.0 * mm},
            [](double u) {
                const double a = 0.35 * std::sqrt(u), b = 200.0 * std::sqrt(u);
                return 25.5 * mm * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
            },
            [](const Vec3& at) { return glm::length(at) - 26.0 * mm; });
    }
}

TEST_CASE("a ball larger than the margin of a field follows the hand on it") {
    const coupling::ProxySurface surface{&plate_map(), nullptr, {}};
    for (const double radius : {2.0 * mm, 3.0 * mm, 6.0 * mm}) {
        coupling::SurfaceProxy proxy;
        proxy.settings.shape.radius = radius;
        proxy.settings.max_force = 1e3;
        proxy.reset({-5.0 * mm, 0.0, radius + 2.0 * mm});
        double most = 0.0, off = 0.0;
        for (int n = 0; n < 1000; ++n) {
            const double x = -5.0 * mm + 0.01 * mm * n;
            const Vec3 hand(x, 0.3 * x, std::max(radius - 3.0 * mm, radius + 2.0 * mm - 0.05 * mm * n));
            const Vec3 at = proxy.update(hand, {&surface, 1}).proxy;
            if (n < 200) continue;
            most = std::max(most, glm::length(Vec3(at.x - hand.x, at.y - hand.y, 0.0)));
            off = std::max(off, std::abs(at.z - radius - 1.0 * mm));
        }
        CAPTURE(radius / mm, most / mm, off / mm);
        CHECK(most < 1e-6);
        CHECK(off < 0.01 * mm);
    }
}

TEST_CASE("a texture does not jump, however deep the hand is, and gives no energy on a flat face") {
    for (const coupling::ProxySurface& surface : both(plate_map(), plate_triangles()))
        for (const double length : {0.5 * mm, 2.0 * mm})
            for (const double height : {0.1 * mm, 2.0 * mm}) {
                coupling::SurfaceProxy proxy;
                proxy.settings.shape.radius = 0.5 * mm;
                proxy.settings.texture = {height, length};
                proxy.settings.max_force = 5.0;
                const double used = std::min(height, 0.2 * length);
                CHECK(proxy.settings.texture.used_height() == used);
                CHECK(proxy.settings.texture.max_slope() < 0.9);
                double work = 0.0, change = 0.0, greatest = 0.0, step = 0.0;
                Vec3 last(0.0), at(-3.0 * mm, 0.2 * mm, 3.0 * mm);
                proxy.reset(at);
                bool is_first = true;
                const auto go = [&](const Vec3& to, int count) {
                    const Vec3 from = at;
                    for (int n = 1; n <= count; ++n) {
                        const Vec3 next = from + (to - from) * (static_cast<double>(n) / count);
                        const Vec3 force = proxy.update(next, {&surface, 1}).force;
                        if (!is_first) {
                            work += 0.5 * glm::dot(force + last, next - at);
                            change = std::max(change, glm::length(force - last));
                            step = std::max(step, glm::length(next - at));
                        }
                        is_first = false;
                        greatest = std::max(greatest, glm::length(force));
                        last = force;
                        at = next;
                    }
                };
                // 3 mm deep, across the waves while it is pressed, and back above.
                go({-3.0 * mm, 0.2 * mm, -1.5 * mm}, 1500);
                go({-1.3 * mm, 0.9 * mm, -1.5 * mm}, 1000);
                go({-1.1 * mm, 1.3 * mm, 0.5 * mm}, 1000);
                go({-1.1 * mm, 1.3 * mm, 3.0 * mm}, 800);
                go({-3.0 * mm, 0.2 * mm, 3.0 * mm}, 100);
                const double k = 2.0 * std::numbers::pi / length;
                CAPTURE(surface.triangles != nullptr, length / mm, height / mm, work * 1e6, change, greatest);
                CHECK(greatest <= 5.0);
                CHECK(greatest > 2.0);
                // The slope of the law: the spring, the slope of the waves twice, and their curvature times the depth.
                CHECK(change < 1000.0 * 3e-6 * (2.0 + 3.0 * mm * used * k * k));
                CHECK(std::abs(work) < 2e-6);
            }
}

TEST_CASE("a proxy on triangles tests a bounded number of them, never enters and arrives in the end") {
    static const geometry::TriangleTree tree(
        geometry::iso_surface(test::map_of(contact::Ball{12.0 * mm}, 0.35 * mm).grid, 0.0f, false));
    const coupling::ProxySurface surface{nullptr, &tree, {}};
    for (const double texture : {0.0, 0.1 * mm}) {
        coupling::SurfaceProxy proxy;
        proxy.settings.shape.radius = 2.0 * mm;
        proxy.settings.texture = {texture, 2.0 * mm};
        proxy.settings.static_friction = proxy.settings.dynamic_friction = 0.3;
        proxy.reset({16.0 * mm, 0.0, 0.0});
        std::int64_t most = 0;
        double nearest = 1.0;
        const auto go = [&](const Vec3& hand) {
            proxy.update(hand, {&surface, 1});
            most = std::max(most, proxy.tested());
            nearest = std::min(nearest, glm::length(proxy.state().proxy));
        };
        // Slides, a jump right across the ball, and a hand that goes round behind it.
        for (int n = 0; n < 120; ++n) go(10.0 * mm * Vec3(std::cos(0.05 * n), std::sin(0.05 * n), 0.0));
        for (int n = 0; n < 60; ++n) go({-60.0 * mm, 1.0 * mm, 0.0});
        for (int n = 0; n < 400; ++n) go({0.0, 30.0 * mm, 0.0});
        CAPTURE(texture, most, nearest / mm);
        CHECK(most < coupling::SurfaceProxy::max_triangles + 8);
        CHECK(nearest > 13.9 * mm - texture);
        // On the waves friction holds it behind the ball.
        if (texture == 0.0) CHECK(glm::length(proxy.state().proxy - Vec3(0.0, 30.0 * mm, 0.0)) < 0.1 * mm);
    }
}

TEST_CASE("a proxy that has no triangles left for this tick stays on the wave of its texture") {
    int near_limit = 0, arrived = 0;
    double most = 0.0;
    for (std::size_t slivers = 200; slivers <= 1600; slivers += 100) {
        // A flat face whose triangles all meet in its middle.
        geometry::TriangleSurface fan;
        fan.vertices.push_back({0.0, 0.0, 0.0});
        for (std::size_t n = 0; n < slivers; ++n) {
            const double turn = 2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(slivers);
            fan.vertices.push_back(30.0 * mm * Vec3(std::cos(turn), std::sin(turn), 0.0));
            const auto next = static_cast<int>(n + 1);
            fan.triangles.push_back({0, next, static_cast<int>((n + 1) % slivers) + 1});
        }
        const geometry::TriangleTree tree(fan);
        const coupling::ProxySurface surface{nullptr, &tree, {}};
        coupling::SurfaceProxy proxy;
        proxy.settings.shape.radius = 3.0 * mm;
        proxy.settings.texture = {0.2 * mm, 3.0 * mm};
        proxy.settings.stiffness = 500.0;
        proxy.reset({-3.0 * mm, -2.0 * mm, 4.0 * mm});
        for (int n = 0; n < 200; ++n) {
            const Vec3 hand(0.03 * n * mm - 3.0 * mm, 0.02 * n * mm - 2.0 * mm, 2.0 * mm);
            const coupling::ProxyState& now = proxy.update(hand, {&surface, 1});
            if (std::hypot(now.proxy.x - hand.x, now.proxy.y - hand.y) > 1e-6) continue;
            ++arrived;
            near_limit += proxy.tested() > coupling::SurfaceProxy::max_triangles * 3 / 4;
            const double wave = proxy.settings.texture.at({hand.x, hand.y, 0.0}, {0.0, 0.0, 1.0}).height;
            most = std::max(most, std::abs(now.proxy.z - 3.0 * mm - wave));
        }
    }
    CHECK(arrived > 1000);
    CHECK(near_limit > 0);
    CHECK(most < 0.02 * mm);
}

TEST_CASE("a proxy keeps its head: no surface, nowhere, inside of a body, far jumps") {
    const coupling::ProxySurface surface{&proxy_ball(), nullptr, {}};
    coupling::SurfaceProxy proxy;
    CHECK(proxy.update({1.0, 2.0, 3.0}, {}).proxy == Vec3(1.0, 2.0, 3.0));
    proxy.reset({0.0, 0.0, 30.0 * mm});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    proxy.update({nan, 0.0, 0.0}, {&surface, 1});
    CHECK(proxy.state().proxy.z == 30.0 * mm);
    for (int n = 0; n < 50; ++n) proxy.update({0.0, 0.0, 15.0 * mm}, {&surface, 1});
    CHECK(proxy.state().proxy.z == Approx(25.0 * mm).margin(0.02 * mm));
    // Through to the other side at once: it stays on this one, or goes round, but never in.
    for (int n = 0; n < 200; ++n) {
        proxy.update({0.3 * mm, 0.0, -60.0 * mm}, {&surface, 1});
        REQUIRE(glm::length(proxy.state().proxy) > 24.9 * mm);
        REQUIRE(is_finite(proxy.state().force));
    }
    // A proxy that finds itself inside is let out.
    proxy.reset({0.0, 0.0, 24.0 * mm});
    for (int n = 0; n < 50; ++n) proxy.update({0.0, 0.0, 24.0 * mm}, {&surface, 1});
    CHECK(proxy.state().proxy.z == Approx(25.0 * mm).margin(0.02 * mm));
}

TEST_CASE("a proxy whose hand is nowhere gives no force, and waits where it was") {
    const coupling::ProxySurface surface{&proxy_ball(), nullptr, {}};
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& nowhere : {Vec3(nan, 0.0, 0.0), Vec3(0.0, 0.0, 2000.0), Vec3(0.0, 1e300, 0.0)}) {
        coupling::SurfaceProxy proxy;
        proxy.reset({0.0, 0.0, 30.0 * mm});
        for (int n = 0; n < 50; ++n) proxy.update({0.0, 0.0, 22.0 * mm}, {&surface, 1});
        const Vec3 force = proxy.state().force;
        REQUIRE(force.z > 0.0);
        CHECK(proxy.update(nowhere, {&surface, 1}).force == Vec3(0.0));
        CHECK_FALSE(proxy.state().in_contact);
        CHECK(glm::length(proxy.update({0.0, 0.0, 22.0 * mm}, {&surface, 1}).force - force) < 0.01 * force.z);
    }
}

TEST_CASE("a proxy allocates nothing") {
    const auto surfaces = both(plate_map(), plate_triangles());
    coupling::SurfaceProxy proxy;
    proxy.settings.static_friction = 0.3;
    const RealtimeViolations seen = watch([&] {
        for (int n = 0; n < 50; ++n) proxy.update({0.1 * mm * n, 0.0, (3.0 - 0.1 * n) * mm}, surfaces);
    });
    CHECK(seen.none());
}
