// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/repair.hpp"

#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

// A ball of 10 mm in many triangles, closed, around `middle` (mm).
geometry::TriangleSurface sphere(const Vec3& middle, int rings = 24) {
    geometry::TriangleSurface mesh;
    const int around = 2 * rings;
    for (int r = 0; r <= rings; ++r)
        for (int a = 0; a < (r == 0 || r == rings ? 1 : around); ++a) {
            const double t = std::numbers::pi * r / rings, p = std::numbers::pi * a / rings;
            mesh.vertices.push_back(middle +
                                    10.0 * Vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)));
        }
    const auto at = [&](int r, int a) {
        return r == 0 ? 0 : r == rings ? 1 + (rings - 1) * around : 1 + (r - 1) * around + a % around;
    };
    for (int r = 0; r < rings; ++r)
        for (int a = 0; a < around; ++a) {
            if (r > 0) mesh.triangles.push_back({at(r, a), at(r + 1, a), at(r, a + 1)});
            if (r < rings - 1) mesh.triangles.push_back({at(r, a + 1), at(r + 1, a), at(r + 1, a + 1)});
        }
    return mesh;
}

std::string obj_of(const geometry::TriangleSurface& mesh, const std::string& comment = "") {
    std::string text = comment + "\n";
    for (const Vec3& v : mesh.vertices) text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", v.x, v.y, v.z);
    for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    return text;
}

std::string ply_of(const geometry::TriangleSurface& mesh, const std::string& comment) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\ncomment {}\nelement vertex {}\nproperty double x\nproperty double y\nproperty double "
        "z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        comment, mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) text += fmt::format("{:.17g} {:.17g} {:.17g}\n", v.x, v.y, v.z);
    for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    return text;
}

Vec3 middle_of(const geometry::TriangleSurface& mesh) {
    Vec3 sum(0.0);
    for (const Vec3& v : mesh.vertices) sum += v / static_cast<double>(mesh.vertices.size());
    return sum;
}

}  // namespace

TEST_CASE("a clean mesh is left as it is") {
    geometry::TriangleSurface mesh = sphere(Vec3(0.0));
    const auto before = mesh.triangles;
    const mesh::MeshRepair done = mesh::repair(mesh, "ball");
    CHECK(done.is_clean());
    CHECK(done.describe().empty());
    CHECK(mesh.triangles == before);
}

