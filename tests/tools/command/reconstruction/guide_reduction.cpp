// SPDX-License-Identifier: Apache-2.0
// tactus plan guide on the fragments of a broken jaw.
#include "assets/mesh/mesh.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

/// A part of the bundled jaw in three fragments in their places; 03 lies between 01 and 02.
struct BrokenJaw {
    test::Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    BrokenJaw() {
        const std::string jaw = (test::library_folder() / "bones/mandible.vdb").string(),
                          to = (folder.path / "case").string();
        REQUIRE(folder.tactus("fracture " + jaw + " -o " + to + " --pieces 3 --seed 5 --spread 0 --turn 0").code == 0);
        REQUIRE(folder
                    .tactus("plan new " + plan + " " + to + "/fragment_01.vdb " + to + "/fragment_02.vdb " + to +
                            "/fragment_03.vdb")
                    .code == 0);
    }
    test::Outcome guide(const std::string& more) const {
        return folder.tactus("plan guide " + plan + " --bone reduction --voxel 0.5 -o " +
                             (folder.path / "guide.stl").string() + " " + more);
    }
    void move(const std::string& fragment, const std::string& pose) const {
        REQUIRE(folder.tactus("plan move " + plan + " " + fragment + " --pose " + pose).code == 0);
    }
    bool has_guide() const { return std::filesystem::exists(folder.path / "guide.stl"); }
};

}  // namespace

// Costly: a jaw is broken, and a guide for it is made.
TEST_CASE("plan guide holds the fragments of a reduction together, with a region and a screw on each", "[slow]") {
    const BrokenJaw jaw;
    const test::Outcome done = jaw.guide("--turn 30 --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    const json guide = json::parse(done.out);
    CHECK(test::broken_schema(jaw.folder, "plan-guide", guide) == "");
    CHECK(guide["bone"] == "reduction");
    CHECK(guide["closed"] == true);
    CHECK(guide["parts"] == 1);
    CHECK(guide["slots"].empty());
    CHECK(guide["seating"]["free"] == true);
    CHECK(guide["contact_share"].get<double>() > 0.5);
    REQUIRE(guide["fragments"].size() == 3);
    // In the order along the bone.
    CHECK(guide["fragments"][1]["name"] == "fragment_03");
    for (const json& fragment : guide["fragments"]) {
        CHECK(fragment["contact_mm2"].get<double>() > 50.0);
        CHECK(fragment["holes"].get<int>() >= 1);
    }
    REQUIRE(guide["fractures"].size() == 2);
    for (const json& fracture : guide["fractures"]) CHECK(std::abs(fracture["gap_mm"].get<double>()) < 0.2);
    const mesh::Mesh stl = mesh::load_mesh(jaw.folder.path / "guide.stl");
    CHECK(mesh::topology_of(stl).is_watertight());
    CHECK(mesh::topology_of(stl).components == 1);
    const std::string text = (jaw.folder.path / "admesh.txt").string();
    if (std::system(("admesh " + (jaw.folder.path / "guide.stl").string() + " >" + text + " 2>/dev/null").c_str()) != 0)
        return;
    const std::string said = test::slurp(text);
    CHECK_THAT(said, ContainsSubstring("Number of parts       :     1"));
    CHECK_THAT(said, ContainsSubstring("Degenerate facets     :     0"));
    CHECK_THAT(said, ContainsSubstring("Facets reversed       :     0"));
    CHECK_THAT(said, ContainsSubstring("Total disconnected facets        :     0 "));
}

// Costly: a jaw is broken, and its fragments are loaded for each refusal.
TEST_CASE("a guide for fragments that it cannot hold is refused with the fragment and the value", "[slow]") {
    const BrokenJaw jaw;
    const auto refused = [&](const std::string& more, const std::string& why) {
        const test::Outcome done = jaw.guide(more);
        INFO(more);
        CHECK(done.code == 2);
        CHECK_THAT(done.err, ContainsSubstring(why));
        CHECK(!jaw.has_guide());
    };
    refused("--fragments fragment_01", "two fragments or more");
    refused("--fragments fragment_01 fragment_01", "named twice");
    refused("--fragments fragment_01 fragment_02", "'fragment_02' meets none of those");
    refused("--fragments fragment_01 fragment_03 --task saw.toml", "no slot to saw in");
    refused("--fragments fragment_01 fragment_03 --blade 0.5", "--blade");
    refused("--fragments fragment_01 fragment_03 --turn 30 --min-region 3000", "less than 3e+03 mm²");
    refused("--fragments fragment_01 fragment_03 --turn 30 --screw 6 --end 4", "no hole for a screw");
    const test::Outcome other = jaw.folder.tactus("plan guide " + jaw.plan + " --bone jaw --fragments fragment_01 -o " +
                                                  (jaw.folder.path / "guide.stl").string());
    CHECK_THAT(other.err, ContainsSubstring("--bone reduction"));
    // The fracture is across x.
    jaw.move("fragment_01", "-2.6,0,0,1,0,0,0");
    refused("--fragments fragment_01 fragment_03", "mm apart where the plan has them, more than 2 mm");
    jaw.move("fragment_01", "2,0,0,1,0,0,0");
    refused("--fragments fragment_01 fragment_03", "overlap by");
    REQUIRE(jaw.folder.tactus("plan hide " + jaw.plan + " fragment_03").code == 0);
    refused("--fragments fragment_01 fragment_03", "'fragment_03' is hidden");
}
