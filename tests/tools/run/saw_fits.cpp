// SPDX-License-Identifier: Apache-2.0
// A blade's size stands in several places: where they differ, the run says so before it starts.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <string>

using namespace tactus;

namespace {

std::string refusal(const test::Folder& folder, const std::string& arguments) {
    const test::Outcome outcome =
        folder.tactus("render " + arguments + " --seconds 0.05 --overwrite -o " + (folder.path / "out").string());
    CAPTURE(arguments, outcome.out);
    CHECK(outcome.code == (outcome.err.empty() ? 0 : 2));
    return outcome.err;
}

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

}  // namespace

TEST_CASE("a kerf wider than what carve removes, and a stroke that differs, are refused") {
    const test::Folder folder;
    CHECK(says(refusal(folder, "burr-training --set burr.diameter='6 mm'"), "set carve.kerf to 6 mm"));
    CHECK(says(refusal(folder, "saw-training --set blade.kerf='1.5 mm'"), "'carve' removes a kerf of 1 mm"));
    CHECK(says(refusal(folder, "saw-training --set blade.stroke='4 mm'"), "'heat' has a stroke of 3 mm"));
    CHECK(refusal(folder, "burr-training --set burr.diameter='6 mm' --set carve.kerf='6 mm'").empty());
    CHECK(refusal(folder, "saw-training --set blade.stroke='4 mm' --set heat.stroke='4 mm'").empty());
}

TEST_CASE("a task for another blade is refused, with both sizes") {
    const test::Folder folder;
    CHECK(refusal(folder, "saw-task").empty());
    for (const std::string size : {"length='30 mm'", "height='12 mm'", "kerf='0.9 mm'"}) {
        const std::string said = refusal(folder, "saw-task --set blade." + size);
        CAPTURE(size, said);
        CHECK(says(said, "but the task 'Buccal cut above the nerve' is for one of"));
        CHECK(says(said, "[blade] in "));
    }
}

TEST_CASE("a site is given in mm or with units") {
    const test::Folder folder;
    const auto place = [&](const std::string& site) {
        CHECK(refusal(folder, "saw-training --site " + site).empty());
        return test::slurp(folder.path / "out" / "pose.csv");
    };
    const std::string plain = place("12,3,4");
    CHECK(!plain.empty());
    CHECK(place("'12 mm, 3 mm, 4 mm'") == plain);
    CHECK(place("'1.2 cm,3,0.4cm' --approach '0,1,0'") != plain);
    const std::string along_x = place("12,3,4 --along 1,0,0");
    CHECK(along_x != place("12,3,4 --along 0,0,1"));
    CHECK(along_x == place("12,3,4 --along '2 mm,0,0'"));
    CHECK(says(refusal(folder, "saw-training --site 12,3,4 --approach 0,1,0 --along 0,-1,0"), "give one across it"));
    CHECK(says(refusal(folder, "saw-training --site 12,3,4 --along 0,0,0"), "--along 0,0,0 is no direction"));
    CHECK(says(refusal(folder, "saw-training --along 1,0,0"), "--site"));
    for (const std::string bad : {"'12 mm, 3 mm'", "'12 N, 3 mm, 4 mm'", "1,2,nan", "1,2,3,4", "','"})
        CHECK(says(refusal(folder, "saw-training --site " + bad), "give three numbers with commas"));
}

TEST_CASE("a recording of one's own saw is used in one step, and one that is none is questioned") {
    const test::Folder folder;
    const std::string sound = (test::library_folder() / "saw/cutting_190_7N.flac").string(),
                      out = (folder.path / "own").string();
    const auto render = [&](const std::string& words) {
        return folder.tactus("render saw-training --seconds 0.05 --overwrite --out " + out + " " + words);
    };
    const test::Outcome own = render("--saw " + sound + " --rate '190 Hz'");
    INFO(own.err);
    REQUIRE(own.code == 0);
    CHECK(own.err.find("the sound of a saw?") == std::string::npos);
    // The blade strokes at the rate that was given; a setting still wins.
    CHECK(own.out.find("'blade_rate'") == std::string::npos);
    CHECK(render("--saw " + sound + " --rate 190 --set 'saw.blade_rate=120 Hz'").out.find("is played at 120 Hz") !=
          std::string::npos);
    CHECK(render("--asset 'saw=" + sound + "#190 Hz'").code == 0);
    CHECK(render("--saw " + sound + " --rate 260").err.find("the sound of a saw?") != std::string::npos);
    CHECK(render("--saw " + sound + " --rate 3").code != 0);
    CHECK(says(render("--rate 190").err, "--saw"));
    CHECK(says(render("--saw nothing.wav").err, "nothing.wav"));
    const test::Outcome none = folder.tactus("render touch-sphere --seconds 0.05 --out " + out + "2 --saw " + sound);
    CHECK(none.code == 2);
    CHECK(says(none.err, "--saw needs a node of type saw"));
    // A take repeats with it.
    REQUIRE(render("--saw " + sound + " --rate 190 --record " + out + "-take").code == 0);
    CHECK(folder.tactus("replay " + out + "-take").code == 0);
}
