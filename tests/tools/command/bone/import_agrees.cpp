// SPDX-License-Identifier: Apache-2.0
// What `info` says about a file is what `import` does with it; parts of bones go out.
#include "assets/bone/bone.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/analysis/bone/saw_spacing.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <cstdlib>

using namespace tactus;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

json answer(const Folder& folder, const std::string& arguments) {
    const Outcome done = folder.tactus(arguments);
    INFO(arguments << "\n" << done.err);
    REQUIRE(done.code == 0);
    return json::parse(done.out);
}

// A masked ball of 20 mm with a rim of 900 HU and a core of 220 HU.
volume::Grid masked_ball() {
    volume::Grid grid{{60, 60, 60}, Vec3(-29.5e-3), Vec3(1e-3), {}};
    for (int k = 0; k < 60; ++k)
        for (int j = 0; j < 60; ++j)
            for (int i = 0; i < 60; ++i) {
                const double depth = 20e-3 - glm::length(grid.position(i, j, k));
                grid.values.push_back(depth < 0.0 ? 0.0f : depth < 2e-3 ? 900.0f : 220.0f);
            }
    return grid;
}

std::string box_obj(double x) {
    std::string text;
    for (int n = 0; n < 8; ++n)
        text += fmt::format("v {} {} {}\n", n & 1 ? x : 0.0, n & 2 ? 0.4 * x : 0.0, n & 4 ? 0.3 * x : 0.0);
    return text +
           "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 "
           "6\n";
}

}  // namespace

TEST_CASE("import takes the threshold that info suggests, keeps the volume that info lists, and says both") {
    const Folder folder;
    const std::string ct = (folder.path / "ct.nrrd").string(), out = (folder.path / "bone.vdb").string();
    volume::write_volume(masked_ball(), volume::WrittenType::int16, ct);
    const json info = answer(folder, "info " + ct + " --json"),
               made = answer(folder, "import " + ct + " --json -o " + out);
    CHECK(made["threshold"]["hu"] == info["suggested_threshold"]);
    CHECK(made["threshold"]["kept_mm3"].get<double>() ==
          Approx(info["components"][0]["volume_mm3"].get<double>()).epsilon(1e-9));
    CHECK(made["hu"] == info["hu"]);
    const std::string said = folder.tactus("import " + ct + " -o " + out).out;
    CHECK_THAT(said, ContainsSubstring(fmt::format("  {:g} HU (suggested", info["suggested_threshold"].get<double>())));
    CHECK_THAT(said, ContainsSubstring("the mask of the scan holds"));
    // One word for one thing: the HU are calibrated or masked, the density is never.
    CHECK_THAT(said, !ContainsSubstring("uncalibrated"));
    CHECK_THAT(folder.tactus("info " + out).out, !ContainsSubstring("uncalibrated"));
}

TEST_CASE("info suggests and import uses one threshold for every published CT", "[slow]") {
    const char* shared = std::getenv("TACTUS_SHARED_DATA");
    if (!shared) {
        skip("TACTUS_SHARED_DATA is not set");
        return;
    }
    const Folder folder;
    for (const char* name : {"fragments/sacrum003_ct.nrrd", "ct/skull_saw_kerf_block.nrrd", "ct/headsq_quarter.nrrd"}) {
        CAPTURE(name);
        const std::string file = (fs::path(shared) / name).string(),
                          scale = std::string(name).find("quarter") == std::string::npos
                                      ? ""
                                      : " --hu-calibration 60:-1000,1084:0";
        const json info = answer(folder, "info " + file + " --json" + scale),
                   made = answer(folder, "import " + file + scale + " --json -o " + (folder.path / "x.vdb").string());
        CHECK(made["threshold"]["hu"] == info["suggested_threshold"]);
        CHECK(made["hu"] == info["hu"]);
        CHECK(made["threshold"]["kept_mm3"].get<double>() ==
              Approx(info["components"][0]["volume_mm3"].get<double>()).epsilon(0.02));
    }
}

TEST_CASE("info asks for the unit where import does, and takes it") {
    const Folder folder;
    const std::string file = (folder.path / "skull.obj").string();
    file::write_whole_file(file, box_obj(13.9));
    const json asked = answer(folder, "info " + file + " --json");
    CHECK(asked["unit"].is_null());
    CHECK_THAT(asked["unit_question"].get<std::string>(), ContainsSubstring("--unit cm makes it 139 mm"));
    CHECK_THAT(folder.tactus("info " + file).out, ContainsSubstring("--unit cm makes it 139 mm"));
    const Outcome refused = folder.tactus("import " + file + " -o " + (folder.path / "x.vdb").string());
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, ContainsSubstring("--unit cm makes it 139 mm"));
    const json told = answer(folder, "info " + file + " --unit cm --json");
    CHECK(told["unit"] == "cm");
    CHECK(told["unit_question"].is_null());
    CHECK(told["components"][0]["bounds_mm"][0][1].get<double>() == Approx(139.0));
}

