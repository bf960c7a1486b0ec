// SPDX-License-Identifier: Apache-2.0
// The force on the hand as a tone.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/workbench.hpp"

#include <filesystem>

using namespace tactus;
using namespace tactus::window;
using tactus::test::Folder;
namespace fs = std::filesystem;

TEST_CASE("the force of each library patch with a hand is heard by one edit and undo leads back to the first byte") {
    int heard = 0;
    for (const auto& entry : fs::directory_iterator(test::library_folder() / "patches")) {
        if (entry.path().extension() != ".toml") continue;
        run::RunChoice choice;
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
    run::RunChoice choice;
    choice.patch = folder.write("p.toml", "[nodes.go]\ntype = \"clock\"\nrate = \"48 kHz\"\n").string();
    Workbench bench(choice);
    CHECK_FALSE(bench.can_hear_force());
    CHECK_FALSE(bench.hear_force(true));
}

TEST_CASE("a tone that feeds an output twice goes with it, and an output that plays something else stays") {
    const Folder folder;
    folder.write("both.toml",
                 "[inputs]\nleft = \"left.signal\"\nright = \"right.signal\"\n[nodes.left]\ntype = \"audio_output\"\n"
                 "rate = \"48 kHz\"\n[nodes.right]\ntype = \"audio_output\"\nrate = \"48 kHz\"\n");
    const auto with_tone = [](const std::string& right) {
        std::string text = test::touch;
        text.insert(text.find("]\n[nodes.hand]"),
                    "  \"out.applied -> force_tone.wrench\",\n  \"force_tone.signal -> "
                    "force_sound.left\",\n  \"" +
                        right + " -> force_sound.right\",\n");
        return text +
               "[nodes.force_tone]\ntype = \"force_tone\"\nrate = \"48 kHz\"\n[nodes.force_sound]\ntype = "
               "\"patch:both.toml\"\n";
    };
    run::RunChoice choice;
    choice.patch = folder.write("twice.toml", with_tone("force_tone.signal")).string();
    Workbench twice(choice);
    REQUIRE(twice.plan());
    REQUIRE(twice.hears_force());
    REQUIRE(twice.hear_force(false));
    CHECK(twice.editor().text().find("force_") == std::string::npos);
    CHECK(twice.plan());

    choice.patch = folder.write("other.toml", with_tone("loud.out")).string();
    Workbench other(choice);
    REQUIRE(other.plan());
    REQUIRE(other.hear_force(false));
    CHECK(other.editor().text().find("force_tone") == std::string::npos);
    CHECK(other.editor().text().find("loud.out -> force_sound.right") != std::string::npos);
}