TEST_CASE("holes, duplicates and turned triangles are repaired and counted, and the volume stays") {
    geometry::TriangleSurface mesh = sphere(Vec3(0.0));
    const double whole = mesh::volume_of(mesh);
    mesh.triangles.erase(mesh.triangles.begin() + 400, mesh.triangles.begin() + 402);  // a hole of four edges
    mesh.triangles.erase(mesh.triangles.begin() + 900);                               // and one of three
    mesh.triangles.push_back(mesh.triangles[5]);
    for (const std::size_t t : {50, 51, 700}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    const mesh::MeshRepair done = mesh::repair(mesh, "ball");
    CHECK(done.duplicates == 1);
    CHECK(done.turned == 3);
    CHECK(done.holes == 2);
    CHECK(done.boundary_edges == 7);
    CHECK(mesh::topology_of(mesh).is_watertight());
    CHECK(mesh::volume_of(mesh) == Approx(whole).epsilon(1e-3));
    CHECK_THAT(done.describe(),
               ContainsSubstring("2 holes closed (7 boundary edges") && ContainsSubstring("3 triangles flipped"));
}

TEST_CASE("two balls that share one edge keep their insides") {
    geometry::TriangleSurface mesh = sphere(Vec3(0.0));
    const double whole = mesh::volume_of(mesh);
    const geometry::TriangleSurface other = sphere(Vec3(30.0, 0.0, 0.0));
    const int offset = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    // The other one's first edge is drawn over to this one's.
    const int from[2] = {other.triangles[0][0], other.triangles[0][1]},
              to[2] = {mesh.triangles[0][0], mesh.triangles[0][1]};
    for (auto t : other.triangles) {
        for (int& v : t) v = v == from[0] ? to[0] : v == from[1] ? to[1] : v + offset;
        mesh.triangles.push_back(t);
    }
    const mesh::MeshRepair done = mesh::repair(mesh, "balls");
    CHECK(done.non_manifold_edges == 1);
    CHECK(done.holes == 0);
    CHECK(mesh::volume_of(mesh) > 1.9 * whole);
}

TEST_CASE("what has no inside is refused with numbers") {
    geometry::TriangleSurface bowl = sphere(Vec3(0.0));
    bowl.triangles.resize(bowl.triangles.size() / 2);
    CHECK_THROWS_WITH(mesh::repair(bowl, "bowl"),
                      ContainsSubstring("48 boundary edges") && ContainsSubstring("1 hole,"));
    // A Möbius band of five triangles.
    geometry::TriangleSurface band;
    for (int n = 0; n < 5; ++n) {
        const double a = 2.0 * std::numbers::pi * n / 5.0;
        band.vertices.push_back(Vec3(std::cos(a), std::sin(a), 0.3 * n));
        band.triangles.push_back({n, (n + 1) % 5, (n + 2) % 5});
    }
    CHECK_THROWS_WITH(mesh::repair(band, "band"), ContainsSubstring("not orientable"));
}

TEST_CASE("a mesh says its frame in a comment, and LPS is assumed when it does not") {
    const TemporaryFolder folder;
    const geometry::TriangleSurface ball = sphere(Vec3(20.0, 30.0, 40.0));
    mesh::MeshOrigin origin;
    file::write_whole_file(folder / "lps.obj", obj_of(ball));
    CHECK(glm::length(middle_of(mesh::load_mesh(folder / "lps.obj", 1.0, &origin)) - Vec3(20.0, 30.0, 40.0)) < 1e-9);
    CHECK_FALSE(origin.frame_stated);
    file::write_whole_file(folder / "ras.obj", obj_of(ball, "# 3D Slicer output. SPACE=RAS"));
    CHECK(glm::length(middle_of(mesh::load_mesh(folder / "ras.obj", 1.0, &origin)) - Vec3(-20.0, -30.0, 40.0)) < 1e-9);
    CHECK(origin.frame == volume::Frame::ras);
    file::write_whole_file(folder / "ras.ply", ply_of(ball, "SPACE=RAS"));
    CHECK(glm::length(middle_of(mesh::load_mesh(folder / "ras.ply")) - Vec3(-20.0, -30.0, 40.0)) < 1e-9);
    std::string stl = "solid SPACE=RAS\n";
    for (const auto& t : ball.triangles) {
        stl += "facet normal 0 0 0\nouter loop\n";
        for (const int v : t) {
            const Vec3& p = ball.vertices[static_cast<std::size_t>(v)];
            stl += fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
        }
        stl += "endloop\nendfacet\n";
    }
    file::write_whole_file(folder / "ras.stl", stl + "endsolid\n");
    CHECK(glm::length(middle_of(mesh::load_mesh(folder / "ras.stl")) - Vec3(-20.0, -30.0, 40.0)) < 1e-9);
}

TEST_CASE("a mesh a metre from the origin becomes the same bone as one at it") {
    const TemporaryFolder folder;
    const Vec3 far(1000.0, -800.0, 1200.0);
    file::write_whole_file(folder / "near.obj", obj_of(sphere(Vec3(0.0))));
    file::write_whole_file(folder / "far.obj", obj_of(sphere(far)));
    const auto bone = [&](const char* name) {
        bone::ImportOptions options;
        options.input = folder / name;
        options.spacing = 0.47e-3;
        options.unit = "mm";
        return bone::import_bone(options);
    };
    const bone::Bone near = bone("near.obj"), away = bone("far.obj");
    REQUIRE(near.distance.size == away.distance.size);
    CHECK(glm::length(away.distance.origin - near.distance.origin - far * 1e-3) < 1e-12);
    double worst = 0.0, far_off = 0.0;
    for (std::size_t n = 0; n < near.distance.values.size(); ++n) {
        const double here = near.distance.values[n], difference = std::abs(here - double(away.distance.values[n]));
        double& most = std::abs(here) < 0.7e-3 ? worst : far_off;
        most = std::max(most, difference);
    }
    CHECK(worst < 2e-9);
    // Far from the surface rounding decides which of two triangles, almost equally near, is found: a part of the error that
    // distances may have there.
    CHECK(far_off < 0.05 * 0.47e-3);
}

TEST_CASE("a big-endian and a text PLY with polygons give the same mesh") {
    const TemporaryFolder folder;
    const geometry::TriangleSurface ball = sphere(Vec3(0.0), 6);
    std::string big = fmt::format(
        "ply\nformat binary_big_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar grey\nelement face {}\nproperty list uchar int vertex_index\nend_header\n",
        ball.vertices.size(), ball.triangles.size());
    const auto put = [&big](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        for (std::size_t n = sizeof value; n-- > 0;) big += raw[n];
    };
    for (const Vec3& v : ball.vertices) {
        for (int n = 0; n < 3; ++n) put(static_cast<float>(v[n]));
        big += 'x';
    }
    for (const auto& t : ball.triangles) {
        big += '\3';
        for (const int v : t) put(v);
    }
    file::write_whole_file(folder / "big.ply", big);
    file::write_whole_file(folder / "text.ply", ply_of(ball, "none"));
    CHECK(mesh::volume_of(mesh::load_mesh(folder / "big.ply")) ==
          Approx(mesh::volume_of(mesh::load_mesh(folder / "text.ply"))).epsilon(1e-6));
    for (std::size_t length = 0; length < big.size(); length += 1 + big.size() / 31) {
        file::write_whole_file(folder / "cut.ply", big.substr(0, length));
        CHECK_THROWS_AS(mesh::load_mesh(folder / "cut.ply"), Error);
    }
}
