// SPDX-License-Identifier: Apache-2.0
#include "dsp/skin/sheet.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace tactus;
using skin::Sheet;
using skin::SheetLoads;
using skin::SheetSettings;
using skin::Tether;

namespace {

constexpr double g = 9.81;

const Vec3& at(const Sheet& sheet, int column, int row) {
    return sheet.positions()[static_cast<std::size_t>(sheet.index(column, row))];
}

void hold_column(Sheet& sheet, int column) {
    for (int row = 0; row < sheet.settings().rows; ++row) sheet.pin(sheet.index(column, row), at(sheet, column, row));
}

double energy(const Sheet& sheet, const SheetLoads& loads) { return sheet.potential(loads) + sheet.kinetic(); }

}  // namespace

TEST_CASE("a hanging sheet stretches by its own weight as a bar does") {
    SheetSettings settings{.columns = 21, .rows = 6, .length = 0.2, .width = 0.05, .thickness = 1e-3, .young = 20e3};
    Sheet sheet(settings, {});
    hold_column(sheet, 0);
    SheetLoads loads;
    loads.gravity = {g, 0.0, 0.0};
    REQUIRE(sheet.settle(loads));
    const double expected = settings.density * g * 0.2 * 0.2 / (2.0 * settings.young);
    for (int row = 0; row < 6; ++row) CHECK(at(sheet, 20, row).x - 0.1 == Approx(expected).epsilon(1e-4));
}

TEST_CASE("a sheet that is clamped at one end bends under its weight as a beam does") {
    SheetSettings settings{.columns = 41, .rows = 3, .length = 0.06, .width = 0.02, .thickness = 2e-3, .young = 1e6};
    settings.bending_young = 1e5;
    Sheet sheet(settings, {});
    hold_column(sheet, 0);
    hold_column(sheet, 1);
    SheetLoads loads;
    loads.gravity = {0.0, 0.0, -0.1};
    REQUIRE(sheet.settle(loads));
    // The clamp is between the two held columns.
    const double rigidity = settings.bending_young * 8e-9 / 12.0, free = 0.06 * (1.0 - 0.5 / 40.0);
    const double expected = settings.density * 0.1 * settings.thickness * std::pow(free, 4) / (8.0 * rigidity);
    CHECK(-at(sheet, 40, 1).z == Approx(expected).epsilon(0.02));
}

TEST_CASE("a sheared sheet resists with its shear modulus") {
    SheetSettings settings{.columns = 11, .rows = 11, .length = 0.05, .width = 0.05, .thickness = 2e-3};
    settings.bending_young = 0.0;
    Sheet sheet(settings, {});
    constexpr double angle = 0.02;
    for (int row = 0; row < 11; ++row)
        for (int column = 0; column < 11; ++column) {
            const Vec3 p = at(sheet, column, row);
            sheet.pin(sheet.index(column, row), {p.x + angle * p.y, p.y, 0.0});
        }
    const double volume = 0.05 * 0.05 * settings.thickness;
    // Lines along y become longer by γ²/2: that part of the energy is of fourth order.
    CHECK(sheet.potential({}) == Approx(0.5 * settings.shear * angle * angle * volume).epsilon(1e-3));
}

TEST_CASE("tethers carry the weight of a sheet, and slack ones nothing") {
    SheetSettings settings{.columns = 7, .rows = 5};
    Sheet sheet(settings, {});
    const std::vector<Tether> tethers{{sheet.index(0, 0), {-0.03, -0.02, 0.03}, 0.02, 500.0},
                                      {sheet.index(6, 0), {0.03, -0.02, 0.03}, 0.02, 500.0},
                                      {sheet.index(0, 4), {-0.03, 0.02, 0.03}, 0.02, 500.0},
                                      {sheet.index(6, 4), {0.03, 0.02, 0.03}, 0.02, 500.0},
                                      {sheet.index(3, 2), {0.0, 0.0, 0.03}, 0.2, 500.0}};
    SheetLoads loads;
    loads.gravity = {0.0, 0.0, -g};
    loads.tethers = tethers;
    REQUIRE(sheet.settle(loads));
    double up = 0.0;
    for (const Tether& t : tethers) {
        const Vec3 along = t.to - sheet.positions()[static_cast<std::size_t>(t.node)];
        up += sheet.tension(t) * along.z / glm::length(along);
    }
    CHECK(up == Approx(0.06 * 0.04 * settings.thickness * settings.density * g).epsilon(1e-4));
    CHECK(sheet.tension(tethers.back()) == 0.0);
}

