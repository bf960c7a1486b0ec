// SPDX-License-Identifier: Apache-2.0
// A jaw and a fibula of known shape, as files with inputs.
#pragma once

#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "tests/dsp/reconstruction/donors.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test {

/// A jaw as half a ring of radius 40 mm with its chin at y = -40 mm; a part of it from `from` to `to`, 0 to 1.
inline geometry::TriangleSurface half_ring(double thick = 6e-3, double from = 0.0, double to = 1.0) {
    geometry::TriangleSurface ring = reconstruction::closed_tube(Vec3(0.0, 0.0, from), Vec3(0.0, 0.0, 1.0), to - from,
                                                                 40, 81, [&](double, double) { return thick; });
    for (Vec3& v : ring.vertices) {
        const double a = std::numbers::pi * v.z;
        v = (40e-3 + v.x) * Vec3(-std::cos(a), -std::sin(a), 0.0) + Vec3(0.0, 0.0, -v.y);
    }
    if (mesh::volume_of(ring) < 0.0)
        for (auto& t : ring.triangles) std::swap(t[1], t[2]);
    return ring;
}

inline nlohmann::json at(double turn) { return {-40.0 * std::cos(turn), -40.0 * std::sin(turn), 0.0}; }

struct JawCase {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    JawCase() {
        geometry::TriangleSurface bone = reconstruction::closed_tube(Vec3(0.1, 0.0, -0.2), Vec3(0.0, 0.0, 1.0), 0.33,
                                                                     40, 61, [](double, double) { return 7e-3; });
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{bone, {}}}, folder.path / "fibula.stl");
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{half_ring(), {}}}, folder.path / "jaw.stl");
    }
    nlohmann::json inputs() const {
        // Both end planes reach through both rami.
        return {{"mandible_planes",
                 {{{"origin", at(0.8)}, {"normal", {0.717, -0.697, 0.0}}},
                  {{"origin", at(1.57)}},
                  {{"origin", at(2.2)}, {"normal", {0.808, 0.589, 0.0}}}}},
                {"fibula_line", {{"point", {100, 0, -200}}, {"direction", {0, 0, 1}}}},
                {"donor", "fibula.stl"},
                {"jaw", "jaw.stl"}};
    }
    Outcome run(const nlohmann::json& with) const {
        return folder.tactus("plan reconstruct " + plan + " " + folder.write("inputs.json", with.dump()).string());
    }
    double volume(const std::string& piece) const {
        return mesh::volume_of(mesh::load_mesh(folder.path / "case-pieces" / (piece + ".stl"))) * 1e-9;
    }
};

}  // namespace tactus::test
