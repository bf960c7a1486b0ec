// SPDX-License-Identifier: Apache-2.0
// Bones through the command: what is in a file, label maps in, meshes and volumes out.
#include "assets/bone/bone.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

namespace fs = std::filesystem;
using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

struct BoneFolder : test::Folder {
    std::string operator/(const std::string& name) const { return (path / name).string(); }
    json answer(const std::string& arguments) const {
        const test::Outcome done = tactus(arguments);
        INFO(arguments << "\n" << done.err);
        REQUIRE(done.code == 0);
        return json::parse(done.out);
    }
};

// Two balls of 6 and 4 mm radius, far from the origin: HU, or labels 1 and 2.
volume::Grid grid_of_two_balls(bool labels) {
    volume::Grid grid{{60, 36, 34}, Vec3(0.9, -0.2, 1.1), Vec3(0.5 * mm, 0.5 * mm, 0.6 * mm), {}};
    for (int k = 0; k < 34; ++k)
        for (int j = 0; j < 36; ++j)
            for (int i = 0; i < 60; ++i) {
                const Vec3 p = grid.position(i, j, k) - grid.origin;
                const double a = glm::length(p - Vec3(8.5, 9.0, 10.0) * mm) - 6.0 * mm;
                const double b = glm::length(p - Vec3(22.0, 9.0, 10.0) * mm) - 4.0 * mm;
                const double tissue = k < 2 ? -1000.0 : 40.0;
                const double hu = std::clamp(700.0 - 2e7 * std::min(a, b), tissue, 1400.0);
                grid.values.push_back(static_cast<float>(labels ? (a < 0.0 ? 1.0 : b < 0.0 ? 2.0 : 0.0) : hu));
            }
    return grid;
}

double ball_mm3(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

}  // namespace

TEST_CASE("info answers the same questions for a CT and a label map and a mesh and bones", "[slow]") {
    const BoneFolder folder;
    volume::write_volume(grid_of_two_balls(false), volume::WrittenType::int16, folder / "ct.nrrd");
    volume::write_volume(grid_of_two_balls(true), volume::WrittenType::int16, folder / "labels.nrrd");
    REQUIRE(folder
                .tactus("import " + folder / "labels.nrrd" + " --label all --ct " + folder / "ct.nrrd" + " -o " +
                        folder / "two.vdb")
                .code == 0);
    REQUIRE(folder.tactus("export " + folder / "two.vdb" + " -o " + folder / "two.stl").code == 0);
    const char* keys[] = {"kind",       "frame",   "size",
                          "spacing_mm", "uniform", "tilt_deg",
                          "hu",         "range",   "suggested_threshold",
                          "components", "unit",    "unit_question",
                          "notes"};
    for (const auto& [file, kind] : {std::pair<std::string, std::string>{"ct.nrrd", "ct"},
                                     {"labels.nrrd", "labels"},
                                     {"two.stl", "mesh"},
                                     {"two.vdb", "bone"}}) {
        const json found = folder.answer("info " + folder / file + " --json -o " + folder / "picture.png");
        INFO(found.dump(2));
        CHECK(found.size() == std::size(keys) + 1);  // its version
        CHECK(test::broken_schema(folder, "info", found) == "");
        for (const char* key : keys) CHECK(found.contains(key));
        CHECK(found["kind"] == kind);
        CHECK(found["frame"] == "LPS");
        REQUIRE(found["components"].size() == 2);
        for (std::size_t n = 0; n < 2; ++n) {
            const json& part = found["components"][n];
            const double radius = n == 0 ? 6.0 : 4.0;
            CHECK(part["volume_mm3"].get<double>() == Approx(ball_mm3(radius)).epsilon(0.04));
            const json& x = part["bounds_mm"][0];
            CHECK(x[1].get<double>() - x[0].get<double>() == Approx(2.0 * radius).margin(0.6));
            CHECK(0.5 * (x[1].get<double>() + x[0].get<double>()) == Approx(n == 0 ? 908.5 : 922.0).margin(0.5));
        }
        CHECK(test::slurp(folder / "picture.png").substr(1, 3) == "PNG");
        fs::remove(folder / "picture.png");
    }
    const json ct = folder.answer("info " + folder / "ct.nrrd --json");
    CHECK(ct["size"] == json{60, 36, 34});
    CHECK(ct["spacing_mm"][2].get<double>() == Approx(0.6));
    CHECK(ct["hu"] == "calibrated");
    CHECK(ct["suggested_threshold"].get<double>() > -500.0);
    CHECK(ct["suggested_threshold"].get<double>() < 1300.0);
}

