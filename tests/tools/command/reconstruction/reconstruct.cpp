// SPDX-License-Identifier: Apache-2.0
// tactus plan reconstruct on a jaw and a fibula of known shape.
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

using namespace tactus;
using nlohmann::json;
namespace fs = std::filesystem;
using test::half_ring;
using Case = test::JawCase;

TEST_CASE("plan reconstruct makes a plan of the pieces with each segment in place", "[slow]") {
    const Case made;
    const test::Outcome done = made.run(made.inputs());
    INFO(done.err);
    REQUIRE(done.code == 0);
    const json plan = json::parse(test::slurp(made.plan));
    REQUIRE(plan["fragments"].size() == 5);
    // The resected piece and what is kept of the jaw add up to it.
    const double all = mesh::volume_of(half_ring());
    CHECK(made.volume("resected") == Approx(all * 1.4 / pi).epsilon(0.01));
    CHECK(made.volume("resected") + made.volume("jaw-1") + made.volume("jaw-2") == Approx(all).epsilon(1e-4));
    // Each segment, where the plan puts it, lies between the planes of the jaw.
    const test::Outcome shown = made.folder.tactus("plan show " + made.plan + " --json");
    REQUIRE(shown.code == 0);
    const json inputs = made.inputs();
    for (std::size_t n = 0; n < 2; ++n) {
        const std::string name = "segment-" + std::to_string(n + 1);
        const mesh::Mesh segment = mesh::load_mesh(made.folder.path / "case-pieces" / (name + ".stl"));
        const json& step = plan["steps"][n + 2];
        const json& pose = step["poses"][0];
        const auto number = [](const json& j, std::size_t i) { return j[i].get<double>(); };
        const json &p = pose["position_m"], &q = pose["quaternion_wxyz"];
        const Pose place{Vec3(number(p, 0), number(p, 1), number(p, 2)),
                         Quat(number(q, 0), number(q, 1), number(q, 2), number(q, 3))};
        double least = 1e9, greatest = -1e9;
        const json &from = inputs["mandible_planes"][n]["origin"], &to = inputs["mandible_planes"][n + 1]["origin"];
        const Vec3 a = Vec3(number(from, 0), number(from, 1), number(from, 2)) * mm,
                   b = Vec3(number(to, 0), number(to, 1), number(to, 2)) * mm, axis = glm::normalize(b - a);
        double off = 0.0;
        for (const Vec3& v : segment.vertices) {
            const Vec3 w = place.apply(v * mm) - a;
            least = std::min(least, glm::dot(w, axis));
            greatest = std::max(greatest, glm::dot(w, axis));
            off = std::max(off, glm::length(w - glm::dot(w, axis) * axis));
        }
        CHECK(off == Approx(7.0 * mm).margin(0.1 * mm));
        CHECK(0.5 * (least + greatest) == Approx(0.5 * glm::length(b - a)).margin(1.0 * mm));
    }
    // Undo takes the last segment back to the leg.
    CHECK(made.folder.tactus("plan undo " + made.plan).code == 0);
    // Nothing is overwritten.
    const test::Outcome again = made.run(made.inputs());
    CHECK(again.code == 2);
    CHECK_THAT(again.err, Catch::Matchers::ContainsSubstring("exists already"));
}

TEST_CASE("plan reconstruct takes half a jaw with its end, and a jaw that is resected already stays whole", "[slow]") {
    const Case made;
    const double all = mesh::volume_of(half_ring());
    json half = made.inputs();
    half["resection"] = "after-first";
    const test::Outcome done = made.run(half);
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(made.volume("resected") == Approx(all * (pi - 0.8) / pi).epsilon(0.01));
    CHECK(made.volume("jaw-1") == Approx(all * 0.8 / pi).epsilon(0.01));
    CHECK_FALSE(fs::exists(made.folder.path / "case-pieces" / "jaw-2.stl"));
    const Case other;
    json whole = other.inputs();
    whole["resection"] = "none";
    REQUIRE(other.run(whole).code == 0);
    CHECK(other.volume("jaw-1") == Approx(all).epsilon(1e-4));
    CHECK_FALSE(fs::exists(other.folder.path / "case-pieces" / "resected.stl"));
    CHECK(json::parse(test::slurp(other.plan))["steps"].size() == 3);
}

TEST_CASE("a tooth in the resected part of a jaw is resected with it", "[slow]") {
    const Case made;
    // Small separate bodies on the ring: one on each side and one in front.
    geometry::TriangleSurface jaw = half_ring();
    double tooth_volume = 0.0;
    for (const double turn : {0.4, 1.5, 2.7}) {
        const Vec3 at(-40.0 * mm * std::cos(turn), -40.0 * mm * std::sin(turn), 6.5 * mm);
        geometry::TriangleSurface tooth = reconstruction::closed_tube(at, Vec3(0.0, 0.0, 1.0), 5.0 * mm, 6, 2,
                                                                      [](double, double) { return 2.0 * mm; });
        if (mesh::volume_of(tooth) < 0.0)
            for (auto& t : tooth.triangles) std::swap(t[1], t[2]);
        tooth_volume = mesh::volume_of(tooth);
        reconstruction::append(jaw, tooth);
    }
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{jaw, {}}}, made.folder.path / "jaw.stl");
    const test::Outcome done = made.run(made.inputs());
    INFO(done.err);
    REQUIRE(done.code == 0);
    for (const char* piece : {"resected", "jaw-1", "jaw-2"}) {
        double highest = 0.0;
        const mesh::Mesh mesh = mesh::load_mesh(made.folder.path / "case-pieces" / (std::string(piece) + ".stl"));
        for (const Vec3& v : mesh.vertices) highest = std::max(highest, v.z);
        INFO(piece);
        CHECK(highest == Approx(11.5).margin(0.01));
    }
    CHECK(made.volume("resected") + made.volume("jaw-1") + made.volume("jaw-2") ==
          Approx(mesh::volume_of(half_ring()) + 3.0 * tooth_volume).epsilon(1e-4));
}

