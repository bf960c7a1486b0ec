// SPDX-License-Identifier: Apache-2.0
// A take that lies elsewhere than its patch.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/desk/take_bench.hpp"
#include "tools/window/document/workbench.hpp"

#include <filesystem>

using namespace tactus;
using namespace tactus::window;
using tactus::test::Folder;
namespace fs = std::filesystem;

TEST_CASE("a take opens with the files of its patch, whose relative paths start at the patch") {
    const Folder folder;
    fs::create_directories(folder.path / "patches");
    fs::create_directories(folder.path / "sounds");
    fs::create_directories(folder.path / "takes/monday");
    take::Take take;
    take.folder = folder.path / "takes/monday";
    take.about.patch_file = folder.path / "patches/mine.toml";
    take.text =
        "[assets]\nhit = \"../sounds/hit.wav\"\nown = \"../sounds/own.wav\"\n[nodes.tone]\n"
        "type = \"sine\"\nrate = \"48 kHz\"\n";
    take.about.overrides.assets = {"own=/given.wav"};
    folder.write("takes/monday/patch-0.toml", take.text);
    const run::RunChoice choice = choice_of(take);
    // A file that was given on the command line stays.
    CHECK(choice.overrides.assets ==
          std::vector<std::string>{"own=/given.wav", "hit=" + (folder.path / "sounds/hit.wav").string()});
    const Workbench bench(choice);
    REQUIRE_FALSE(bench.is_broken());
    CHECK(bench.plan()->patch.assets.front().path == folder.path / "sounds/hit.wav");
}
