// SPDX-License-Identifier: Apache-2.0
// A person with a mouse and a keyboard saws a jaw in the trainee's layout, and reads how it went.
#include "tests/support/catch.hpp"
#include "tests/tools/view/person.hpp"

#include <fstream>
#include <future>
#include <sstream>

using namespace tactus::test;
using nlohmann::json;

TEST_CASE("a person with a mouse saws through the jaw and reads the summary in the window", "[display]") {
    NEEDS_DISPLAY(display)
    Person person(display);
    if (!person.is_there()) return skip("libXtst is not installed (apt install libxtst6)");
    const Folder folder;
    folder.write("script", R"(size 1200 800
layout train
from front
until 45
screenshot sawing.png
until over
wait 3
spots spots.txt
screenshot over.png
close
)");
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder,
                  "run saw-training --view --view-script script --set hand.device=mouse --audio none --out out "
                  "--seconds 90 --json",
                  150);
    });
    REQUIRE(person.sees_window("Saw training", 30.0));
    Person::wait(6.0);
    person.key("t", true);
    // Down through the bone, in the middle of the scene's picture.
    person.drag(420.0, 300.0, 420.0, 640.0, 70.0);
    person.key("t", false);
    const Outcome outcome = done.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    INFO(outcome.out);
    const json summary = json::parse(outcome.out);
    CHECK(summary["carve"]["removed_mm3"].get<double>() > 100.0);
    CHECK(summary["carve"]["severed"].get<double>() == 1.0);
    check_picture(folder.path / "over.png", 1200, 800);
    const std::string spots = slurp(folder.path / "spots.txt");
    CHECK(spots.find("score\t") != std::string::npos);
    CHECK(spots.find("again\t") != std::string::npos);
}
