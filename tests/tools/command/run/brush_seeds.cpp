// SPDX-License-Identifier: Apache-2.0
// The patch of the guide that paints fragments by feel: seeds like the mouse's, and no energy for the hand.
#include "assets/segmentation/seeds_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/paint/painting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

using namespace tactus;
using test::Folder;

namespace {

/// The patch of docs/how-to/segment.md with a bone and a hand of the test, and with records.
std::string patch_of_guide() {
    const std::string page = test::slurp(test::source_folder() / "docs/how-to/segment.md");
    const std::size_t begin = page.find("```toml\n") + 8;
    std::string text = page.substr(begin, page.find("```", begin) - begin);
    const auto replace = [&](const std::string& what, const std::string& with) {
        const std::size_t at = text.find(what);
        REQUIRE(at != std::string::npos);
        text.replace(at, what.size(), with);
    };
    replace("\"pelvis.vdb\"", "\"" + (test::library_folder() / "bones/fragments.vdb#left").string() + "\"");
    replace("driver = \"mouse\"", R"(driver = "scripted"
targets = "0 s: 0 0 4 mm; 1 s: 0 0 -7 mm; 3 s: 6 0 -8 mm; 5 s: 6 6 -7 mm; 7 s: 0 0 -7 mm; 8 s: 0 0 4 mm; 9 s: 0 0 4 mm"
trigger_on = "1.5 s"
trigger_off = "6 s"
stiffness = "2 N/mm"
damping = "30 N s/m")");
    replace("origin = \"0 mm, 0 mm, 0 mm\"", "origin = \"4 mm, 0 mm, 0 mm\", rotation = \"0 deg, 90 deg, 0 deg\"");
    replace("\"felt.on_hand -> out.wrench\"", R"("felt.on_hand -> out.wrench",
  "finger.proxy -> tip.in", "hand.trigger -> pressed.in", "pressed.out -> trigger.in", "left.distance -> near.in",
  "out.applied -> force.in", "hand.pose -> pose.in")");
    return text + R"(pressed = { type = "to_number", rate = "1 kHz" }
tip = { type = "record", rate = "1 kHz", file = "tip.csv", unit = "m" }
trigger = { type = "record", rate = "1 kHz", file = "trigger.csv" }
near = { type = "record", rate = "1 kHz", file = "near.csv", unit = "m" }
force = { type = "record", rate = "1 kHz", file = "force.csv", unit = "N, N m" }
pose = { type = "record", rate = "1 kHz", file = "pose.csv", unit = "m" }
)";
}

/// The rows of a table, without the time.
std::vector<std::vector<double>> table(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        std::vector<double> row;
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
        rows.emplace_back(row.begin() + 1, row.end());
    }
    return rows;
}

}  // namespace

TEST_CASE("a hand that paints by feel makes the seeds that the mouse would make, and gets no energy", "[slow]") {
    const Folder folder;
    folder.write("paint.toml", patch_of_guide());
    const test::Outcome done =
        folder.tactus(fmt::format("render {0}/paint.toml --seconds 9 --out {0}/out", folder.path.string()));
    INFO(done.err);
    REQUIRE(done.code == 0);
    const auto felt = segmentation::read_seeds(folder.path / "out/seeds.json", segmentation::SeedsUse::draft);
    REQUIRE(felt.size() == 1);
    CHECK(felt[0].name == "left");
    REQUIRE_FALSE(felt[0].strokes.empty());
    std::size_t points = 0;
    for (const segmentation::Stroke& stroke : felt[0].strokes) points += stroke.points.size();
    CHECK(points > 8);

    // The same places with the mouse's painting.
    const auto tip = table(folder.path / "out/tip.csv"), trigger = table(folder.path / "out/trigger.csv"),
               near = table(folder.path / "out/near.csv");
    window::Painting painting(folder.path / "mouse.seeds.json", [](const segmentation::Stroke&) { return true; });
    for (std::size_t k = 0; k < tip.size(); ++k) {
        const Vec3 at(tip[k][0], tip[k][1], tip[k][2]);
        const bool paints = trigger[k][0] > 0.5 && near[k][0] <= 3e-3;
        if (!paints) painting.end();
        else if (painting.is_open()) painting.extend(at);
        else painting.begin(3e-3, at);
    }
    painting.end();
    segmentation::write_seeds(std::vector{segmentation::SeedLabel{"left", {}, painting.labels()[0].strokes}},
                              folder.path / "mouse.json");
    CHECK(test::slurp(folder.path / "mouse.json") == test::slurp(folder.path / "out/seeds.json"));

    // From free space to free space: the patch may not have done work on the hand.
    const auto force = table(folder.path / "out/force.csv"), pose = table(folder.path / "out/pose.csv");
    double work = 0.0, spent = 0.0, most = 0.0;
    for (std::size_t k = 1; k < force.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double done_now = force[k - 1][axis] * (pose[k][axis] - pose[k - 1][axis]);
            work += done_now;
            spent += std::abs(done_now);
            most = std::max(most, std::abs(force[k][axis]));
        }
    CAPTURE(work, spent);
    CHECK(most > 0.5);
    CHECK(most <= 3.0);
    CHECK(work < 0.01 * spent);
}
