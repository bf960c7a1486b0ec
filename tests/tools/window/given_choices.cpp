// SPDX-License-Identifier: Apache-2.0
// What the command line gives in place of the text of a patch, when the window changes or saves that patch.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/workbench.hpp"

#include <cstdlib>
#include <filesystem>

using namespace tactus;
using namespace tactus::run;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::slurp;
namespace fs = std::filesystem;

namespace {

RunChoice choice_of(const std::string& patch) {
    ::setenv("TACTUS_LIBRARY", test::library_folder().c_str(), 1);
    RunChoice choice;
    choice.patch = patch;
    return choice;
}

}  // namespace

TEST_CASE("a cut takes the place of a site that the command line gave, also in a patch with another error", "[slow]") {
    const Folder folder;
    const auto site_of = [](const Workbench& bench) {
        for (const patch::PatchNode& node : bench.plan()->patch.nodes)
            for (const OptionText& setting : node.settings)
                if (node.name == "place" && setting.name == "site") return setting.text;
        return std::string();
    };
    RunChoice choice = choice_of("saw-training");
    choice.overrides.settings = {"place.site=1 mm, 2 mm, 3 mm", "place.clutch_force=1"};
    {
        // The second one is no parameter: the patch opens with that error, and can be edited.
        Workbench broken(choice);
        REQUIRE(broken.is_broken());
        CHECK(broken.cut_at(Vec3(0.01)));
        CHECK(broken.choice().overrides.settings == std::vector<std::string>{"place.clutch_force=1"});
        CHECK(broken.is_broken());
    }
    choice.overrides.settings = {"place.site=1 mm, 2 mm, 3 mm", "hand_out.max_force=5 N"};
    Workbench bench(choice);
    REQUIRE(bench.plan());
    CHECK(site_of(bench) == "1 mm, 2 mm, 3 mm");
    REQUIRE(bench.cut_at(Vec3(0.01, 0.02, 0.03)));
    CHECK(site_of(bench) == "10 mm, 20 mm, 30 mm");
    CHECK(bench.choice().overrides.settings == std::vector<std::string>{"hand_out.max_force=5 N"});

    // Saved and opened with another site on the command line: the text does not change, but what is shown does.
    REQUIRE(bench.save_as((folder.path / "cut.toml").string()));
    choice.patch = (folder.path / "cut.toml").string();
    choice.overrides.settings = {"place.site=1 mm, 2 mm, 3 mm"};
    Workbench again(choice);
    REQUIRE(again.plan());
    CHECK(site_of(again) == "1 mm, 2 mm, 3 mm");
    REQUIRE(again.cut_at(Vec3(0.01, 0.02, 0.03)));
    CHECK(site_of(again) == "10 mm, 20 mm, 30 mm");
}

TEST_CASE("a patch that was opened for a plan and saved under another name opens the same plan", "[slow]") {
    const Folder folder;
    // The case of a person: elsewhere than that of the library.
    const fs::path own = folder.path / "cases/jaw";
    fs::create_directories(own.parent_path());
    fs::copy(test::library_folder() / "cases/mandible-twelve", own, fs::copy_options::recursive);
    const auto plan_of = [](const Workbench& bench) {
        REQUIRE(bench.plan());
        for (const patch::PatchAsset& asset : bench.plan()->patch.assets)
            if (asset.name == "case") return fs::weakly_canonical(asset.path);
        return fs::path();
    };
    const fs::path plan = own / "case.plan.json", other = folder.path / "elsewhere";
    fs::create_directories(other);
    const auto save = [&](const fs::path& copy) {
        RunChoice choice = choice_of("planning-trauma");
        choice.overrides.assets = {"case=" + plan.string(), "script=" + (own / "hand.txt").string()};
        Workbench bench(choice);
        REQUIRE(plan_of(bench) == fs::weakly_canonical(plan));
        REQUIRE(bench.save_as(copy.string()));
        CHECK(plan_of(bench) == fs::weakly_canonical(plan));
        CHECK(bench.editor().is_saved());
        CHECK_NOTHROW(bench.check_saved());
        // What else the command line said holds for what was opened, and is not written.
        CHECK(bench.choice().overrides.assets == std::vector<std::string>{choice.overrides.assets[1]});
        const Workbench opened(choice_of(copy.string()));
        CHECK(plan_of(opened) == fs::weakly_canonical(plan));
    };
    save(folder.path / "near.toml");
    CHECK(slurp(folder.path / "near.toml").find("= \"cases/jaw/case.plan.json\"") != std::string::npos);
    save(other / "far.toml");
    CHECK(slurp(other / "far.toml").find("= \"" + plan.string() + "\"") != std::string::npos);
}