TEST_CASE("a label map goes in and comes out: import, load by name, export, import again", "[slow]") {
    const BoneFolder folder;
    volume::write_volume(grid_of_two_balls(true), volume::WrittenType::int16, folder / "labels.nrrd");
    const json made = folder.answer("import " + folder / "labels.nrrd --label all --json -o " + folder / "two.vdb");
    REQUIRE(made["bones"].size() == 2);
    CHECK(made["bones"][1]["label"] == 2);
    CHECK(bone::load_bone(folder / "two.vdb#label_2").provenance.at("label") == "2");
    const json one = folder.answer("export " + folder / "two.vdb --bone label_2 --json -o " + folder / "b.ply");
    CHECK(one["volume_mm3"].get<double>() == Approx(ball_mm3(4.0)).epsilon(0.04));
    const json again = folder.answer("import " + folder / "b.ply --json -o " + folder / "b.vdb");
    CHECK(test::broken_schema(folder, "import", made) == "");
    CHECK(test::broken_schema(folder, "import", again) == "");
    CHECK(again["bone_volume_mm3"].get<double>() == Approx(one["volume_mm3"].get<double>()).epsilon(0.02));
    for (const char* refused : {"two.vdb -o x.obj", "two.vdb --bone label_7 -o x.stl", "absent.vdb -o x.stl"}) {
        const std::string line = "export " + folder / refused;
        CHECK(folder.tactus(line.substr(0, line.find(" -o ") + 4) + folder / line.substr(line.find(" -o ") + 4)).code ==
              2);
    }
    CHECK(folder.tactus("import " + folder / "labels.nrrd --label 3 -o " + folder / "x.vdb").code == 2);
    CHECK(
        folder.tactus("import " + folder / "labels.nrrd --ct " + folder / "labels.nrrd -o " + folder / "x.vdb").code ==
        2);
    CHECK(folder.tactus("info " + folder / "absent.nrrd").code == 2);
    CHECK_FALSE(fs::exists(folder / "x.vdb"));
}

TEST_CASE("a render leaves the cut bone, and it is smaller and goes out as a mesh") {
    const BoneFolder folder;
    REQUIRE(folder.tactus("render saw-training --seconds 3 --out " + folder / "saw").code == 0);
    const bone::Bone cut = bone::load_bone(folder / "saw/bone.vdb");
    const json mesh = folder.answer("export " + folder / "saw/bone.vdb --json -o " + folder / "cut.stl");
    const json summary = json::parse(test::slurp(folder / "saw/summary.json"));
    CHECK(mesh["volume_mm3"].get<double>() > 1000.0);
    CHECK(summary["carve"]["removed_mm3"] > 5.0);
    CHECK(std::count(summary["files"].begin(), summary["files"].end(), "bone.vdb") == 1);
}

