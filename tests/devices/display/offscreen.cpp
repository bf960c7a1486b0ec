// SPDX-License-Identifier: Apache-2.0
#include "devices/display/offscreen.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

using namespace tactus;
using tactus::test::can_render;

namespace {

display::PictureMesh sphere(const Vec3& centre, double radius, const Vec3& colour) {
    constexpr std::uint32_t rows = 40, columns = 80;
    display::PictureMesh mesh;
    for (std::uint32_t row = 0; row <= rows; ++row)
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const double polar = std::numbers::pi * row / rows, azimuth = 2.0 * std::numbers::pi * column / columns;
            const Vec3 normal(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
            const Vec3 position = centre + radius * normal;
            for (int i = 0; i < 3; ++i) {
                mesh.positions.push_back(static_cast<float>(position[i]));
                mesh.normals.push_back(static_cast<float>(normal[i]));
                mesh.colours.push_back(static_cast<float>(colour[i]));
            }
        }
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
            mesh.triangles.insert(mesh.triangles.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    return mesh;
}

bool is_grey(const std::uint8_t* p) { return p[0] > 180 && std::abs(p[0] - p[1]) < 12 && std::abs(p[1] - p[2]) < 12; }
bool is_red(const std::uint8_t* p) { return p[0] > 100 && p[0] > 2 * p[1] && p[0] > 2 * p[2]; }
bool is_blue(const std::uint8_t* p) { return p[2] > 100 && p[2] > 2 * p[0]; }

}  // namespace

TEST_CASE("a red sphere is red in the middle and leaves the corners to the background") {
    if (!can_render()) return;
    const std::array scene{sphere({0.0, 0.0, 0.0}, 0.01, {0.9, 0.1, 0.1})};
    const display::View view = display::fit_view({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {0.0, 1.0, 0.0});
    const display::Image image = display::render_picture(scene, view, 160, 120);
    REQUIRE(image.rgb.size() == 160 * 120 * 3);
    CHECK(is_red(image.pixel(80, 60)));
    for (const int x : {0, 159})
        for (const int y : {0, 119}) CHECK(is_grey(image.pixel(x, y)));
}

TEST_CASE("the nearer mesh hides the farther, and up is up") {
    if (!can_render()) return;
    // The eye looks along +y: blue stands before red, and a red sphere above both.
    const std::array scene{sphere({0.0, 0.0, 0.0}, 1.0, {0.9, 0.1, 0.1}),
                           sphere({0.0, -3.0, 0.0}, 0.5, {0.1, 0.1, 0.9}),
                           sphere({0.0, 0.0, 2.0}, 0.5, {0.9, 0.1, 0.1})};
    const display::View view = display::fit_view({-1.0, -3.5, -2.5}, {1.0, 1.0, 2.5}, {0.0, 1.0, 0.0});
    const display::Image image = display::render_picture(scene, view, 200, 200);
    CHECK(is_blue(image.pixel(100, 100)));
    int red_above = 0, red_below = 0;
    for (int y = 0; y < 60; ++y) red_above += is_red(image.pixel(100, y));
    for (int y = 140; y < 200; ++y) red_below += is_red(image.pixel(100, y));
    CHECK(red_above > 5);
    CHECK(red_below == 0);
}

TEST_CASE("edges are smooth: a pixel on the rim is a mixture") {
    if (!can_render()) return;
    const std::array scene{sphere({0.0, 0.0, 0.0}, 1.0, {0.0, 0.0, 0.0})};
    const display::Image image =
        display::render_picture(scene, display::fit_view({-2, -2, -2}, {2, 2, 2}, {0, 1, 0}), 101, 101);
    int mixed = 0;
    for (int y = 0; y < 101; ++y)
        for (int x = 0; x < 101; ++x) mixed += image.pixel(x, y)[0] > 120 && image.pixel(x, y)[0] < 190;
    CHECK(mixed > 20);
}

TEST_CASE("the same scene gives the same pixels") {
    if (!can_render()) return;
    const std::array scene{sphere({0, 0, 0.5}, 0.2, {0.2, 0.6, 0.3})};
    const display::View view = display::fit_view({-0.2, -0.2, 0}, {0.2, 0.2, 1}, {1, 1, -0.3});
    const display::Image once = display::render_picture(scene, view, 64, 64);
    CHECK(once.rgb == display::render_picture(scene, view, 64, 64).rgb);
}

TEST_CASE("malformed meshes and sizes are refused") {
    display::PictureMesh mesh = sphere({0, 0, 0.5}, 0.2, {0.2, 0.6, 0.3});
    CHECK_THROWS_AS(display::render_picture({}, display::View{}, 0, 10), Error);
    CHECK_THROWS_AS(display::render_picture({}, display::View{}, 10, 100000), Error);
    mesh.triangles.back() = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    CHECK_THROWS_WITH(display::render_picture({&mesh, 1}, display::View{}, 10, 10),
                      Catch::Matchers::ContainsSubstring("vertex"));
    mesh.triangles.clear();
    mesh.normals.pop_back();
    CHECK_THROWS_WITH(display::render_picture({&mesh, 1}, display::View{}, 10, 10),
                      Catch::Matchers::ContainsSubstring("normal"));
}

TEST_CASE("a PNG file appears whole or not at all") {
    const auto folder = std::filesystem::temp_directory_path() / "tactus_png_test";
    std::filesystem::create_directories(folder);
    const std::string path = (folder / "picture.png").string();
    display::write_png({2, 1, {255, 0, 0, 0, 255, 0}}, path);
    std::string signature(8, '\0');
    std::ifstream(path, std::ios::binary).read(signature.data(), 8);
    CHECK(signature == "\x89PNG\r\n\x1a\n");
    CHECK_FALSE(std::filesystem::exists(path + ".part"));
    CHECK_THROWS_AS(display::write_png({2, 1, {255, 0, 0, 0, 255, 0}}, (folder / "missing/picture.png").string()),
                    Error);
    std::filesystem::remove_all(folder);
}