TEST_CASE("a sheet pressed on a cylinder or a ball lies at half of its thickness from it") {
    SheetSettings settings{.columns = 25, .rows = 13, .thickness = 4e-3, .bending_young = 1e3, .contact = 5e3};
    SheetLoads loads;
    loads.pressure = {0.0, 0.0, -300.0};
    SECTION("a cylinder: the middle takes its curvature") {
        const rope::Cylinder cylinder({0.0, 0.0, -0.06}, {0.0, 1.0, 0.0}, 0.05);
        loads.obstacle = &cylinder;
        Sheet sheet(settings, {{0.0, 0.0, 3e-3}, {1.0, 0.0, 0.0, 0.0}});
        REQUIRE(sheet.settle(loads, 1e-6));
        for (int column = 10; column <= 14; ++column) {
            const Vec3 p = at(sheet, column, 6);
            CHECK(std::hypot(p.x, p.z + 0.06) == Approx(0.052).epsilon(2e-3));
        }
        // Three neighbouring points on the circle that it takes.
        const Vec3 a = at(sheet, 11, 6), b = at(sheet, 12, 6), c = at(sheet, 13, 6);
        const double twice = glm::length(glm::cross(b - a, c - a));
        CHECK(glm::length(b - a) * glm::length(c - b) * glm::length(c - a) / (2.0 * twice) ==
              Approx(0.052).epsilon(0.03));
    }
    SECTION("a ball: nothing is inside of it") {
        const rope::Ball ball({0.0, 0.0, -0.05}, 0.04);
        loads.obstacle = &ball;
        Sheet sheet(settings, {{0.0, 0.0, -5e-3}, {1.0, 0.0, 0.0, 0.0}});
        for (int n = 0; n < 40; ++n) sheet.step(5e-3, loads);
        for (const Vec3& p : sheet.positions()) CHECK(glm::length(p - Vec3(0.0, 0.0, -0.05)) > 0.042 - 0.1e-3);
        CHECK(glm::length(at(sheet, 12, 6) - Vec3(0.0, 0.0, -0.05)) == Approx(0.042).epsilon(2e-3));
    }
}

TEST_CASE("a sheet gains no energy, at steps from 0.1 ms to 1 s") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const rope::Ball ball({0.0, 0.0, -0.03}, 0.02);
    for (const double dt : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
        CAPTURE(dt);
        SheetSettings settings{.columns = 9, .rows = 7};
        Sheet sheet(settings, {});
        // Crumpled by pins that are released, so that it starts with much elastic energy.
        for (int n = 0; n < static_cast<int>(sheet.size()); ++n) {
            sheet.pin(
                n, sheet.positions()[static_cast<std::size_t>(n)] + 8e-3 * Vec3(any(random), any(random), any(random)));
            sheet.release(n);
        }
        hold_column(sheet, 0);
        SheetLoads loads;
        loads.gravity = {0.0, 0.0, -g};
        loads.obstacle = &ball;
        double before = energy(sheet, loads);
        const double scale = std::abs(before);
        for (int n = 0; n < 30; ++n) {
            sheet.step(dt, loads);
            const double now = energy(sheet, loads);
            REQUIRE(std::isfinite(now));
            CHECK(now <= before + 1e-6 * scale);
            before = now;
        }
    }
}

TEST_CASE("ten thousand random pulls leave a sheet finite", "[slow]") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    std::uniform_int_distribution<int> node(0, 19);
    SheetSettings settings{.columns = 5, .rows = 4};
    Sheet sheet(settings, {});
    const rope::Ball ball({0.0, 0.0, -0.02}, 0.015);
    SheetLoads loads;
    loads.gravity = {0.0, 0.0, -g};
    loads.obstacle = &ball;
    for (int n = 0; n < 10000; ++n) {
        const int held = node(random);
        sheet.pin(held, 0.05 * Vec3(any(random), any(random), any(random)));
        sheet.step(n % 2 ? 1e-3 : 2e-2, loads);
        sheet.release(held);
        for (const Vec3& p : sheet.positions()) REQUIRE(is_finite(p));
    }
}

TEST_CASE("a step of a sheet allocates nothing and gives the same bits each time") {
    SheetSettings settings{.columns = 12, .rows = 8};
    const rope::Ball ball({0.0, 0.0, -0.03}, 0.02);
    SheetLoads loads;
    loads.gravity = {0.0, 0.0, -g};
    loads.obstacle = &ball;
    Sheet first(settings, {}), second(settings, {});
    const RealtimeViolations seen = watch([&] {
        for (int n = 0; n < 5; ++n) first.step(0.01, loads);
    });
    INFO(seen.describe());
    CHECK(seen.none());
    for (int n = 0; n < 5; ++n) second.step(0.01, loads);
    CHECK(first.positions() == second.positions());
}

TEST_CASE("settings of a sheet that cannot be are refused") {
    CHECK_THROWS_AS(Sheet(SheetSettings{.columns = 1}, {}), Error);
    CHECK_THROWS_AS(Sheet(SheetSettings{.rows = 1000}, {}), Error);
    CHECK_THROWS_AS(Sheet(SheetSettings{.length = 0.0}, {}), Error);
    CHECK_THROWS_AS(Sheet(SheetSettings{.young = 0.0}, {}), Error);
    CHECK_THROWS_AS(Sheet(SheetSettings{.density = std::nan("")}, {}), Error);
    CHECK_THROWS_AS(Sheet({}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}}), Error);
}
