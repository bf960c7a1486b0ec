// SPDX-License-Identifier: Apache-2.0
// tactus flap: the files of a synthetic case are what the planning verbs read.
#include "assets/mesh/mesh.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;
namespace fs = std::filesystem;

namespace {

struct Row {
    int branch;
    Vec3 at;  // m
    double radius;
};

std::vector<Row> rows_of(const fs::path& csv) {
    std::ifstream file(csv);
    std::string line;
    std::getline(file, line);
    REQUIRE(line == "branch,x_mm,y_mm,z_mm,radius_mm,contrast,confidence,parent");
    std::vector<Row> rows;
    while (std::getline(file, line)) {
        Row row{};
        REQUIRE(std::sscanf(line.c_str(), "%d,%lf,%lf,%lf,%lf", &row.branch, &row.at.x, &row.at.y, &row.at.z,
                            &row.radius) == 5);
        row.at *= 1e-3;
        row.radius *= 1e-3;
        rows.push_back(row);
    }
    return rows;
}

geometry::TriangleSurface surface_of(const fs::path& path) {
    mesh::Mesh mesh = mesh::load_mesh(path, 1e-3);
    REQUIRE(mesh::topology_of(mesh).is_watertight());
    REQUIRE(mesh::topology_of(mesh).components == 1);
    return mesh;
}

}  // namespace

TEST_CASE("flap makes a case that plan reconstruct takes, the same bits each time", "[long]") {
    const Folder folder;
    const fs::path flap = folder.path / "flap";
    const Outcome made = folder.tactus("flap -o " + flap.string());
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK(made.out.find("synthetic: not a patient") != std::string::npos);
    CHECK(made.out.find("mirror") == std::string::npos);
    const json inputs = json::parse(slurp(flap / "INPUTS.json"));
    CHECK(inputs["leg"] == "left");
    CHECK(inputs["notes"][0].get<std::string>().find("synthetic") == 0);

    // The vessels run beside the bone: never in it, and along the segments within reach of it.
    const geometry::TriangleSurface jaw = surface_of(flap / "jaw.stl"), fibula = surface_of(flap / "fibula.stl");
    CHECK(mesh::volume_of(jaw) > 30e-6);
    const geometry::TriangleTree bone(fibula);
    for (const char* name : {"artery.csv", "vein.csv"}) {
        for (const Row& row : rows_of(flap / name)) {
            if (row.branch != 0) continue;
            CAPTURE(name, row.at.z);
            const geometry::TriangleTree::Near near = bone.nearest(row.at);
            CHECK(glm::dot(row.at - near.point, near.normal) > row.radius);
            CHECK(near.distance < 20e-3);
        }
    }
    const json perforators = json::parse(slurp(flap / "perforators.mrk.json"))["markups"][0];
    const json sites = json::parse(slurp(flap / "sites.mrk.json"))["markups"][0];
    CHECK(perforators["controlPoints"].size() == 5);
    CHECK(sites["coordinateSystem"] == "LPS");
    CHECK(sites["controlPoints"].size() == 8);

    // The plan of it has three segments and no warning, and is cut as asked.
    const Outcome plan = folder.tactus("plan fibula " + (flap / "INPUTS.json").string() + " --json");
    INFO(plan.err);
    REQUIRE(plan.code == 0);
    const json fit = json::parse(plan.out);
    CHECK(fit["segments"].size() == 3);
    CHECK(fit["warnings"].empty());
    for (const json& s : fit["segments"]) CHECK(s["length_centre_mm"].get<double>() > 20.0);
    const Outcome cut = folder.tactus("plan reconstruct " + (folder.path / "case.plan.json").string() + " " +
                                      (flap / "INPUTS.json").string());
    INFO(cut.err);
    CHECK(cut.code == 0);

    // In the jaw the vessels lie on the side of the tongue.
    const json &m = fit["segments"][1]["donor_to_target"], &along = fit["segments"][1]["along_line_mm"];
    const Vec3 point(inputs["fibula_line"]["point"][0], inputs["fibula_line"]["point"][1],
                     inputs["fibula_line"]["point"][2]);
    const Vec3 line(inputs["fibula_line"]["direction"][0], inputs["fibula_line"]["direction"][1],
                    inputs["fibula_line"]["direction"][2]);
    const Vec3 centre = point + 0.5 * (along[0].get<double>() + along[1].get<double>()) * line;
    const auto rows = rows_of(flap / "artery.csv");
    Vec3 vessel(1e9);
    for (const Row& row : rows)
        if (row.branch == 0 && std::abs(row.at.z * 1e3 - centre.z) < std::abs(vessel.z - centre.z))
            vessel = row.at * 1e3;
    const auto mapped = [&](const Vec3& p) {
        Vec3 q;
        for (int r = 0; r < 3; ++r) {
            const auto row = static_cast<std::size_t>(r);
            q[r] = m[row][0].get<double>() * p.x + m[row][1].get<double>() * p.y + m[row][2].get<double>() * p.z +
                   m[row][3].get<double>();
        }
        return q;
    };
    // (0, 5) mm is in the middle of the mouth.
    const auto from_mouth = [](const Vec3& p) { return std::hypot(p.x, p.y - 5.0); };
    CHECK(from_mouth(mapped(vessel)) < from_mouth(mapped(centre)) - 5.0);

    // A case that may have been changed is not written over.
    const Outcome over = folder.tactus("flap -o " + flap.string());
    CHECK(over.code == 2);
    CHECK(over.err.find("INPUTS.json: exists already") != std::string::npos);
    const fs::path again = folder.path / "again";
    REQUIRE(folder.tactus("flap -o " + again.string()).code == 0);
    for (const char* name : {"jaw.stl", "fibula.stl", "artery.csv", "vein.csv", "INPUTS.json", "sites.mrk.json",
                             "perforators.mrk.json", "artery.mrk.json"})
        CHECK(slurp(flap / name) == slurp(again / name));
}

