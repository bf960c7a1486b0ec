// SPDX-License-Identifier: Apache-2.0
// The picture of 'tactus info': what it shows of a bone.
#include "devices/display/read_png.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <cmath>
#include <string>

using namespace tactus;
using tactus::test::Folder;
using tactus::test::Outcome;

TEST_CASE("a picture of a long bone shows both of its ends") {
    const Folder folder;
    folder.write("long.stl", test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(8.0, 8.0, 280.0)));
    const auto png = folder.path / "long.png";
    const Outcome done = folder.tactus("info " + (folder.path / "long.stl").string() + " -o " + png.string());
    INFO(done.out << done.err);
    REQUIRE(done.code == 0);
    const display::Image image = display::read_png(png.string());
    constexpr int panel = 560;
    REQUIRE(image.width > 2 * panel);
    // Bone is yellowish, what is behind it bluish. The first panel is the view from the front.
    int first = panel, last = -1;
    for (int y = 0; y < panel - 60; ++y)  // above the name of the panel
        for (int x = panel / 3; x < 2 * panel / 3; ++x) {
            const std::uint8_t* p = image.pixel(x, y);
            if (p[0] > p[2] + 10) first = std::min(first, y), last = std::max(last, y);
        }
    CHECK(first > 5);
    CHECK(first < 60);
    CHECK(last > panel - 80);
    const auto is_bone = [&](int y) {
        for (int x = panel / 3; x < 2 * panel / 3; ++x)
            if (const std::uint8_t* p = image.pixel(x, y); p[0] > p[2] + 10) return true;
        return false;
    };
    CHECK_FALSE(is_bone(panel - 3));
}

TEST_CASE("a picture of a painted bone shows its paint and says how much there is") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    folder.write("box.stl", test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(20.0, 20.0, 20.0)));
    // The middle of the face that looks to the back, which is on the far side of the view from the front left.
    folder.write("paint.json", R"({"radius_mm": 6, "paint": [[10, 20, 10]]})");
    REQUIRE(folder
                .tactus("fracture-surface " + file("box.stl") + " --paint " + file("paint.json") + " -o " +
                        file("painted.vdb"))
                .code == 0);
    const Outcome info = folder.tactus("info " + file("painted.vdb") + " -o " + file("painted.png"));
    INFO(info.out << info.err);
    REQUIRE(info.code == 0);
    // pi 6² = 113 mm², in points of about a square millimetre.
    const std::size_t end = info.out.find(" mm² painted as fracture");
    REQUIRE(end != std::string::npos);
    CHECK(std::abs(std::stod(info.out.substr(info.out.rfind(' ', end - 1))) - 113.0) < 12.0);
    const display::Image image = display::read_png(file("painted.png"));
    int red = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* p = image.pixel(x, y);
            red += p[0] > 2 * p[2] && p[0] > 2 * p[1] ? 1 : 0;
        }
    CHECK(red > 2000);
}
