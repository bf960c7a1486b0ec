// SPDX-License-Identifier: Apache-2.0
// Pictures of something that moves: fewer triangles, the same outline.
#include "devices/display/picture_maker.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "dsp/volume/bricks.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using tactus::test::can_render;

namespace {

constexpr int width = 320, height = 240;
constexpr double voxel = 0.25e-3;

/// A bent shaft with flat ends, ripples, a kerf of 1 mm and a rod of 1 mm.
volume::Grid shaft() {
    volume::Grid grid{{84, 76, 148}, Vec3(-10e-3, -9e-3, -18.2e-3), Vec3(voxel), {}};
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 at = grid.position(i, j, k);
                const double bend = at.x - 1e-3 * std::cos(80.0 * at.z),
                             across = std::hypot(bend, at.y) - 6e-3 - 0.2e-3 * std::sin(900.0 * at.z);
                const double kerf = std::max(std::abs(at.z - 3e-3) - 0.5e-3, -1e-3 - at.y);
                const double rod = std::max(std::hypot(at.y, at.z + 9e-3) - 0.5e-3, std::abs(at.x) - 9.3e-3);
                const double body = std::max({across, std::abs(at.z) - 16e-3, -kerf});
                grid.values.push_back(static_cast<float>(std::min(body, rod)));
            }
    return grid;
}

struct Scene {
    display::PictureMaker maker{width, height};
    display::Picture picture;
    display::OrbitCamera camera;

    Scene() {
        const volume::Grid distance = shaft();
        const volume::BoneEditor editor(
            distance,
            {distance.size, distance.origin, distance.spacing, std::vector<float>(distance.values.size(), 1800.0f)},
            {.band = 0.002, .max_dirty = 1, .max_versions = 1});
        display::MeshPool& meshes = maker.renderer().meshes();
        const display::MeshPool::Mesh mesh = meshes.make({distance.origin, distance.spacing, volume::brick_cells});
        picture.meshes = {{mesh, {}, 1.0, true, true}};
        picture.sky = picture.ground = Vec3(0.0, 0.0, 1.0);
        geometry::BrickSurface mesher;
        geometry::SurfacePatch patch;
        for (std::uint32_t b = 0; b < static_cast<std::uint32_t>(editor.layout().brick_count()); ++b) {
            mesher.make(editor.current(), b, patch);
            meshes.set_part(mesh, b, patch);
            picture.bounds.add(display::bounds_of(patch));
            const auto first = static_cast<std::uint32_t>(whole.vertices.size());
            whole.vertices.insert(whole.vertices.end(), patch.vertices.begin(), patch.vertices.end());
            for (const std::uint32_t v : patch.triangles) whole.triangles.push_back(first + v);
        }
        camera.fit(picture.bounds, static_cast<double>(width) / height);
    }

    display::Image draw(double grain) {
        picture.grain = grain;
        return maker.draw(picture, display::views_of(camera, picture.bounds, width, height, display::StereoMode::mono));
    }
    std::size_t drawn() { return maker.renderer().drawn_triangles(); }

    geometry::SurfacePatch whole;  ///< all bricks as one
};

/// Bone is white, green or dark; the background is blue.
bool is_bone(const display::Image& image, int x, int y) {
    const std::uint8_t* const p = image.pixel(x, y);
    return p[2] < p[0] + p[1];
}

/// Whether one pixel around this one is as `wanted`.
bool has_near(const display::Image& image, int x, int y, bool wanted) {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
            if (is_bone(image, u, v) == wanted) return true;
    return false;
}

}  // namespace

TEST_CASE("a picture of what moves has far fewer triangles, its outline off by one pixel at most, and no cracks",
          "[slow]") {
    if (!can_render()) return;
    Scene scene;
    for (const display::NamedView from :
         {display::NamedView::iso, display::NamedView::front, display::NamedView::left, display::NamedView::top})
        for (const double zoom : {0.25, 0.5, 1.0, 1.6}) {
            scene.camera.look_from(from);
            scene.camera.fit(scene.picture.bounds, static_cast<double>(width) / height);
            scene.camera.zoom(zoom);
            const display::Image fine = scene.draw(0.0);
            const std::size_t all = scene.drawn();
            const display::Image coarse = scene.draw(display::grain_of_motion);
            INFO(display::view_names[static_cast<std::size_t>(from)] << " at " << zoom);
            // From above the shaft's end is near enough for all of them.
            if (zoom < 0.9) CHECK(scene.drawn() < all / 5);
            else if (from == display::NamedView::top) CHECK(scene.drawn() == all);
            else CHECK(scene.drawn() < all / (zoom < 1.1 ? 5 : 2));
            int bone = 0, off = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    bone += is_bone(fine, x, y);
                    off += !has_near(fine, x, y, is_bone(coarse, x, y));
                }
            CHECK(bone > 200);
            CHECK(off == 0);
        }
}

TEST_CASE("parts beside the picture are not drawn, and nobody sees the difference") {
    if (!can_render()) return;
    Scene scene;
    scene.camera.zoom(6.0);
    const display::Image by_parts = scene.draw(0.0);
    const std::size_t drawn = scene.drawn();
    display::MeshPool& meshes = scene.maker.renderer().meshes();
    CHECK(drawn < meshes.triangles(scene.picture.meshes[0].mesh) / 3);
    const display::MeshPool::Mesh one = meshes.make();
    meshes.set_part(one, 0, scene.whole);
    scene.picture.meshes[0].mesh = one;
    CHECK(scene.draw(0.0).rgb == by_parts.rgb);
    CHECK(scene.drawn() > 3 * drawn);
}

TEST_CASE("near enough to see its triangles, something that moves has all of them") {
    if (!can_render()) return;
    Scene scene;
    scene.camera.zoom(12.0);
    const display::Image still = scene.draw(0.0);
    CHECK(scene.draw(display::grain_of_motion).rgb == still.rgb);
}

TEST_CASE("lit at its vertices, something dense looks as it does lit at each pixel") {
    if (!can_render()) return;
    Scene scene;
    scene.camera.look_from(display::NamedView::iso);
    scene.camera.fit(scene.picture.bounds, static_cast<double>(width) / height);
    for (const bool is_clipped : {false, true}) {
        if (is_clipped)
            scene.picture.clip =
                display::Plane{0.5 * (scene.picture.bounds.low + scene.picture.bounds.high), {1.0, 0.0, 0.0}};
        scene.picture.is_quick = false;
        const display::Image slow = scene.draw(0.0);
        scene.picture.is_quick = true;
        const display::Image quick = scene.draw(0.0);
        double sum = 0.0;
        int far = 0;
        for (std::size_t i = 0; i < slow.rgb.size(); ++i) {
            const int apart = std::abs(static_cast<int>(slow.rgb[i]) - static_cast<int>(quick.rgb[i]));
            sum += apart;
            far += apart > 24;
        }
        INFO((is_clipped ? "clipped" : "whole"));
        CHECK(quick.rgb != slow.rgb);
        CHECK(sum / static_cast<double>(slow.rgb.size()) < 1.0);
        CHECK(static_cast<double>(far) < 0.005 * static_cast<double>(slow.rgb.size()));
    }
}
