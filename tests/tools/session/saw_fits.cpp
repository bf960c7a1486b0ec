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
    for (const std::string bad : {"'12 mm, 3 mm'", "'12 N, 3 mm, 4 mm'", "1,2,nan", "1,2,3,4", "','"})
        CHECK(says(refusal(folder, "saw-training --site " + bad), "give three numbers with commas"));
}
