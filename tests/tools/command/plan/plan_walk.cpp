// SPDX-License-Identifier: Apache-2.0
// The whole way of a case with generated data: fragments, plan, fit, check, report, and files for other programs, which
// are read back.
#include "assets/bone/bone.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/transform/transform_file.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/slicer_markups.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/plan_pose.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

using namespace tactus;
using nlohmann::json;
using tactus::test::Outcome;

namespace {

/// LPS of Slicer's RAS, m.
Vec3 from_slicer(const Vec3& ras) { return Vec3(-ras.x, -ras.y, ras.z) * mm; }

/// Largest distance of a vertex of `placed` from where `motion` brings the same vertex of `scan`, m. Writers may reorder
/// vertices.
double most_off(const mesh::Mesh& placed, const mesh::Mesh& scan, const Pose& motion) {
    double most = 0.0;
    for (std::size_t n = 0; n < placed.vertices.size(); n += placed.vertices.size() / 50 + 1) {
        double nearest = 1e9;
        for (const Vec3& v : scan.vertices)
            nearest = std::min(nearest, glm::length(motion.apply(v * mm) - placed.vertices[n] * mm));
        most = std::max(most, nearest);
    }
    return most;
}

}  // namespace

// Costly: the only test of the whole way, with two exports and a report.
TEST_CASE("a case from its fragments to a report and to files that other programs read back", "[slow]") {
    const test::Folder folder;
    const auto file = [&](const std::string& name) { return (folder.path / name).string(); };
    const auto run = [&](const std::string& arguments) {
        const Outcome done = folder.tactus(arguments);
        INFO(arguments << "\n" << done.out << done.err);
        REQUIRE(done.code == 0);
        return done.out;
    };
    bone::save_bone(test::bar(), file("bar.vdb"));
    run("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 3 --turn 8");
    const json truth = json::parse(test::slurp(file("f/truth.json")));
    const std::string plan = file("case.plan.json");
    run("plan new " + plan + " one=" + file("f/fragment_01.vdb") + " two=" + file("f/fragment_02.vdb"));
    run("plan lock " + plan + " one");
    run("plan snap " + plan + " two one");
    run("plan check " + plan);
    run("plan report " + plan);
    CHECK(test::slurp(file("case.html")).find("two") != std::string::npos);
    for (const std::string transforms : {"tfm", "h5"}) {
        const std::string out = file("out-" + transforms);
        const json written =
            json::parse(run("plan export " + plan + " --json --transform-format " + transforms + " -o " + out));
        for (const json& one : written["written"]) {
            const std::string stem = out + "/" + one["fragment"].get<std::string>();
            CAPTURE(stem);
            const Pose planned = test::pose_in(one["pose"]), read = transform::read_motion(stem + "." + transforms);
            CHECK(glm::length(read.position - planned.position) < 1e-9);
            CHECK(glm::length(rotation_between(read.orientation, planned.orientation)) < 1e-9);
            const auto scan = test::read_as_slicer(test::slurp(stem + ".scan.mrk.json")),
                       there = test::read_as_slicer(test::slurp(stem + ".plan.mrk.json"));
            REQUIRE(scan[0].points.size() == 7);
            REQUIRE(there[0].points.size() == 7);
            for (std::size_t n = 0; n < 7; ++n)
                CHECK(glm::length(read.apply(from_slicer(scan[0].points[n])) - from_slicer(there[0].points[n])) < 1e-9);
        }
        // Both pieces together are the bar again, to a few hundredths of a millimetre.
        const mesh::Mesh two = mesh::load_mesh(out + "/two.stl"), before = mesh::load_mesh(file("f/fragment_02.stl"));
        CHECK(most_off(two, before, transform::read_motion(out + "/two." + transforms)) < 0.3e-3);
        Vec3 low(1e9), high(-1e9);
        for (const char* name : {"one", "two"})
            for (const Vec3& v : mesh::load_mesh(out + "/" + name + ".stl").vertices)
                low = glm::min(low, v), high = glm::max(high, v);
        CHECK(glm::length(high - low - Vec3(40.0, 13.0, 22.0)) < 1.0);
    }
    CHECK(truth["fragments"].size() == 2);
}
