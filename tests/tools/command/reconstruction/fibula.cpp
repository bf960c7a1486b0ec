// SPDX-License-Identifier: Apache-2.0
// tactus plan fibula against a published plan: its cut pieces, and its inputs.
#include "assets/mesh/mesh.hpp"
#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

namespace fs = std::filesystem;
using namespace tactus;
using nlohmann::json;

namespace {

test::Outcome plan_fibula(const std::string& inputs) {
    const test::Folder folder;
    return folder.tactus("plan fibula --json " + folder.write("inputs.json", inputs).string());
}

using Rim = std::vector<Vec3>;

// The two open borders of a cut piece, the one with the lesser z first.
std::array<Rim, 2> rims_of(const mesh::Mesh& piece) {
    std::map<std::pair<int, int>, int> uses;
    for (const auto& t : piece.triangles)
        for (std::size_t c = 0; c < 3; ++c) ++uses[std::minmax(t[c], t[(c + 1) % 3])];
    std::map<int, std::vector<int>> beside;
    for (const auto& [edge, count] : uses)
        if (count == 1) beside[edge.first].push_back(edge.second), beside[edge.second].push_back(edge.first);
    std::vector<Rim> found;
    std::map<int, bool> seen;
    for (const auto& [first, ignored] : beside) {
        if (seen[first]) continue;
        std::vector<int> open{first};
        seen[first] = true;
        Rim rim;
        while (!open.empty()) {
            const int n = open.back();
            open.pop_back();
            rim.push_back(piece.vertices[static_cast<std::size_t>(n)]);
            for (const int m : beside[n])
                if (!seen[m]) seen[m] = true, open.push_back(m);
        }
        found.push_back(rim);
    }
    REQUIRE(found.size() == 2);
    if (found[0][0].z > found[1][0].z) std::swap(found[0], found[1]);
    return {found[0], found[1]};
}

// The rims are flat within the rounding of a float: three far points give the plane.
Vec3 normal_of(const Rim& rim) {
    Vec3 best(0.0);
    for (std::size_t a = 0; a < rim.size(); ++a)
        for (std::size_t b = a + 1; b < rim.size(); ++b) {
            const Vec3 n = glm::cross(rim[a] - rim[0], rim[b] - rim[0]);
            if (glm::length(n) > glm::length(best)) best = n;
        }
    return glm::normalize(best);
}

Vec3 vector_of(const json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

}  // namespace

TEST_CASE("plan fibula agrees with the pieces of a published plan") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    const fs::path folder = data ? fs::path(data) / "foff" : "";
    if (!data || !fs::exists(folder / "brp_plan_inputs.json"))
        return test::skip("TACTUS_SHARED_DATA does not name a folder with foff/brp_plan_inputs.json");
    json inputs;
    std::ifstream(folder / "brp_plan_inputs.json") >> inputs;
    // As published: lengths and angles need no place along the line.
    const test::Outcome plain = plan_fibula(inputs.dump());
    INFO(plain.err);
    REQUIRE(plain.code == 0);

    const Vec3 point = vector_of(inputs["fibula_line"]["point"]);
    const Vec3 line = glm::normalize(vector_of(inputs["fibula_line"]["direction"]));
    const auto where_line_meets = [&](const Rim& rim) {
        const Vec3 n = normal_of(rim);
        return glm::dot(rim[0] - point, n) / glm::dot(line, n);
    };
    std::vector<std::array<Rim, 2>> pieces;
    for (int n = 0; n < 3; ++n)
        pieces.push_back(rims_of(mesh::load_mesh(folder / ("brp_fibula_segment" + std::to_string(n) + ".ply"))));
    for (const auto& piece : pieces) inputs["along_line_mm"].push_back(where_line_meets(piece[0]));
    const test::Outcome placed = plan_fibula(inputs.dump());
    INFO(placed.err);
    REQUIRE(placed.code == 0);
    const json plan = json::parse(placed.out);
    REQUIRE(plan["segments"].size() == 3);
    const std::array<double, 4> tilts{4.805, 25.838, 32.263, 15.879};
    for (std::size_t n = 0; n < 3; ++n) {
        const json& segment = plan["segments"][n];
        const auto mapped = [&](const Vec3& p) {
            Vec3 q;
            for (int row = 0; row < 3; ++row) {
                const json& m = segment["donor_to_target"][static_cast<std::size_t>(row)];
                q[row] =
                    m[0].get<double>() * p.x + m[1].get<double>() * p.y + m[2].get<double>() * p.z + m[3].get<double>();
            }
            return q;
        };
        for (std::size_t end = 0; end < 2; ++end) {
            const json& plane = inputs["mandible_planes"][n + end];
            const Vec3 normal = glm::normalize(vector_of(plane["normal"])), origin = vector_of(plane["origin"]);
            const Rim& rim = pieces[n][end];
            for (const Vec3& p : rim) CHECK(std::abs(glm::dot(mapped(p) - origin, normal)) < 0.01);
            const Vec3 turned = mapped(normal_of(rim)) - mapped(Vec3(0.0));
            CHECK(glm::length(glm::cross(turned, normal)) < 0.01 * std::numbers::pi / 180.0);
            CHECK(segment["tilt_deg"][end].get<double>() == Approx(tilts[n + end]).margin(0.002));
            CHECK(segment["along_line_mm"][end].get<double>() == Approx(where_line_meets(rim)).margin(0.01));
        }
        CHECK(segment["length_centre_mm"] == json::parse(plain.out)["segments"][n]["length_centre_mm"]);
    }
}

