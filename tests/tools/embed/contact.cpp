// SPDX-License-Identifier: Apache-2.0
// tactus_contact_at: the wrench between two meshes in memory.
#include "tests/support/catch.hpp"
#include "tools/embed/tactus.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using Catch::Matchers::ContainsSubstring;

namespace {

tactus_error error;

struct Mesh {
    std::vector<double> vertices;
    std::vector<std::int32_t> triangles;

    tactus_mesh view() const { return {vertices.data(), vertices.size() / 3, triangles.data(), triangles.size() / 3}; }
};

/// A box, m, centred on the origin; its top is at z = 0.
Mesh slab() {
    Mesh mesh;
    for (int n = 0; n < 8; ++n)
        for (const double v : {n & 1 ? 0.02 : -0.02, n & 2 ? 0.02 : -0.02, n & 4 ? 0.0 : -0.01})
            mesh.vertices.push_back(v);
    mesh.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

constexpr double radius = 0.01;

/// A ball whose centre is `x` from the origin of the mesh, m.
Mesh ball(double x = 0.0) {
    Mesh mesh;
    constexpr int rows = 60, columns = 120;
    for (int i = 0; i <= rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double v = std::numbers::pi * i / rows, u = 2.0 * std::numbers::pi * j / columns;
            mesh.vertices.push_back(x + radius * std::sin(v) * std::cos(u));
            mesh.vertices.push_back(radius * std::sin(v) * std::sin(u));
            mesh.vertices.push_back(radius * std::cos(v));
        }
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const int a = i * columns + j, b = i * columns + (j + 1) % columns;
            for (const int corner : {a, a + columns, b, b, a + columns, b + columns}) mesh.triangles.push_back(corner);
        }
    return mesh;
}

struct FreeContact {
    void operator()(tactus_contact* contact) const { tactus_free_contact(contact); }
};
using Contact = std::unique_ptr<tactus_contact, FreeContact>;

Contact made(const Mesh& moving, const Mesh& fixed, double stiffness) {
    const tactus_mesh first = moving.view(), second = fixed.view();
    const tactus_contact_settings settings{sizeof(settings), stiffness, 0.1e-3, 0.25e-3};
    Contact contact(tactus_make_contact(&first, &second, &settings, &error));
    INFO(error.text);
    REQUIRE(contact);
    return contact;
}

tactus_contact_sum at(const Contact& contact, double x, double z) {
    const std::array<double, 7> pose{x, 0.0, z, 1.0, 0.0, 0.0, 0.0};
    tactus_contact_sum sum{};
    const int done = tactus_contact_at(contact.get(), pose.data(), 1, &sum, &error);
    INFO(error.text);
    REQUIRE(done == 0);
    return sum;
}

}  // namespace

TEST_CASE("a ball pressed into a slab gives the force of a foundation of springs, at its centre, and its stiffness") {
    constexpr double k = 1e9, depth = 0.5e-3;
    const Contact contact = made(ball(), slab(), k);
    const tactus_contact_sum sum = at(contact, 0.0, radius - depth);
    // ∫ s dA over the cap, whose area per depth is 2πR everywhere.
    const double force = k * std::numbers::pi * radius * depth * depth;
    CHECK(sum.wrench[2] == Approx(force).epsilon(0.03));
    for (const int other : {0, 1}) CHECK(std::abs(sum.wrench[other]) < 0.01 * force);
    for (const int torque : {3, 4, 5}) CHECK(std::abs(sum.wrench[torque]) < 0.01 * force * radius);
    CHECK(sum.penetration == Approx(depth).epsilon(0.02));
    CHECK(sum.energy == Approx(force * depth / 3.0).epsilon(0.05));
    CHECK(sum.points > 100);
    const double step = 10e-6, above = at(contact, 0.0, radius - depth + step).wrench[2],
                 below = at(contact, 0.0, radius - depth - step).wrench[2];
    CHECK(sum.stiffness[2 * 6 + 2] == Approx((below - above) / (2.0 * step)).epsilon(0.02));
    CHECK(at(contact, 0.0, radius + 1e-3).points == 0);
}

TEST_CASE("the torque is about the position of the pose") {
    constexpr double x = 4e-3;
    const Contact contact = made(ball(x), slab(), 1e9);
    const tactus_contact_sum sum = at(contact, 0.0, radius - 0.5e-3);
    REQUIRE(sum.wrench[2] > 1.0);
    CHECK(sum.wrench[4] == Approx(-x * sum.wrench[2]).epsilon(0.01));
}

TEST_CASE("a contact that cannot be made or evaluated is refused with the reason") {
    const auto refused = [](const Mesh& moving, const Mesh& fixed, tactus_contact_settings settings,
                            const char* words) {
        CAPTURE(words);
        const tactus_mesh first = moving.view(), second = fixed.view();
        CHECK_FALSE(Contact(tactus_make_contact(&first, &second, &settings, &error)));
        CHECK_THAT(error.text, ContainsSubstring(words));
    };
    tactus_contact_settings settings{};
    settings.size = sizeof(settings);
    Mesh open = slab();
    open.triangles.resize(open.triangles.size() - 3);
    refused(ball(), open, settings, "not closed: 3 edges");
    Mesh inside_out = slab();
    for (std::size_t n = 0; n < inside_out.triangles.size(); n += 3)
        std::swap(inside_out.triangles[n], inside_out.triangles[n + 1]);
    refused(ball(), inside_out, settings, "inside out");
    refused(Mesh{}, slab(), settings, "moving mesh has no vertices");
    settings.voxel = 2e-5;
    refused(ball(), slab(), settings, "wider voxel");
    settings.voxel = -1.0;
    refused(ball(), slab(), settings, "voxel");
    settings.voxel = 0.0;
    settings.stiffness = std::numeric_limits<double>::quiet_NaN();
    refused(ball(), slab(), settings, "stiffness");
    settings.size = 3;
    refused(ball(), slab(), settings, "size");

    const Contact contact = made(ball(), slab(), 1e9);
    std::array<double, 14> poses{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
    std::array<tactus_contact_sum, 2> sums{};
    CHECK(tactus_contact_at(contact.get(), poses.data(), 2, sums.data(), &error) == -1);
    CHECK_THAT(error.text, ContainsSubstring("pose 1 is not valid"));
    CHECK(tactus_contact_at(contact.get(), nullptr, 1, sums.data(), &error) == -1);
    CHECK(tactus_contact_at(nullptr, poses.data(), 1, sums.data(), &error) == -1);
    CHECK(tactus_contact_at(contact.get(), nullptr, 0, nullptr, &error) == 0);
}
