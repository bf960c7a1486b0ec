// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/self_intersection.hpp"

#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <random>

using namespace tactus;
using geometry::TriangleSurface;

namespace {

// Whether the segment pq passes through the inside of the triangle abc, by solving for the point.
bool passes(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Mat3 m(b - a, c - a, p - q);
    const double d = glm::determinant(m);
    if (std::abs(d) < 1e-15) return false;
    const Vec3 x = glm::inverse(m) * (p - a);
    constexpr double in = 1e-5;
    return x.x > in && x.y > in && x.x + x.y < 1.0 - in && x.z > in && x.z < 1.0 - in;
}

bool by_edges(const TriangleSurface& s, std::size_t a, std::size_t b) {
    const auto at = [&](std::size_t t, std::size_t n) {
        return s.vertices[static_cast<std::size_t>(s.triangles[t][n % 3])];
    };
    for (std::size_t n = 0; n < 3; ++n)
        if (passes(at(a, n), at(a, n + 1), at(b, 0), at(b, 1), at(b, 2)) ||
            passes(at(b, n), at(b, n + 1), at(a, 0), at(a, 1), at(a, 2)))
            return true;
    return false;
}

}  // namespace

TEST_CASE("pairs of intersecting triangles are those of the brute force") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0.0, 0.03), near(-0.004, 0.004);
    for (int mesh = 0; mesh < 4; ++mesh) {
        TriangleSurface s;
        // Triangles apart, and fans that share vertices.
        for (int t = 0; t < 150; ++t) {
            const Vec3 middle(place(random), place(random), place(random));
            const int first = static_cast<int>(s.vertices.size());
            for (int n = 0; n < 4; ++n) s.vertices.push_back(middle + Vec3(near(random), near(random), near(random)));
            s.triangles.push_back({first, first + 1, first + 2});
            if (t % 2 == 0) s.triangles.push_back({first, first + 2, first + 3});
            if (t > 0) s.triangles.push_back({first, first - 1, first + 3});
        }
        std::vector<std::array<int, 2>> expected;
        for (std::size_t a = 0; a < s.triangles.size(); ++a)
            for (std::size_t b = a + 1; b < s.triangles.size(); ++b)
                if (by_edges(s, a, b)) expected.push_back({static_cast<int>(a), static_cast<int>(b)});
        REQUIRE(expected.size() > 20);
        CHECK(geometry::self_intersections(s) == expected);
    }
}

TEST_CASE("triangles that touch or lie beside each other do not intersect") {
    TriangleSurface s;
    // A flat square of two triangles, turned, with a neighbour in its plane and one on an edge of it.
    const Vec3 o(0.1, 0.05, -0.2), u = glm::normalize(Vec3(1.0, 0.3, 0.2)) * 1e-3,
                                   v = glm::normalize(glm::cross(u, Vec3(0.1, 0.9, 0.3))) * 1e-3,
                                   w = glm::cross(u, v) * 1e3;
    s.vertices = {o, o + u, o + u + v, o + v, o + 2.0 * u, o + 2.0 * u + v, o + w, o + u + w};
    s.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}, {0, 1, 6}, {1, 7, 6}};
    CHECK(geometry::self_intersections(s).empty());
    // Folded back onto its neighbour.
    s.vertices.push_back(o + 0.7 * u + 0.2 * v);
    s.triangles.push_back({1, 2, 8});
    CHECK(geometry::self_intersections(s).size() == 1);
    CHECK(geometry::intersect(s, 0, 6));
}
