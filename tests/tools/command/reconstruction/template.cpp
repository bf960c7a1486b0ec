// SPDX-License-Identifier: Apache-2.0
// tactus plan template on a synthetic case.
#include "assets/mesh/mesh.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

// Costly: a case is written and planned, and templates for its plate are made.
TEST_CASE("plan template writes a closed strip that lies on the planned bone, with a mark per screw", "[slow]") {
    const test::Folder folder;
    const auto file = [&](const char* name) { return (folder.path / name).string(); };
    const std::string plan = file("case.plan.json");
    REQUIRE(folder.tactus("flap -o " + file("flap")).code == 0);
    REQUIRE(folder.tactus("plan reconstruct " + plan + " " + file("flap/INPUTS.json")).code == 0);
    const auto made = [&](const std::string& more) {
        return folder.tactus("plan template " + plan + " --voxel 0.5 " + more);
    };
    REQUIRE(folder.tactus("plan plate " + plan + " bar").code == 0);
    const test::Outcome done = made("--plate bar --json -o " + file("bar.stl"));
    INFO(done.err);
    REQUIRE(done.code == 0);
    const json strip = json::parse(done.out);
    CHECK(test::broken_schema(folder, "plan-template", strip) == "");
    CHECK(strip["closed"] == true);
    CHECK(strip["parts"] == 1);
    CHECK(strip["bone_share"].get<double>() > 0.9);
    CHECK(strip["on_bone_share"].get<double>() > 0.9);
    CHECK(strip["marks"].size() >= 6);
    for (const json& mark : strip["marks"]) CHECK(mark["diameter_mm"].get<double>() == Approx(1.7));
    const mesh::Mesh stl = mesh::load_mesh(file("bar.stl"));
    CHECK(mesh::topology_of(stl).is_watertight());
    CHECK(stl.triangles.size() == strip["triangles"].get<std::size_t>());
    const std::string text = file("admesh.txt");
    if (std::system(("admesh " + file("bar.stl") + " >" + text + " 2>/dev/null").c_str()) == 0) {
        CHECK_THAT(test::slurp(text), ContainsSubstring("Number of parts       :     1"));
        CHECK_THAT(test::slurp(text), ContainsSubstring("Total disconnected facets        :     0 "));
    }
    const auto refused = [&](const std::string& more, const std::string& why) {
        const test::Outcome no = made(more);
        INFO(more);
        CHECK(no.code == 2);
        CHECK_THAT(no.err, ContainsSubstring(why));
    };
    refused("--plate other -o " + file("other.stl"), "no plate 'other'");
    refused("--plate bar -o " + file("bar.obj"), ".stl, .3mf, .ply");
    refused("--plate bar --thickness 30 -o " + file("thick.stl"), "bends with a radius");
    refused("--plate bar --clearance 0.5 -o " + file("thin.stl"), "dimples mark such holes");
    CHECK(!std::filesystem::exists(file("thin.stl")));
}
