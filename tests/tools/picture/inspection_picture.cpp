// SPDX-License-Identifier: Apache-2.0
// The picture of 'tactus info': what it shows of a bone.
#include "devices/display/read_png.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>

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