TEST_CASE("info says when values are not HU, and prints neither a negative zero nor NaN") {
    const BoneFolder folder;
    // A ball of the greatest value in the least; -0 beside 0, and NaN where a program found no value.
    const auto write = [&](float least, float greatest, volume::WrittenType type) {
        volume::Grid grid{{32, 32, 32}, Vec3(0.0), Vec3(2e-3), {}};
        grid.values.assign(grid.count(), least);
        for (int k = 0; k < 32; ++k)
            for (int j = 0; j < 32; ++j)
                for (int i = 0; i < 32; ++i) {
                    const double r = glm::length(Vec3(i, j, k) - Vec3(15.5));
                    if (r < 8.0) grid.at(i, j, k) = greatest - static_cast<float>(r) * 0.02f * (greatest - least);
                }
        grid.at(0, 0, 0) = greatest;
        if (type == volume::WrittenType::float32) {
            grid.at(1, 0, 0) = std::numeric_limits<float>::quiet_NaN();
            grid.at(2, 0, 0) = -std::numeric_limits<float>::infinity();
        }
        volume::write_volume(grid, type, folder / "scan.nrrd");
    };
    const auto check = [&](bool is_in_hu) {
        const json found = folder.answer("info " + folder / "scan.nrrd --unit mm --json");
        const test::Outcome text = folder.tactus("info " + folder / "scan.nrrd --unit mm");
        CAPTURE(text.out, found.dump(2));
        for (const json& end : found["range"]) CHECK(end.is_number());
        CHECK(found["range"].dump().find("-0.0") == std::string::npos);
        CHECK(text.out.find("nan") == std::string::npos);
        CHECK(text.out.find("-0 ") == std::string::npos);
        const bool says_hu = text.out.find(" HU (") != std::string::npos && text.out.find("not in HU (") == std::string::npos;
        const bool says_not = text.out.find("the values are not HU") != std::string::npos;
        CHECK(says_hu == is_in_hu);
        CHECK(says_not != is_in_hu);
        if (!is_in_hu) CHECK(text.out.find("not in HU (") != std::string::npos);
        const test::Outcome imported = folder.tactus("import " + folder / "scan.nrrd --unit mm -o " + folder / "b.vdb");
        CHECK((imported.code == 0) == is_in_hu);
        if (!is_in_hu) CHECK(imported.err.find("are not HU") != std::string::npos);
    };
    write(-0.0f, 1.0f, volume::WrittenType::float32);    // probabilities, or HU / 1000
    check(false);
    write(-0.0f, 250.5f, volume::WrittenType::float32);  // micro-CT of 8 bits, filtered and masked
    check(false);
    write(7.0f, 250.0f, volume::WrittenType::int16);     // the same, not masked
    check(false);
    write(12.0f, 1800.0f, volume::WrittenType::int16);   // MR
    check(false);
    write(-0.0f, 1200.0f, volume::WrittenType::float32);  // a masked CT
    check(true);
    write(-1000.0f, 1200.0f, volume::WrittenType::float32);
    check(true);
}

TEST_CASE("info lists each of overlapping segments from its own layer, and those without voxels") {
    const BoneFolder folder;
    std::string samples;
    for (int n = 0; n < 64; ++n) {
        samples += static_cast<char>(n < 8 ? 1 : n < 12 ? 7 : 0);
        samples += static_cast<char>(n < 32 ? 1 : 0);
    }
    std::ofstream(folder / "s.seg.nrrd", std::ios::binary)
        << "NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 4 4 4\n"
           "space directions: none (2,0,0) (0,2,0) (0,0,2)\nspace units: \"mm\" \"mm\" \"mm\"\nencoding: raw\nspace "
           "origin: (0,0,0)\n"
           "Segment0_ID:=a\nSegment0_Name:=Small\nSegment0_Layer:=0\nSegment0_LabelValue:=1\n"
           "Segment1_ID:=b\nSegment1_Name:=Empty\nSegment1_Layer:=0\nSegment1_LabelValue:=2\n"
           "Segment2_ID:=c\nSegment2_Name:=Large\nSegment2_Layer:=1\nSegment2_LabelValue:=1\n\n"
        << samples;
    const json found = folder.answer("info " + folder / "s.seg.nrrd --json");
    REQUIRE(found["components"].size() == 2);
    CHECK(found["components"][0]["name"] == "label 1: Small");
    CHECK(found["components"][0]["volume_mm3"] == 64.0);
    CHECK(found["components"][1]["name"] == "label 3: Large");
    CHECK(found["components"][1]["volume_mm3"] == 256.0);
    const std::string notes = found["notes"].dump();
    CHECK_THAT(notes, ContainsSubstring("of 3 named segments 1 have no voxels: Empty"));
    CHECK_THAT(notes, ContainsSubstring("4 voxels have values that no segment names"));
    // What to choose from is all that the file names.
    const test::Outcome refused = folder.tactus("import " + folder / "s.seg.nrrd -o " + folder / "x.vdb");
    CHECK_THAT(refused.err, ContainsSubstring("1 (Small), 2 (Empty), 3 (Large)"));
}