TEST_CASE("flap's right leg is the mirrored left one, and it says so", "[slow]") {
    const Folder folder;
    const fs::path left = folder.path / "left", right = folder.path / "right";
    REQUIRE(folder.tactus("flap -o " + left.string()).code == 0);
    const Outcome made = folder.tactus("flap --leg right -o " + right.string());
    REQUIRE(made.code == 0);
    CHECK(made.out.find("the right leg is the mirror image of a left one") != std::string::npos);
    const json inputs = json::parse(slurp(right / "INPUTS.json"));
    CHECK(inputs["leg"] == "right");
    const auto a = rows_of(left / "artery.csv"), b = rows_of(right / "artery.csv");
    REQUIRE(a.size() == b.size());
    for (std::size_t n = 0; n < a.size(); ++n) CHECK(glm::length(a[n].at - b[n].at * Vec3(-1.0, 1.0, 1.0)) < 2e-7);
    CHECK(folder.tactus("plan fibula " + (right / "INPUTS.json").string()).code == 0);
}

TEST_CASE("flap refuses what is no fibula, and leaves no folder") {
    const Folder folder;
    const fs::path out = folder.path / "out";
    const fs::path ball =
        folder.write("cube.stl",
                     "solid c\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                     "9\nendloop\nendfacet\nendsolid\n");
    const Outcome made = folder.tactus("flap --fibula " + ball.string() + " -o " + out.string());
    CHECK(made.code == 2);
    CHECK(made.err.find("cube.stl: the fibula is 9 mm along z") != std::string::npos);
    CHECK_FALSE(fs::exists(out));
    CHECK(folder.tactus("flap --between " + ball.string() + " " + ball.string() + " -o " + out.string()).code == 2);
}

TEST_CASE("flap on a real fibula: the vessels run between the two muscles", "[slow]") {
    const char* const folder_of_data = std::getenv("TACTUS_SHARED_DATA");
    if (!folder_of_data) return test::skip("TACTUS_SHARED_DATA is not set");
    const fs::path mesh = fs::path(folder_of_data) / "mesh", tibialis = mesh / "vhf_left_muscle_tibialisposterior.stl",
                   flexor = mesh / "vhf_left_muscle_flexorhallucislongus.stl";
    if (!fs::exists(tibialis) || !fs::exists(flexor)) return test::skip("the muscles beside the fibula are not there");
    const Folder folder;
    const std::string fibula = (mesh / "fibula_left_vhf.stl").string();
    const geometry::TriangleTree bone(mesh::load_mesh(fibula, 1e-3)), one(mesh::load_mesh(tibialis, 1e-3)),
        other(mesh::load_mesh(flexor, 1e-3));
    // How far from both the artery runs at the levels that both reach, m.
    const auto from_both = [&](const std::string& name, const std::string& options) {
        const fs::path out = folder.path / name;
        const Outcome made = folder.tactus("flap --fibula " + fibula + options + " -o " + out.string());
        INFO(made.err);
        REQUIRE(made.code == 0);
        REQUIRE(folder.tactus("plan fibula " + (out / "INPUTS.json").string()).code == 0);
        double sum = 0.0, count = 0.0;
        for (const Row& row : rows_of(out / "artery.csv")) {
            if (row.branch != 0) continue;
            CHECK(bone.nearest(row.at).distance > 3.0e-3);
            CHECK(bone.nearest(row.at).distance < 25e-3);
            if (row.at.z < 0.22 || row.at.z > 0.37) continue;
            sum += std::max(one.nearest(row.at).distance, other.nearest(row.at).distance);
            count += 1.0;
        }
        REQUIRE(count > 20.0);
        return sum / count;
    };
    const double between = from_both("between", " --between " + tibialis.string() + " " + flexor.string()),
                 behind = from_both("behind", "");
    CAPTURE(between, behind);
    CHECK(between < 10e-3);
    CHECK(between < behind - 2e-3);
}
