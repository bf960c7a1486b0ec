// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <filesystem>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using tactus::test::Folder;
using tactus::test::slurp;

namespace fs = std::filesystem;

TEST_CASE("new copies an example of the gallery, byte by byte") {
    const Folder folder;
    const auto made = folder.tactus("new " + folder.path.string() + "/own --from virtual-wall");
    INFO(made.err);
    CHECK(made.code == 0);
    CHECK_THAT(made.out, ContainsSubstring("own.toml: a copy of virtual-wall"));
    CHECK(slurp(folder.path / "own.toml") ==
          slurp(tactus::test::source_folder() / "docs/how-to/patches/virtual-wall.toml"));
    CHECK(
        folder
            .tactus("render " + folder.path.string() + "/own.toml --seconds 0.1 --out " + folder.path.string() + "/out")
            .code == 0);
}

TEST_CASE("a copy of a patch of the library finds its bones, cases and parts") {
    for (const char* name : {"fragments", "planning-trauma", "saw-vibration"}) {
        const Folder folder;
        const std::string file = folder.path.string() + "/own.toml";
        const auto made = folder.tactus("new " + file + " --from " + name), checked = folder.tactus("check " + file);
        CAPTURE(name, made.err, checked.err);
        CHECK(made.code == 0);
        CHECK(checked.code == 0);
    }
}

TEST_CASE("new never overwrites, and says what is wrong") {
    const Folder folder;
    const std::string at = folder.path.string();
    REQUIRE(folder.tactus("new " + at + "/own.toml --from echo").code == 0);
    const std::string before = slurp(folder.path / "own.toml");
    const auto again = folder.tactus("new " + at + "/own --from honey");
    CHECK(again.code == 2);
    CHECK_THAT(again.err, ContainsSubstring("never overwritten"));
    CHECK(slurp(folder.path / "own.toml") == before);
    const auto wrong = folder.tactus("new " + at + "/b --from virtual-wal");
    CHECK(wrong.code == 2);
    CHECK_THAT(wrong.err, ContainsSubstring("no example 'virtual-wal'"));
    CHECK_THAT(wrong.err, ContainsSubstring("did you mean 'virtual-wall'"));
    CHECK_FALSE(fs::exists(folder.path / "b.toml"));
    CHECK(folder.tactus("new " + at + "/b").code == 2);
    CHECK(folder.tactus("new " + at + "/none/b --from echo").code == 2);
    CHECK(folder.tactus("new " + at + "/ --from echo").code == 2);
}

TEST_CASE("help and completions of new name the examples") {
    const Folder folder;
    CHECK_THAT(folder.tactus("new --help").out, ContainsSubstring("virtual-wall"));
    for (const char* shell : {"bash", "zsh", "fish"}) {
        REQUIRE(folder.tactus(std::string("generate ") + shell + " " + folder.path.string() + "/" + shell).code == 0);
        for (const auto& entry : fs::directory_iterator(folder.path / shell))
            CHECK_THAT(slurp(entry.path()), ContainsSubstring("detent-dial"));
    }
}
