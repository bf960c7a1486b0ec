// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/cut.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/dsp/reconstruction/donors.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

double enclosed(const geometry::TriangleSurface& surface) {
    double sum = 0.0;
    for (const auto& t : surface.triangles) {
        const auto at = [&](std::size_t c) { return surface.vertices[static_cast<std::size_t>(t[c])]; };
        sum += glm::dot(at(0), glm::cross(at(1), at(2))) / 6.0;
    }
    return sum;
}

bool is_closed(const geometry::TriangleSurface& surface) {
    std::map<std::pair<int, int>, int> balance;
    for (const auto& t : surface.triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const int a = t[c], b = t[(c + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

// A jaw as half a ring of radius 40 mm in the plane z = 0: rami at x = ±40 mm, the chin at y = -40 mm.
geometry::TriangleSurface half_ring() {
    geometry::TriangleSurface straight =
        closed_tube(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 1.0, 40, 81, [](double, double) { return 6.0 * mm; });
    for (Vec3& v : straight.vertices) {
        const double a = pi * v.z;
        const Vec3 out(-std::cos(a), -std::sin(a), 0.0);
        // Along the ring the directions across keep their orientation to its tangent.
        v = (40.0 * mm + v.x) * out + Vec3(0.0, 0.0, -v.y);
    }
    if (enclosed(straight) < 0.0)
        for (auto& t : straight.triangles) std::swap(t[1], t[2]);
    return straight;
}

/// Along z, 100 mm long and 7 mm in radius, with a cavity of 3 mm from z = 10 to 90 mm.
geometry::TriangleSurface hollow_tube() {
    const Vec3 z(0.0, 0.0, 1.0);
    geometry::TriangleSurface bone =
        closed_tube(Vec3(0.0), z, 100.0 * mm, 60, 31, [](double, double) { return 7.0 * mm; });
    geometry::TriangleSurface cavity =
        closed_tube(Vec3(0.0, 0.0, 10.0 * mm), z, 80.0 * mm, 60, 31, [](double, double) { return 3.0 * mm; });
    for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
    append(bone, cavity);
    return bone;
}

/// A bone without ends, of radius 40 mm in the plane z = 0.
geometry::TriangleSurface closed_ring() {
    geometry::TriangleSurface ring =
        closed_tube(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 1.0, 12, 41, [](double, double) { return 6.0 * mm; });
    ring.vertices.resize(12 * 40);
    ring.triangles.clear();
    for (int n = 0; n < 40; ++n)
        for (int m = 0; m < 12; ++m) {
            const auto at = [](int i, int j) { return (i % 40) * 12 + j % 12; };
            ring.triangles.push_back({at(n, m), at(n, m + 1), at(n + 1, m)});
            ring.triangles.push_back({at(n, m + 1), at(n + 1, m + 1), at(n + 1, m)});
        }
    for (std::size_t n = 0; n < ring.vertices.size(); ++n) {
        const Vec3 v = ring.vertices[n];
        const double a = 2.0 * pi * v.z;
        ring.vertices[n] = (40.0 * mm + v.x) * Vec3(std::cos(a), std::sin(a), 0.0) + Vec3(0.0, 0.0, v.y);
    }
    return ring;
}

}  // namespace

TEST_CASE("a plane through one ramus of a jaw leaves the other one whole") {
    const geometry::TriangleSurface jaw = half_ring();
    REQUIRE(is_closed(jaw));
    const double all = enclosed(jaw);
    CHECK(all == Approx(pi * 36.0 * pi * 40.0 * mm * mm * mm).epsilon(0.02));
    // Both planes reach through both rami; the piece lies between -140° and -100° on the left.
    const auto at = [](double turn) { return 40.0 * mm * Vec3(-std::cos(turn), -std::sin(turn), 0.0); };
    const auto along = [](double turn) { return Vec3(std::sin(turn), -std::cos(turn), 0.0); };
    const Plane first{at(0.5), along(0.5)}, last{at(1.2), along(1.2)};
    const CutPieces pieces = cut_between(jaw, first, last);
    REQUIRE(pieces.rest.size() == 2);
    CHECK(is_closed(pieces.between));
    CHECK(is_closed(pieces.rest[0].surface));
    CHECK(is_closed(pieces.rest[1].surface));
    CHECK(enclosed(pieces.between) == Approx(all * 0.7 / pi).epsilon(0.005));
    CHECK(enclosed(pieces.between) + enclosed(pieces.rest[0].surface) + enclosed(pieces.rest[1].surface) ==
          Approx(all).epsilon(1e-9));
    for (const Vec3& v : pieces.between.vertices) {
        CHECK(glm::dot(v - first.origin, first.normal) > -1e-12);
        CHECK(glm::dot(v - last.origin, last.normal) < 1e-12);
    }
    // Half a jaw: all beyond one plane.
    const CutPieces half = cut_between(jaw, {at(pi / 2.0), along(pi / 2.0)}, {});
    REQUIRE(half.rest.size() == 1);
    CHECK(enclosed(half.between) == Approx(0.5 * all).epsilon(1e-6));
    for (const Vec3& v : half.between.vertices) CHECK(v.x > -1e-9);
}

TEST_CASE("pieces of a hollow bone have the volume between their planes") {
    const Vec3 z(0.0, 0.0, 1.0);
    const geometry::TriangleSurface bone = hollow_tube();
    const double all = enclosed(bone);
    const double area = 30.0 * std::sin(2.0 * pi / 60.0) * (49.0 - 9.0) * mm * mm;  // of two polygons of 60 corners
    for (std::uint64_t trial = 0; trial < 50; ++trial) {
        const Random random{trial};
        const auto tilted = [&](std::uint64_t draw, double height) {
            return Plane{Vec3(0.0, 0.0, height), glm::normalize(Vec3(0.5 * (random.uniform(draw) - 0.5),
                                                                     0.5 * (random.uniform(draw + 1) - 0.5), 1.0))};
        };
        const double low = (20.0 + 10.0 * random.uniform(1)) * mm, high = (50.0 + 20.0 * random.uniform(2)) * mm;
        const CutPieces pieces = cut_between(bone, tilted(3, low), tilted(5, high));
        CHECK(is_closed(pieces.between));
        CHECK(enclosed(pieces.between) == Approx(area * (high - low)).epsilon(1e-6));
        double sum = enclosed(pieces.between);
        for (const auto& piece : pieces.rest) sum += enclosed(piece.surface);
        CHECK(sum == Approx(all).epsilon(1e-9));
    }
}

TEST_CASE("cuts that miss a bone or do not separate it are refused") {
    using Catch::Matchers::ContainsSubstring;
    const geometry::TriangleSurface jaw = half_ring();
    const Vec3 x(1.0, 0.0, 0.0);
    CHECK_THROWS_WITH(cut_between(jaw, {Vec3(0.0, 0.0, 1.0), Vec3(0.0, 0.0, 1.0)}, {}), ContainsSubstring("misses"));
    // A closed ring stays in one piece when it is cut once.
    const geometry::TriangleSurface ring = closed_ring();
    REQUIRE(is_closed(ring));
    CHECK_THROWS_WITH(cut_between(ring, {Vec3(0.0, 40.0 * mm, 0.0), x}, {}), ContainsSubstring("do not separate"));
}

TEST_CASE("the rest of a ring is one piece, which both planes have cut") {
    const Plane first{Vec3(0.0, 40.0 * mm, 0.0), Vec3(1.0, 0.0, 0.0)},
        last{Vec3(40.0 * mm, 0.0, 0.0), Vec3(0.0, -1.0, 0.0)};
    const CutPieces cut = cut_between(closed_ring(), first, last);
    REQUIRE(cut.rest.size() == 1);
    CHECK(cut.rest[0].cut_by == CutBy::both);
    CHECK(std::abs(enclosed(cut.rest[0].surface)) == Approx(3.0 * std::abs(enclosed(cut.between))).epsilon(0.05));
}

TEST_CASE("a cut whose origin lies in the wall of a hollow bone or beside it also cuts the marrow cavity") {
    const Vec3 z(0.0, 0.0, 1.0);
    const geometry::TriangleSurface bone = hollow_tube();
    const double area = 30.0 * std::sin(2.0 * pi / 60.0) * (49.0 - 9.0) * mm * mm;
    // The cavity ends 10 mm before the bone does.
    const double ends = 30.0 * std::sin(2.0 * pi / 60.0) * 9.0 * 10.0 * mm * mm * mm;
    for (const double aside : {0.0, 5.0 * mm, 12.0 * mm}) {
        const CutPieces pieces =
            cut_between(bone, {Vec3(aside, 0.0, 30.0 * mm), z}, Plane{Vec3(0.0, aside, 50.0 * mm), z});
        CHECK(is_closed(pieces.between));
        CHECK(enclosed(pieces.between) == Approx(area * 20.0 * mm).epsilon(1e-6));
        // The cavity has no connection to the bone and stays with it.
        REQUIRE(pieces.rest.size() == 2);
        CHECK(pieces.rest[0].cut_by == CutBy::last);  // 50 mm long, the other one 30 mm
        CHECK(pieces.rest[1].cut_by == CutBy::first);
        CHECK(enclosed(pieces.rest[0].surface) == Approx(area * 50.0 * mm + ends).epsilon(1e-6));
        CHECK(enclosed(pieces.rest[1].surface) == Approx(area * 30.0 * mm + ends).epsilon(1e-6));
    }
}

TEST_CASE("a cavity that no plane cuts stays with the piece around it") {
    const Vec3 z(0.0, 0.0, 1.0);
    geometry::TriangleSurface bone =
        closed_tube(Vec3(0.0), z, 100.0 * mm, 60, 31, [](double, double) { return 7.0 * mm; });
    const double solid = enclosed(bone);
    std::vector<double> pores;
    // Corners, edges and axes of the pores lie on those of the bone. The last one is a tooth in a cavity.
    for (const double from : {10.0, 40.0, 80.0}) {
        geometry::TriangleSurface pore =
            closed_tube(Vec3(0.0, 0.0, from * mm), z, 10.0 * mm, 60, 4, [](double, double) { return 3.0 * mm; });
        for (auto& t : pore.triangles) std::swap(t[1], t[2]);
        pores.push_back(-enclosed(pore));
        append(bone, pore);
    }
    const geometry::TriangleSurface tooth =
        closed_tube(Vec3(0.0, 0.0, 43.0 * mm), z, 4.0 * mm, 60, 4, [](double, double) { return 1.0 * mm; });
    append(bone, tooth);
    // The same for a surface that looks inwards as a whole.
    for (const double sign : {1.0, -1.0}) {
        const CutPieces pieces = cut_between(bone, {Vec3(0.0, 0.0, 30.0 * mm), z}, Plane{Vec3(0.0, 0.0, 60.0 * mm), z});
        REQUIRE(pieces.rest.size() == 3);
        CHECK(sign * enclosed(pieces.between) ==
              Approx(std::copysign(0.3 * std::abs(solid) - std::abs(pores[1]), solid)));
        CHECK(sign * enclosed(pieces.rest[0].surface) ==
              Approx(std::copysign(0.4 * std::abs(solid) - std::abs(pores[2]), solid)));
        CHECK(sign * enclosed(pieces.rest[1].surface) ==
              Approx(std::copysign(0.3 * std::abs(solid) - std::abs(pores[0]), solid)));
        CHECK(pieces.rest[2].cut_by == CutBy::none);
        CHECK(sign * enclosed(pieces.rest[2].surface) == Approx(enclosed(tooth)));
        for (auto& t : bone.triangles) std::swap(t[1], t[2]);
    }
}

TEST_CASE("a plane whose origin does not tell which limb is meant is refused") {
    using Catch::Matchers::ContainsSubstring;
    const geometry::TriangleSurface jaw = half_ring();
    const Vec3 forwards(0.0, -1.0, 0.0);
    // Between the rami, and far to the left of both.
    for (const double x : {2.0, 70.0})
        CHECK_THROWS_WITH(cut_between(jaw, {Vec3(x, -10.0, 0.0) * mm, forwards}, {}),
                          ContainsSubstring("does not tell which limb"));
    CHECK_NOTHROW(cut_between(jaw, {Vec3(36.0, -10.0, 10.0) * mm, forwards}, {}));
}

TEST_CASE("planes that cross inside a bone are refused and planes that cross beside it are not") {
    using Catch::Matchers::ContainsSubstring;
    const geometry::TriangleSurface bone =
        closed_tube(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 100.0 * mm, 60, 31, [](double, double) { return 7.0 * mm; });
    const auto tilted = [](double height, double slope) {
        return Plane{Vec3(0.0, 0.0, height * mm), glm::normalize(Vec3(slope, 0.0, 1.0))};
    };
    CHECK_THROWS_WITH(cut_between(bone, tilted(45.0, 0.6), tilted(50.0, -0.6)), ContainsSubstring("cross inside"));
    const CutPieces pieces = cut_between(bone, tilted(45.0, 0.6), tilted(55.0, -0.6));
    CHECK(pieces.rest.size() == 2);
    CHECK(enclosed(pieces.between) ==
          Approx(30.0 * std::sin(2.0 * pi / 60.0) * 49.0 * 10.0 * mm * mm * mm).epsilon(1e-6));
}
