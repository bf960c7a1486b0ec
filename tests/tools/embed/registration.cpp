// SPDX-License-Identifier: Apache-2.0
// tactus_register: a mesh in memory onto another one.
#include "tests/support/catch.hpp"
#include "tools/embed/tactus.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;

namespace {

using Place = std::array<double, 3>;

tactus_error error;

struct Mesh {
    std::vector<double> vertices;
    std::vector<std::int32_t> triangles;

    tactus_mesh view() const { return {vertices.data(), vertices.size() / 3, triangles.data(), triangles.size() / 3}; }
};

/// A closed surface around the origin, of radius `radius(direction)`, m.
template <class Radius>
Mesh around(int rows, const Radius& radius) {
    Mesh mesh;
    const int columns = 2 * rows;
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double v = std::numbers::pi * i / rows, u = 2.0 * std::numbers::pi * j / columns;
            const Place d{std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v)};
            for (const double part : d) mesh.vertices.push_back(radius(d) * part);
        }
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const int a = i * columns + j, b = i * columns + (j + 1) % columns, c = a + columns, d = b + columns;
            for (const int corner : {a, c, b, b, c, d}) mesh.triangles.push_back(corner);
        }
    return mesh;
}

Mesh lump() {
    return around(40, [](const Place& d) {
        return 1e-3 * (12.0 + 4.0 * d[0] + 3.0 * d[1] * d[2] + 2.5 * d[0] * d[1] + 5.0 * d[2] * d[2] +
                       3.0 * d[1] * d[0] * d[0]);
    });
}

/// Rotated about z by `angle`, rad, then shifted, m.
Mesh moved(Mesh mesh, double angle, const Place& by) {
    for (std::size_t n = 0; n < mesh.vertices.size(); n += 3) {
        const double x = mesh.vertices[n], y = mesh.vertices[n + 1];
        mesh.vertices[n] = std::cos(angle) * x - std::sin(angle) * y + by[0];
        mesh.vertices[n + 1] = std::sin(angle) * x + std::cos(angle) * y + by[1];
        mesh.vertices[n + 2] += by[2];
    }
    return mesh;
}

tactus_registration registered(const Mesh& moving, const Mesh& fixed) {
    const tactus_mesh first = moving.view(), second = fixed.view();
    tactus_registration found{};
    const int done = tactus_register(&first, &second, 0, &found, &error);
    INFO(error.text);
    REQUIRE(done == 0);
    return found;
}

}  // namespace

TEST_CASE("a mesh that was moved is registered at the pose that brings it back") {
    const Mesh fixed = lump();
    const double angle = 0.7;
    const Place by{0.04, -0.03, 0.02};
    const tactus_registration found = registered(moved(fixed, angle, by), fixed);
    CHECK(std::string(found.verdict) == "fit");
    CHECK(found.orientation[0] == Approx(std::cos(angle / 2)).margin(1e-4));
    CHECK(found.orientation[3] == Approx(-std::sin(angle / 2)).margin(1e-4));
    // The inverse of x ↦ R x + by.
    CHECK(found.position[0] == Approx(-(std::cos(angle) * by[0] + std::sin(angle) * by[1])).margin(2e-5));
    CHECK(found.position[1] == Approx(std::sin(angle) * by[0] - std::cos(angle) * by[1]).margin(2e-5));
    CHECK(found.position[2] == Approx(-by[2]).margin(2e-5));
    CHECK(found.rms < 1e-5);
    CHECK(found.p90 < 1e-5);
    CHECK(found.covered == 1.0);
    CHECK(found.rival_rms > 10.0 * found.rms);
}

TEST_CASE("an ellipsoid is ambiguous, and meshes of different shape have no pose or another verdict than fit") {
    const Mesh ellipsoid = around(
        30, [](const Place& d) { return 0.02 / std::sqrt(d[0] * d[0] + 2.0 * d[1] * d[1] + 4.0 * d[2] * d[2]); });
    const tactus_registration found = registered(moved(ellipsoid, 0.5, {0.01, 0.0, 0.0}), ellipsoid);
    CHECK(std::string(found.verdict) == "ambiguous");
    CHECK(std::isfinite(found.rival_rms));
    CHECK(std::string(registered(ellipsoid, lump()).verdict) != "fit");
}

TEST_CASE("a mesh that cannot be registered is refused with the reason") {
    const Mesh good = lump();
    const auto refused = [&](const Mesh& mesh, const char* words) {
        CAPTURE(words);
        const tactus_mesh first = good.view(), second = mesh.view();
        tactus_registration found{};
        CHECK(tactus_register(&first, &second, 0, &found, &error) == -1);
        CHECK_THAT(error.text, ContainsSubstring("fixed mesh"));
        CHECK_THAT(error.text, ContainsSubstring(words));
    };
    Mesh mesh = good;
    for (double& v : mesh.vertices) v *= 1e3;
    refused(mesh, "vertices are in m");
    mesh = good;
    mesh.vertices[4] = std::numeric_limits<double>::quiet_NaN();
    refused(mesh, "vertex 1 of");
    for (const std::int32_t wrong : {-1, static_cast<std::int32_t>(good.vertices.size() / 3)}) {
        mesh = good;
        mesh.triangles[5] = wrong;
        refused(mesh, "triangle 1 of");
    }
    mesh = good;
    mesh.triangles = {0, 0, 1, 2, 2, 2};
    refused(mesh, "no area");
    refused(Mesh{}, "no vertices");
    const tactus_mesh view = good.view();
    CHECK(tactus_register(&view, &view, 0, nullptr, &error) == -1);
    CHECK(tactus_register(nullptr, &view, 0, nullptr, &error) == -1);
}