TEST_CASE("a hollow jaw is cut into hollow pieces, not into bone and marrow", "[slow]") {
    const Case made;
    geometry::TriangleSurface jaw = half_ring();
    // A canal through both rami and the chin, and a pore in the resected part that no plane meets.
    geometry::TriangleSurface canal = half_ring(2.0 * mm, 0.05, 0.95);
    geometry::TriangleSurface pore =
        reconstruction::closed_tube(Vec3(-2.0 * mm, -44.0 * mm, 0.0), Vec3(1.0, 0.0, 0.0), 4.0 * mm, 12, 4,
                                    [](double, double) { return 1.0 * mm; });
    if (mesh::volume_of(pore) < 0.0)
        for (auto& t : pore.triangles) std::swap(t[1], t[2]);
    for (geometry::TriangleSurface* cavity : {&canal, &pore}) {
        for (auto& t : cavity->triangles) std::swap(t[1], t[2]);
        reconstruction::append(jaw, *cavity);
    }
    const double all = mesh::volume_of(half_ring()), empty = -mesh::volume_of(canal), hole = -mesh::volume_of(pore);
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{jaw, {}}}, made.folder.path / "jaw.stl");
    const test::Outcome done = made.run(made.inputs());
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(json::parse(test::slurp(made.plan))["fragments"].size() == 5);
    CHECK_FALSE(fs::exists(made.folder.path / "case-pieces" / "jaw-3.stl"));
    CHECK(made.volume("resected") == Approx(all * 1.4 / pi - empty * 1.4 / (0.9 * pi) - hole).epsilon(0.01));
    CHECK(made.volume("resected") + made.volume("jaw-1") + made.volume("jaw-2") ==
          Approx(all - empty - hole).epsilon(1e-4));
}

TEST_CASE("what a plane leaves of a tooth stays with the jaw on its side", "[slow]") {
    const Case made;
    geometry::TriangleSurface jaw = half_ring();
    // A root inside the bone, through which the first plane goes.
    geometry::TriangleSurface root = half_ring(2.0 * mm, 0.8 / pi - 0.02, 0.8 / pi + 0.02);
    reconstruction::append(jaw, root);
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{jaw, {}}}, made.folder.path / "jaw.stl");
    const test::Outcome done = made.run(made.inputs());
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(json::parse(test::slurp(made.plan))["fragments"].size() == 5);
    const double all = mesh::volume_of(half_ring()), half = 0.5 * mesh::volume_of(root);
    CHECK(made.volume("jaw-2") == Approx(all * 0.8 / pi + half).epsilon(0.005));
    CHECK(made.volume("resected") == Approx(all * 1.4 / pi + half).epsilon(0.005));
}

TEST_CASE("a jaw of which nothing is cut may be open, as scans are", "[slow]") {
    const Case made;
    geometry::TriangleSurface open = half_ring();
    open.triangles.pop_back();
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{open, {}}}, made.folder.path / "jaw.stl");
    json inputs = made.inputs();
    inputs["resection"] = "none";
    const test::Outcome done = made.run(inputs);
    INFO(done.err);
    CHECK(done.code == 0);
    CHECK(fs::exists(made.folder.path / "case-pieces" / "jaw-1.stl"));
    CHECK_FALSE(fs::exists(made.folder.path / "case-pieces" / "resected.stl"));
}

TEST_CASE("plan reconstruct that is refused leaves nothing behind") {
    using Catch::Matchers::ContainsSubstring;
    const Case made;
    const auto refused = [&](const json& inputs, const std::string& text) {
        const test::Outcome answer = made.run(inputs);
        CHECK(answer.code == 2);
        CHECK_THAT(answer.err, ContainsSubstring(text));
        CHECK_FALSE(fs::exists(made.plan));
        CHECK_FALSE(fs::exists(made.folder.path / "case-pieces"));
    };
    json without = made.inputs();
    without.erase("donor");
    refused(without, "no 'donor'");
    json missing = made.inputs();
    missing["jaw"] = "none.stl";
    refused(missing, "none.stl");
    json unknown = made.inputs();
    unknown["resection"] = "all";
    refused(unknown, "'resection' must be");
    json middle = made.inputs();
    middle["mandible_planes"][0]["origin"] = {-5, -8, 0};
    refused(middle, "does not tell which limb");
    geometry::TriangleSurface open = half_ring();
    open.triangles.pop_back();
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{open, {}}}, made.folder.path / "open.stl");
    json hole = made.inputs();
    hole["jaw"] = "open.stl";
    refused(hole, "the jaw: its mesh is open at 3 edges");
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{half_ring(6.0 * mm, 0.5, 1.0), {}}},
                     made.folder.path / "jaw.stl");
    // The first plane lies where this jaw ends already.
    refused(made.inputs(), "\"resection\": \"none\"");
    json beside = made.inputs();
    for (json& plane : beside["mandible_planes"]) plane["origin"][2] = 300.0;
    beside["mandible_planes"][0]["normal"] = {0.0, 0.1, 1.0};
    beside["mandible_planes"][2]["normal"] = {0.0, 0.1, 1.0};
    const test::Outcome answer = made.run(beside);
    CHECK(answer.code == 2);
    CHECK_FALSE(fs::exists(made.folder.path / "case-pieces"));
}
