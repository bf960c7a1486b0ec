// SPDX-License-Identifier: Apache-2.0
// tactus plan guide on a jaw and a fibula of known shape.
#include "assets/mesh/mesh.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"
#include "tests/tools/json_schema.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

struct GuideCase : test::JawCase {
    GuideCase() { REQUIRE(run(inputs()).code == 0); }
    test::Outcome guide(const std::string& out, const std::string& more = "") const {
        return folder.tactus("plan guide " + plan + " -o " + (folder.path / out).string() + " --voxel 0.5 " + more);
    }
    bool has(const std::string& file) const { return std::filesystem::exists(folder.path / file); }
};

bool has_program(const char* command) { return std::system((std::string(command) + " >/dev/null 2>&1").c_str()) == 0; }

}  // namespace

// Costly: a reconstruction is planned and written by several commands.
TEST_CASE("plan guide writes a closed guide with each slot on its osteotomy", "[slow]") {
    const GuideCase made;
    const test::Outcome done = made.guide("guide.stl", "--json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    const json guide = json::parse(done.out);
    CHECK(test::broken_schema(made.folder, "plan-guide", guide) == "");
    CHECK(guide["closed"] == true);
    CHECK(guide["parts"] == 1);
    CHECK(guide["seating"]["free"] == true);
    REQUIRE(guide["slots"].size() == 4);
    for (const json& slot : guide["slots"]) {
        CHECK(std::abs(slot["offset_mm"].get<double>()) < 0.05);
        CHECK(slot["angle_error_deg"].get<double>() < 0.1);
        if (!slot["width_mm"].is_null()) CHECK(slot["width_mm"].get<double>() == Approx(0.9).margin(0.05));
    }
    CHECK(guide["contact_share"].get<double>() > 0.5);
    const mesh::Mesh stl = mesh::load_mesh(made.folder.path / "guide.stl");
    CHECK(stl.triangles.size() == guide["triangles"].get<std::size_t>());
    CHECK(mesh::volume_of(stl) == Approx(guide["volume_mm3"].get<double>()).epsilon(1e-4));
    CHECK(mesh::topology_of(stl).is_watertight());
    if (!has_program("admesh --version")) test::skip("admesh is not installed");
    const std::string text = (made.folder.path / "admesh.txt").string();
    REQUIRE(std::system(("admesh " + (made.folder.path / "guide.stl").string() + " >" + text).c_str()) == 0);
    const std::string said = test::slurp(text);
    CHECK_THAT(said, ContainsSubstring("Number of parts       :     1"));
    CHECK_THAT(said, ContainsSubstring("Degenerate facets     :     0"));
    CHECK_THAT(said, ContainsSubstring("Facets reversed       :     0"));
    CHECK_THAT(said, ContainsSubstring("Total disconnected facets        :     0 "));
}

TEST_CASE("a guide as 3MF has its unit and all triangles", "[slow]") {
    const GuideCase made;
    const test::Outcome done = made.guide("guide.3mf", "--bone jaw --cut 1 --json");
    INFO(done.err);
    REQUIRE(done.code == 0);
    if (!has_program("python3 --version")) return test::skip("python3 is not installed");
    const std::filesystem::path script = made.folder.write("read.py", R"(
import sys, xml.etree.ElementTree as tree, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
assert archive.namelist()[0] == '[Content_Types].xml'
model = tree.fromstring(archive.read('3D/3dmodel.model'))
core = '{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}'
print(model.get('unit'), len(model.findall('.//' + core + 'triangle')), len(model.findall('.//' + core + 'item')))
)");
    const std::string text = (made.folder.path / "read.txt").string();
    REQUIRE(std::system(("python3 " + script.string() + " " + (made.folder.path / "guide.3mf").string() + " >" + text)
                            .c_str()) == 0);
    CHECK(test::slurp(text) ==
          "millimeter " + std::to_string(json::parse(done.out)["triangles"].get<std::size_t>()) + " 1\n");
}

TEST_CASE("a guide that must not be printed is refused and leaves nothing behind", "[slow]") {
    const GuideCase made;
    const auto refused = [&](const std::string& more, const std::string& why, const std::string& out = "guide.stl") {
        const test::Outcome done = made.guide(out, more);
        INFO(more);
        CHECK(done.code == 2);
        CHECK_THAT(done.err, ContainsSubstring(why));
        CHECK(!made.has(out));
    };
    refused("", "written as .stl, .3mf, .ply", "guide.obj");
    refused("--label Größe", "cannot be engraved");
    refused("--label 12345678901234567", "longer than 16 characters");
    // The plan's own meshes are no place for a guide.
    const test::Outcome over =
        made.folder.tactus("plan guide " + made.plan + " -o " + (made.folder.path / "fibula.stl").string());
    CHECK(over.code == 2);
}

// Costly: a case is written, planned and two guides are made of it.
TEST_CASE("a guide through a vessel is refused, and one with close slots is made", "[slow]") {
    const test::Folder folder;
    const auto file = [&](const char* name) { return (folder.path / name).string(); };
    REQUIRE(folder.tactus("flap -o " + file("flap")).code == 0);
    REQUIRE(folder.tactus("plan reconstruct " + file("case.plan.json") + " " + file("flap/INPUTS.json")).code == 0);
    const auto guide = [&](const std::string& more, const char* voxel = "0.5") {
        return folder.tactus("plan guide " + file("case.plan.json") + " -o " + file("guide.stl") + " --voxel " + voxel +
                             " " + more);
    };
    const test::Outcome through = guide("--turn -60");
    CHECK(through.code == 2);
    CHECK_THAT(through.err, ContainsSubstring("overlaps"));
    CHECK_THAT(through.err, ContainsSubstring("vessel 'artery'"));
    CHECK(!std::filesystem::exists(file("guide.stl")));
    // The usual approach is 0.05 mm from the artery.
    const test::Outcome touch = guide("");
    CHECK(touch.code == 2);
    CHECK_THAT(touch.err, ContainsSubstring("the guide touches vessel 'artery'"));
    // Neither the distance nor the verdict depends on the voxel.
    std::vector<double> distances;
    for (const char* voxel : {"0.37", "0.5"}) {
        const test::Outcome beside = guide("--turn 10 --json", voxel);
        INFO(beside.err);
        REQUIRE(beside.code == 0);
        const json vessels = json::parse(beside.out)["vessels"];
        REQUIRE(!vessels.empty());
        CHECK(vessels[0]["name"] == "vessel 'artery'");
        distances.push_back(vessels[0]["distance_mm"].get<double>());
    }
    CHECK(distances[0] == Approx(distances[1]).margin(0.02));
    const test::Outcome made = guide("--turn 10 --printer fdm --blade 0.6");
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK_THAT(made.out, ContainsSubstring("slot B is a ledge"));
    CHECK_THAT(made.out, ContainsSubstring("0.60 mm   given"));
    CHECK_THAT(made.out, ContainsSubstring("3.00 mm   BoneReconstructionPlanner"));
}
