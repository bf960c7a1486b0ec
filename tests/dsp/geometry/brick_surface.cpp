// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/brick_surface.hpp"

#include "dsp/geometry/iso_surface.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace tactus;

namespace {

using Corner = std::array<float, 3>;
using Triangle = std::array<Corner, 3>;

/// The same triangle whichever corner it begins with, keeping the way it turns.
Triangle from_least(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
    std::ranges::sort(triangles);
    return triangles;
}

std::vector<Triangle> whole_mesh(const volume::BoneSnapshot& bone) {
    const geometry::TriangleSurface surface = geometry::iso_surface(volume::to_grid(bone), 0.0f, false);
    std::vector<Triangle> triangles;
    for (const auto& t : surface.triangles) {
        Triangle triangle;
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3& v = surface.vertices[static_cast<std::size_t>(t[c])];
            triangle[c] = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
        }
        triangles.push_back(from_least(triangle));
    }
    return sorted(std::move(triangles));
}

std::vector<Triangle> triangles_of(const std::vector<geometry::SurfacePatch>& patches) {
    std::vector<Triangle> triangles;
    for (const geometry::SurfacePatch& patch : patches)
        for (std::size_t i = 0; i < patch.triangles.size(); i += 3)
            triangles.push_back(from_least({patch.vertices[patch.triangles[i]].position,
                                            patch.vertices[patch.triangles[i + 1]].position,
                                            patch.vertices[patch.triangles[i + 2]].position}));
    return sorted(std::move(triangles));
}

volume::Grid ball(double radius, std::array<int, 3> size, const Vec3& spacing) {
    volume::Grid grid{size, Vec3(-0.012, -0.011, -0.0125), spacing, {}};
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i)
                grid.values.push_back(static_cast<float>(glm::length(grid.position(i, j, k)) - radius));
    return grid;
}

volume::Grid constant(volume::Grid like, float value) {
    std::ranges::fill(like.values, value);
    return like;
}

}  // namespace

TEST_CASE("dsp: remeshing what changed gives the triangles of the whole, cut after cut, without cracks") {
    // Sizes that do not divide into bricks.
    const volume::Grid distance = ball(0.009, {50, 45, 51}, Vec3(0.0005));
    volume::BoneEditor editor(distance, constant(distance, 1800.0f), {.band = 0.002});
    geometry::BrickSurface mesher;
    std::vector<geometry::SurfacePatch> patches(static_cast<std::size_t>(editor.layout().brick_count()));
    for (std::uint32_t b = 0; b < patches.size(); ++b) mesher.make(editor.current(), b, patches[b]);
    CHECK(triangles_of(patches) == whole_mesh(editor.current()));
    std::size_t remeshed = 0;
    for (int cut = 0; cut < 12; ++cut) {
        // A slot that sinks in from above, over many bricks.
        for (int k = 48 - 3 * cut; k < 51; ++k)
            for (int j = 0; j < 45; ++j)
                for (int i = 20 + cut / 3; i < 24 + cut / 2; ++i)
                    editor.set(i, j, k, std::max(editor.get(i, j, k), 0.0004f));
        const volume::BoneSnapshot now = editor.publish();
        for (const std::uint32_t b : editor.changed_bricks()) mesher.make(now, b, patches[b]);
        remeshed += editor.changed_bricks().size();
        editor.reclaim(now.version);
        CHECK(triangles_of(patches) == whole_mesh(now));
    }
    CHECK(remeshed < 12 * patches.size() / 2);

    // Every edge is passed once each way: closed over all bricks.
    std::map<std::pair<Corner, Corner>, int> edges;
    for (const Triangle& t : triangles_of(patches))
        for (std::size_t c = 0; c < 3; ++c) {
            ++edges[{t[c], t[(c + 1) % 3]}];
            --edges[{t[(c + 1) % 3], t[c]}];
        }
    CHECK(std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; }));
}

TEST_CASE("dsp: normals point out of a ball within 2 deg, on the borders of bricks as well") {
    const volume::Grid distance = ball(0.009, {50, 45, 51}, {0.0005, 0.00055, 0.00048});
    const volume::BoneEditor editor(distance, constant(distance, 1800.0f), {.band = 0.002});
    geometry::BrickSurface mesher;
    geometry::SurfacePatch patch;
    double worst = 1.0;
    std::size_t seen = 0;
    for (int b = 0; b < editor.layout().brick_count(); ++b) {
        mesher.make(editor.current(), static_cast<std::uint32_t>(b), patch);
        for (const geometry::SurfaceVertex& v : patch.vertices) {
            const Vec3 at(v.position[0], v.position[1], v.position[2]), n(v.normal[0], v.normal[1], v.normal[2]);
            worst = std::min(worst, glm::dot(glm::normalize(at), n / 32767.0));
            ++seen;
        }
    }
    CHECK(seen > 1000);
    CHECK(worst > std::cos(0.035));
}

TEST_CASE("dsp: dense bone is white, porous bone green, half way between half and half") {
    const geometry::DensityColours colours;
    CHECK(glm::length(colours(2000.0) - colours.cortex) < 1e-12);
    CHECK(glm::length(colours(0.0) - colours.core) < 1e-12);
    CHECK(glm::length(colours(1000.0) - 0.5 * (colours.core + colours.cortex)) < 1e-12);
    const volume::Grid distance = ball(0.009, {50, 45, 51}, Vec3(0.0005));
    for (const double density : {300.0, 1800.0}) {
        const volume::BoneEditor editor(distance, constant(distance, static_cast<float>(density)), {.band = 0.002});
        geometry::BrickSurface mesher;
        geometry::SurfacePatch patch;
        for (int b = 0; b < editor.layout().brick_count() && patch.vertices.empty(); ++b)
            mesher.make(editor.current(), static_cast<std::uint32_t>(b), patch);
        REQUIRE_FALSE(patch.vertices.empty());
        for (const geometry::SurfaceVertex& v : patch.vertices)
            CHECK(v.colour == geometry::packed_colour(colours(density)));
    }
}

TEST_CASE("dsp: a bone without surface has no triangles") {
    const volume::Grid distance = constant(ball(0.009, {20, 20, 20}, Vec3(0.0005)), 0.5f);
    const volume::BoneEditor editor(distance, constant(distance, 0.0f));
    geometry::BrickSurface mesher;
    geometry::SurfacePatch patch;
    patch.triangles = {0, 0, 0};
    for (int b = 0; b < editor.layout().brick_count(); ++b) {
        mesher.make(editor.current(), static_cast<std::uint32_t>(b), patch);
        CHECK(patch.triangles.empty());
    }
}
