// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/mesh_part.hpp"
#include "dsp/core/constants.hpp"

#include "assets/bone/import.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <vector>

using namespace tactus;

namespace {

// A block of 20 by 30 by 40 mm.
void write_block(const std::filesystem::path& path) {
    std::ofstream file(path);
    for (const char* z : {"0", "40"})
        for (const char* corner : {"0 0", "20 0", "20 30", "0 30"}) file << "v " << corner << ' ' << z << '\n';
    file << "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 "
            "8\n";
}

// A lumpy ball of about 12 mm across, in triangles of a millimetre.
void write_ball(const std::filesystem::path& path) {
    std::ofstream file(path);
    constexpr int around = 36, rings = 17;
    const auto at = [&](double polar, double turn) {
        const double r = 6.0 + 0.6 * std::sin(5.0 * polar) * std::cos(3.0 * turn);
        file << "v " << r * std::sin(polar) * std::cos(turn) << ' ' << r * std::sin(polar) * std::sin(turn) << ' '
             << r * std::cos(polar) << '\n';
    };
    for (int ring = 1; ring <= rings; ++ring)
        for (int n = 0; n < around; ++n) at(pi * ring / (rings + 1), 2.0 * pi * n / around);
    at(0.0, 0.0);
    at(pi, 0.0);
    const auto id = [&](int ring, int n) { return (ring - 1) * around + n % around + 1; };
    const int top = rings * around + 1, end = top + 1;
    for (int n = 0; n < around; ++n) {
        file << "f " << top << ' ' << id(1, n) << ' ' << id(1, n + 1) << '\n';
        file << "f " << end << ' ' << id(rings, n + 1) << ' ' << id(rings, n) << '\n';
        for (int ring = 1; ring < rings; ++ring) {
            file << "f " << id(ring, n) << ' ' << id(ring + 1, n) << ' ' << id(ring + 1, n + 1) << '\n';
            file << "f " << id(ring, n) << ' ' << id(ring + 1, n + 1) << ' ' << id(ring, n + 1) << '\n';
        }
    }
}

volume::Grid imported(const std::filesystem::path& path) {
    bone::ImportOptions options;
    options.input = path;
    options.unit = "mm";
    return bone::import_bone(options).distance;
}

}  // namespace

TEST_CASE("a part of a mesh has the distances that an import of all of it has there") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path / "block.obj";
    write_block(path);
    const volume::Grid whole = imported(path);
    const std::array<Vec3, 2> box{Vec3(0.012, 0.020, 0.030), Vec3(0.026, 0.034, 0.044)};
    const volume::Grid part =
        bone::distance_of_mesh({.input = path, .unit = "mm", .is_coarse = false, .within = box, .run = run_in_turn});
    CHECK(part.count() < whole.count() / 5);
    const Vec3 from = (part.origin - whole.origin) / whole.spacing;
    std::size_t compared = 0;
    for (int k = 0; k < part.size[2]; ++k)
        for (int j = 0; j < part.size[1]; ++j)
            for (int i = 0; i < part.size[0]; ++i) {
                const float there =
                    whole.at(i + static_cast<int>(std::lround(from.x)), j + static_cast<int>(std::lround(from.y)),
                             k + static_cast<int>(std::lround(from.z)));
                if (std::abs(there) > 3e-3f) continue;
                REQUIRE(part.at(i, j, k) == Approx(there).margin(1e-6));
                ++compared;
            }
    CHECK(compared > 5'000);
    // A box beside the bone is all outside.
    const volume::Grid beside = bone::distance_of_mesh({.input = path,
                                                        .unit = "mm",
                                                        .is_coarse = false,
                                                        .within = std::array{Vec3(0.5), Vec3(0.6)},
                                                        .run = run_in_turn});
    for (const float d : beside.values) CHECK(d > 0.0f);
}

TEST_CASE("a coarse mesh has an eighth of the voxels and the same size") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path / "block.obj";
    write_block(path);
    const volume::Grid whole = imported(path);
    const volume::Grid coarse =
        bone::distance_of_mesh({.input = path, .unit = "mm", .is_coarse = true, .within = {}, .run = run_in_turn});
    CHECK(coarse.spacing.x == Approx(2.0 * whole.spacing.x));
    const auto volume_of = [](const volume::Grid& g) {
        const auto inside = std::ranges::count_if(g.values, [](float d) { return d < 0.0f; });
        return static_cast<double>(inside) * g.spacing.x * g.spacing.y * g.spacing.z;
    };
    CHECK(volume_of(coarse) == Approx(24e-6).epsilon(0.1));
}

TEST_CASE("a mesh is sampled to the same points from distances near its surface as from all of them") {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path / "ball.obj";
    write_ball(path);
    const volume::Grid near = bone::distance_of_mesh(
        {.input = path, .unit = "mm", .is_coarse = false, .within = {}, .is_surface_only = true, .run = run_in_turn});
    const std::vector<contact::SurfacePoint> points = contact::sample_surface(near, {}),
                                             whole = contact::sample_surface(imported(path), {});
    REQUIRE(points.size() == whole.size());
    REQUIRE(points.size() > 1'000);
    for (std::size_t n = 0; n < points.size(); ++n) {
        // Beyond 1.5 voxels the distances of an import are not quite exact.
        REQUIRE(glm::length(points[n].position - whole[n].position) < 1e-6);
        REQUIRE(glm::length(points[n].normal - whole[n].normal) < 1e-3);
        REQUIRE(points[n].area == Approx(whole[n].area));
    }
}