// Costly: whole scans are imported.
TEST_CASE("import says which saw can cut the bone, and carving agrees", "[slow]") {
    const Folder folder;
    const std::string mesh = (folder.path / "jaw.stl").string(), bone = (folder.path / "jaw.vdb").string();
    const fs::path jaw = tactus::test::library_folder() / "bones/mandible.vdb";
    REQUIRE(folder.tactus("export " + jaw.string() + " -o " + mesh).code == 0);
    const double fine = analysis::coarsest_spacing_mm(analysis::usual_kerf_mm);
    const std::string check = "render saw-training --seconds 0.02 --out " + (folder.path / "run").string() +
                              " --overwrite --asset bone=" + bone;
    CHECK_THAT(folder.tactus("import " + mesh + " --spacing " + fmt::format("{}", fine) + " -o " + bone).out,
               ContainsSubstring("a saw can cut it"));
    const auto refined = [&] {
        const Outcome done = folder.tactus(check + " --json");
        REQUIRE(done.code == 0);
        return json::parse(done.out)["carve"]["refined"].get<double>();
    };
    CHECK(refined() == 0.0);
    const std::string proposal = fmt::format("needs --spacing {:g} or finer", fine);
    CHECK_THAT(folder.tactus("info " + bone).out, ContainsSubstring("a saw can cut it"));
    CHECK_THAT(folder.tactus("import " + mesh + " --spacing 0.4 -o " + bone).out, ContainsSubstring(proposal));
    CHECK_THAT(folder.tactus("info " + bone).out, ContainsSubstring(proposal));
    CHECK_THAT(slurp(source_folder() / "docs/tutorial/own-ct-and-saw.md"),
               ContainsSubstring(fmt::format("--spacing {:g}\n", fine)));
    CHECK(refined() == 1.0);
}

TEST_CASE("info prints a volume in a unit in which it is neither zero nor long") {
    const Folder folder;
    const std::string file = (folder.path / "box.obj").string();
    // The box is 0.12 of the cube of its length.
    for (const auto& [length, text] :
         {std::pair{200.0, "960.0 cm³"}, {20.0, "960 mm³"}, {1.0, "0.12 mm³"}, {0.05, "15000 µm³"}}) {
        file::write_whole_file(file, box_obj(length));
        CHECK_THAT(folder.tactus("info " + file + " --unit mm").out, ContainsSubstring(text));
    }
}

TEST_CASE("a mesh is given one density from the command line, a scan refuses it") {
    const Folder folder;
    const std::string file = (folder.path / "box.obj").string(), out = (folder.path / "x.vdb").string();
    file::write_whole_file(file, box_obj(60.0));
    const json made = answer(folder, "import " + file + " --density 1100 --spacing 1 --json -o " + out);
    CHECK(made["density"]["min"].get<double>() == Approx(1100.0));
    CHECK(made["density"]["max"].get<double>() == Approx(1100.0));
    const std::string ct = (folder.path / "ct.nrrd").string();
    volume::write_volume(masked_ball(), volume::WrittenType::int16, ct);
    CHECK(folder.tactus("import " + ct + " --density 1100 -o " + out).code == 2);
}

TEST_CASE("export leaves all but a box, or all but the surroundings of a cut") {
    const Folder folder;
    bone::Bone whole;
    whole.name = "ball";
    whole.distance = volume::Grid{{61, 61, 61}, Vec3(-30e-3), Vec3(1e-3), {}};
    for (int k = 0; k < 61; ++k)
        for (int j = 0; j < 61; ++j)
            for (int i = 0; i < 61; ++i)
                whole.distance.values.push_back(
                    static_cast<float>(glm::length(whole.distance.position(i, j, k)) - 20e-3));
    whole.density = whole.distance;
    for (float& density : whole.density.values) density = density < 0.0f ? 1800.0f : 0.0f;
    bone::Bone cut = whole;
    // A slot of 4 mm from the top to z = 10 mm.
    for (int k = 40; k < 61; ++k)
        for (int j = 0; j < 61; ++j)
            for (int i = 28; i <= 32; ++i) cut.distance.at(i, j, k) = std::max(cut.distance.at(i, j, k), 0.5e-3f);
    const std::string before = (folder.path / "whole.vdb").string(), after = (folder.path / "cut.vdb").string();
    bone::save_bone(whole, before);
    bone::save_bone(cut, after);
    const auto bounds = [&](const std::string& options) {
        const std::string part = (folder.path / "part.stl").string();
        REQUIRE(folder.tactus("export " + after + " -o " + part + " " + options).code == 0);
        return answer(folder, "info " + part + " --json")["components"][0]["bounds_mm"];
    };
    const json all = bounds(""), near = bounds("--cut-of " + before), box = bounds("--crop -5:5,-30:30,-30:0");
    CHECK(all[2][0].get<double>() == Approx(-20.0).margin(0.3));
    // 5 mm below the floor of the slot, 5 mm beside its walls.
    CHECK(near[2][0].get<double>() == Approx(5.0).margin(1.1));
    CHECK(near[0][0].get<double>() == Approx(-7.0).margin(1.1));
    CHECK(near[0][1].get<double>() < 8.1);
    CHECK(box[0][1].get<double>() == Approx(5.0).margin(1.1));
    CHECK(box[2][1].get<double>() == Approx(0.0).margin(1.1));
    const std::string nothing = "export " + before + " -o " + (folder.path / "no.stl").string();
    CHECK(folder.tactus(nothing + " --cut-of " + before).code == 2);
    CHECK(folder.tactus(nothing + " --crop 50:60,50:60,50:60").code == 2);
    CHECK(folder.tactus(nothing + " --crop 1:2").code == 2);
    CHECK_FALSE(fs::exists(folder.path / "no.stl"));
}
