// SPDX-License-Identifier: Apache-2.0
// The painting window, by script and by a person with a mouse.
#include "assets/segmentation/seeds_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/person.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <future>

using namespace tactus;
using namespace tactus::test;
using nlohmann::json;

namespace {

/// A plate of bone, 90 x 90 x 12 mm, in two halves with a gap of two voxels; a vessel of 400 HU in front of it.
void write_scan(const std::filesystem::path& path) {
    volume::Grid grid{{100, 60, 100}, Vec3(0.0), Vec3(1e-3), {}};
    for (int k = 0; k < 100; ++k)
        for (int j = 0; j < 60; ++j)
            for (int i = 0; i < 100; ++i) {
                const bool is_plate = i >= 5 && i < 95 && k >= 5 && k < 95 && j >= 20 && j < 32;
                const bool is_vessel = std::hypot(i - 50.0, j - 46.0) < 3.0;
                const bool is_air = j < 4;
                grid.values.push_back(is_plate && i != 50 && i != 51 ? 800.0f
                                      : is_vessel                    ? 400.0f
                                      : is_air                       ? -1000.0f
                                                                     : 40.0f);
            }
    volume::write_volume(grid, volume::WrittenType::int16, path);
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a script paints, undoes, follows a vessel, makes a plan, and the labels are written", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    write_scan(folder.path / "ct.nrrd");
    folder.write("script", R"(size 1000 700
label left
brush 4
stroke 25 26 50  25 26 70
label right
stroke 75 26 50
stroke 75 26 80
undo
remove "fragment_1"
remove "fragment_2"
until solved
vessel 50 46 30
until solved
from back
frames 10
tool vessel
click_bone 50 46 60
until solved
from front
frames 10
click_bone 62 46 60
tool paint
plan
until solved
cursor 48 26 50
screenshot picture.png
close
)");
    const Outcome done =
        on(display, folder,
           "segment ct.nrrd --threshold 600 --paint case.seeds.json --view-script script -o labels.nrrd --json");
    INFO(done.err << done.out);
    REQUIRE(done.code == 0);
    const json found = json::parse(done.out);
    REQUIRE(found["labels"].size() == 2);
    CHECK(found["labels"][0]["name"] == "left");
    CHECK(found["labels"][0]["voxels"] == 45 * 90 * 12);
    CHECK(found["labels"][1]["voxels"] == 43 * 90 * 12);
    const auto seeds = segmentation::read_seeds(folder.path / "case.seeds.json");
    REQUIRE(seeds.size() == 2);
    CHECK(seeds[0].strokes[0].points.size() == 2);
    CHECK(seeds[1].strokes.size() == 1);
    CHECK(slurp(folder.path / "case-vessel-1.csv").starts_with("branch,x_mm"));
    // A click in the picture of the bone from behind, where the vessel lies before it; from the front bone lies before it.
    CHECK(slurp(folder.path / "case-vessel-2.csv").starts_with("branch,x_mm"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "case-vessel-3.csv"));
    CHECK(std::filesystem::exists(folder.path / "case.plan.json"));
    const Picture picture = read_picture(folder.path / "picture.png");
    CHECK(picture.width == 1000);
    CHECK(picture.colours() > 300);
    // Without the window: the same labels from the same strokes.
    const Outcome again =
        on(display, folder, "segment ct.nrrd --threshold 600 --seeds case.seeds.json -o again.nrrd --json");
    REQUIRE(again.code == 0);
    CHECK(json::parse(again.out)["labels"] == found["labels"]);
    CHECK(slurp(folder.path / "again.nrrd") == slurp(folder.path / "labels.nrrd"));
}

TEST_CASE("a person paints two fragments with the mouse, and undoes a stroke with the keyboard", "[display]") {
    NEEDS_DISPLAY(display)
    Person person(display);
    if (!person.is_there()) {
        tactus::test::skip("libXtst is not installed (apt install libxtst6)");
        return;
    }
    const Folder folder;
    write_scan(folder.path / "ct.nrrd");
    folder.write("script", "size 1000 700\nuntil there finished\nuntil solved\nscreenshot picture.png\nclose\n");
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder, "segment ct.nrrd --threshold 600 --paint seeds.json --view-script script");
    });
    REQUIRE(person.sees_window("ct.nrrd - Tactus", 30.0));
    Person::wait(2.0);
    const auto strokes = [&] {
        std::vector<std::size_t> count;
        if (!std::filesystem::exists(folder.path / "seeds.json")) return count;
        for (const auto& label : segmentation::read_seeds(folder.path / "seeds.json", segmentation::SeedsUse::draft))
            count.push_back(label.strokes.size());
        return count;
    };
    const auto until = [&](const std::vector<std::size_t>& wanted) {
        for (int n = 0; n < 100 && strokes() != wanted; ++n) Person::wait(0.1);
        return strokes() == wanted;
    };
    // The axial slice is the panel on the upper left, its middle at 184, 171.
    person.drag(100.0, 171.0, 130.0, 171.0, 0.5);
    CHECK(until({1, 0}));
    person.tap("2");
    person.click(250.0, 171.0);
    CHECK(until({1, 1}));
    person.click(250.0, 160.0);
    CHECK(until({1, 2}));
    person.key("Control_L", true);
    person.tap("z");
    person.key("Control_L", false);
    CHECK(until({1, 1}));
    // Killed at any moment, nothing but an open stroke is lost: the file is whole already.
    const auto seeds = segmentation::read_seeds(folder.path / "seeds.json");
    CHECK(seeds[0].strokes[0].points.front().x < 0.05);
    CHECK(seeds[1].strokes[0].points.front().x > 0.05);
    for (const auto& label : seeds)
        for (const Vec3& p : label.strokes[0].points) CHECK(std::abs(p.y - 26e-3) < 8e-3);
    folder.write("finished", "");
    const Outcome outcome = done.get();
    INFO(outcome.err << outcome.out);
    CHECK(outcome.code == 0);
    CHECK(outcome.out.find("strokes of 2 fragments") != std::string::npos);
    const Picture picture = read_picture(folder.path / "picture.png");
    CHECK(picture.width == 1000);
}
