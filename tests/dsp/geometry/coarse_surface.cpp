// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/coarse_surface.hpp"

#include "dsp/volume/bricks.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

using namespace tactus;

namespace {

using Corner = std::array<float, 3>;

/// A ball with bumps, and a plate of one voxel beside it: 50 × 45 × 51 samples, which bricks do not divide. Of voxels of
/// 0.5 mm, or of others in the same shape.
volume::Grid body(double voxel, const Vec3& centre) {
    const double scale = voxel / 0.0005;
    volume::Grid grid{{50, 45, 51}, centre + scale * Vec3(-0.012, -0.011, -0.0125), Vec3(voxel), {}};
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 at = (grid.position(i, j, k) - centre) / scale;
                const double ball = glm::length(at) - 0.008 - 0.0003 * std::sin(3000.0 * at.x + 2000.0 * at.y);
                const double plate = std::max(std::abs(at.x - 0.0101) - 0.00025, glm::length(at) - 0.0105);
                grid.values.push_back(static_cast<float>(scale * std::min(ball, plate)));
            }
    return grid;
}

struct Bricks {
    double voxel = 0.0005;
    Vec3 centre{0.0};
    volume::Grid distance = body(voxel, centre);
    volume::BoneEditor editor{distance,
                              volume::Grid{distance.size, distance.origin, distance.spacing,
                                           std::vector<float>(distance.values.size(), 1800.0f)},
                              {.band = 4.0 * voxel}};
    geometry::SurfaceGrid grid{editor.layout().origin, editor.layout().spacing, volume::brick_cells};
    std::vector<geometry::SurfacePatch> fine;

    explicit Bricks(double voxel_ = 0.0005, const Vec3& centre_ = Vec3(0.0))
        : voxel(voxel_), centre(centre_), fine(static_cast<std::size_t>(editor.layout().brick_count())) {
        geometry::BrickSurface mesher;
        for (std::uint32_t b = 0; b < fine.size(); ++b) mesher.make(editor.current(), b, fine[b]);
    }
};

std::size_t count(const std::vector<geometry::SurfacePatch>& patches) {
    std::size_t triangles = 0;
    for (const geometry::SurfacePatch& patch : patches) triangles += patch.triangles.size() / 3;
    return triangles;
}

/// How often each edge is walked one way more than the other: all zero for a closed surface.
std::map<std::array<Corner, 2>, int> open_edges(const std::vector<geometry::SurfacePatch>& patches) {
    std::map<std::array<Corner, 2>, int> walked;
    for (const geometry::SurfacePatch& patch : patches)
        for (std::size_t t = 0; t < patch.triangles.size(); t += 3)
            for (std::size_t side = 0; side < 3; ++side) {
                const Corner a = patch.vertices[patch.triangles[t + side]].position,
                             b = patch.vertices[patch.triangles[t + (side + 1) % 3]].position;
                if (a < b) ++walked[{a, b}];
                else --walked[{b, a}];
            }
    std::erase_if(walked, [](const auto& edge) { return edge.second == 0; });
    return walked;
}

}  // namespace

TEST_CASE("dsp: a coarse surface has far fewer triangles, level by level, and no crack between its parts") {
    const Bricks bricks;
    REQUIRE(open_edges(bricks.fine).empty());
    geometry::CoarseSurface coarse;
    std::size_t before = count(bricks.fine);
    for (std::size_t level = 0; level < geometry::CoarseSurface::factors.size(); ++level) {
        INFO("cells of " << geometry::CoarseSurface::factors[level]);
        std::vector<geometry::SurfacePatch> parts;
        for (const geometry::SurfacePatch& patch : bricks.fine) parts.push_back(coarse.make(patch, bricks.grid)[level]);
        CHECK(count(parts) < 0.7 * static_cast<double>(before));
        CHECK(count(parts) > 0);
        CHECK(open_edges(parts).empty());
        before = count(parts);
    }
}

TEST_CASE("dsp: far from the origin, where single precision moves vertices off the faces, parts still close") {
    const Bricks bricks(2e-4, Vec3(-1.5, 1.2, -1.5));
    REQUIRE(open_edges(bricks.fine).empty());
    geometry::CoarseSurface coarse;
    for (std::size_t level = 0; level < geometry::CoarseSurface::factors.size(); ++level) {
        INFO("cells of " << geometry::CoarseSurface::factors[level]);
        std::vector<geometry::SurfacePatch> parts;
        for (const geometry::SurfacePatch& patch : bricks.fine) parts.push_back(coarse.make(patch, bricks.grid)[level]);
        CHECK(open_edges(parts).empty());
        CHECK(count(parts) > 0);
        CHECK(count(parts) < count(bricks.fine));
    }
}

TEST_CASE("dsp: what stays of a surface are vertices of it, one within the cell of each that is gone") {
    const Bricks bricks;
    geometry::CoarseSurface coarse;
    for (std::size_t level = 0; level < geometry::CoarseSurface::factors.size(); ++level) {
        const double cell = geometry::CoarseSurface::factors[level] * 0.0005;
        for (const geometry::SurfacePatch& patch : bricks.fine) {
            std::set<Corner> known;
            for (const geometry::SurfaceVertex& v : patch.vertices) known.insert(v.position);
            const geometry::SurfacePatch& kept = coarse.make(patch, bricks.grid)[level];
            CHECK(std::ranges::all_of(kept.vertices, [&](const auto& v) { return known.contains(v.position); }));
            for (const geometry::SurfaceVertex& v : patch.vertices)
                CHECK(std::ranges::any_of(kept.vertices, [&](const geometry::SurfaceVertex& k) {
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        if (std::abs(static_cast<double>(k.position[axis] - v.position[axis])) > cell * 1.0001)
                            return false;
                    return true;
                }));
        }
    }
}

TEST_CASE("dsp: a coarse surface of one part, or of none, needs no grid of parts") {
    const Bricks bricks;
    geometry::CoarseSurface coarse;
    const geometry::SurfacePatch& one =
        bricks.fine[std::ranges::max_element(
                        bricks.fine, {}, [](const geometry::SurfacePatch& patch) { return patch.triangles.size(); }) -
                    bricks.fine.begin()];
    CHECK(coarse.make(one, {Vec3(0.0), Vec3(0.0005), 0})[0].triangles.size() < one.triangles.size() / 2);
    for (const geometry::SurfacePatch& patch : coarse.make({}, bricks.grid)) CHECK(patch.triangles.empty());
}