TEST_CASE("plan fibula refuses wrong inputs with one line") {
    using Catch::Matchers::ContainsSubstring;
    const json good{{"units", "mm"},
                    {"mandible_planes",
                     {{{"origin", {0, 0, 0}}, {"normal", {1, 0, 0}}},
                      {{"origin", {25, 3, 0}}},
                      {{"origin", {50, 0, 0}}, {"normal", {1, 0, 0}}}}},
                    {"fibula_line", {{"point", {0, 0, 0}}, {"direction", {0, 0, 1}}}}};
    const test::Outcome done = plan_fibula(good.dump());
    INFO(done.err);
    CHECK(done.code == 0);
    CHECK(json::parse(done.out)["segments"].size() == 2);
    const auto refused = [&](const std::string& inputs, const std::string& text) {
        const test::Outcome answer = plan_fibula(inputs);
        CHECK(answer.code == 2);
        CHECK(answer.out.empty());
        CHECK_THAT(answer.err, ContainsSubstring(text));
        CHECK(std::count(answer.err.begin(), answer.err.end(), '\n') == 1);
    };
    const auto with = [&](const char* key, const json& value) {
        json changed = good;
        changed[key] = value;
        return changed.dump();
    };
    refused("", ":1:1: ");
    refused("{}", "expected an object");
    refused(with("jaw_curve", json::array()), "either 'mandible_planes' or 'jaw_curve'");
    refused(with("roll_deg", 400), "'roll_deg' must be");
    refused(with("reversed", 1), "'reversed' must be");
    refused(with("kerf_mm", "thin"), "'kerf_mm'");
    json curve = good;
    curve.erase("mandible_planes");
    curve["jaw_curve"] = {{0, 0, 0}, {25, 3, 0}, {50, 0, 0}};
    refused(curve.dump(), "'jaw_curve' needs 'segments'");
    curve["segments"] = 3;
    refused(curve.dump(), "has no room for 3 segments");
    curve["segments"] = 2;
    const test::Outcome split = plan_fibula(curve.dump());
    INFO(split.err);
    REQUIRE(split.code == 0);
    const json answer = json::parse(split.out);
    CHECK(answer["segments"].size() == 2);
    CHECK(answer["joints_mm"][1][0].get<double>() == Approx(25.0).margin(0.6));
    CHECK(answer["contour_deviation_mm"]["greatest"].get<double>() < 0.1);
    curve["jaw_curve"] = {{0, 0}};
    refused(curve.dump(), "point 0 of 'jaw_curve'");
    refused(with("units", "m"), "'units' must be \"mm\"");
    refused(with("leg", "both"), "'leg' must be");
    refused(with("mandible_planes", json::array()), "0 mandible planes");
    refused(with("mandible_planes", json::array({1, 2})), "plane 1 is no object");
    refused(with("fibula_line", json{{"point", {0, 0, 0}}, {"direction", {0, 0, 0}}}), "no direction");
    refused(with("fibula_line", json{{"point", {0, 0}}}), "'point' must be a list of three numbers");
    refused(with("along_line_mm", {1}), "a list of 2 numbers");
    refused(with("between_space_mm", -1), "'between_space_mm'");
    refused(with("donor", "none.stl"), "none.stl");
    refused(with("donor", 5), "'donor' must be the path");
}
