// SPDX-License-Identifier: Apache-2.0
// The force on the hand as a tone.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/view/workbench.hpp"

#include <filesystem>

using namespace tactus;
using namespace tactus::view;
using tactus::test::Folder;
namespace fs = std::filesystem;

TEST_CASE("the force of each library patch with a hand is heard by one edit and undo leads back to the first byte") {
    int heard = 0;
    for (const auto& entry : fs::directory_iterator(test::library_folder() / "patches")) {
        if (entry.path().extension() != ".toml") continue;
        session::RunChoice choice;
        choice.patch = entry.path().string();
        Workbench bench(choice);
        INFO(choice.patch);
        if (!bench.can_hear_force()) continue;
        const std::string before = bench.editor().text();
        CHECK_FALSE(bench.hears_force());
        REQUIRE(bench.hear_force(true));
        INFO(bench.messages().back().text);
        CHECK_FALSE(bench.is_broken());
        CHECK(bench.hears_force());
        CHECK(bench.unfinished().empty());
        REQUIRE(bench.plan());
        REQUIRE(bench.hear_force(false));
        CHECK_FALSE(bench.hears_force());
        REQUIRE(bench.undo());
        REQUIRE(bench.undo());
        CHECK(bench.editor().text() == before);
        ++heard;
    }
    CHECK(heard >= 10);
}

TEST_CASE("a patch without a hand has no force to hear") {
    const Folder folder;
    session::RunChoice choice;
    choice.patch = folder.write("p.toml", "[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n").string();
    Workbench bench(choice);
    CHECK_FALSE(bench.can_hear_force());
    CHECK_FALSE(bench.hear_force(true));
}
