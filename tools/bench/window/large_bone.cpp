// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/window/large_bone.hpp"

#include "devices/display/picture_maker.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "dsp/volume/bricks.hpp"
#include "tools/render/scene_model.hpp"

#include <algorithm>
#include <chrono>

namespace tactus::bench {

PictureCosts picture_costs(const volume::Grid& distance, const volume::Grid& density, int rounds) {
    using Clock = std::chrono::steady_clock;
    PictureCosts costs{0, 800, 600, {}};
    display::PictureMaker maker(costs.width, costs.height);
    display::MeshPool& meshes = maker.renderer().meshes();
    display::Picture picture;
    {
        const volume::BoneEditor editor(distance, density, {.band = 2.2e-3, .max_dirty = 1, .max_versions = 1});
        const volume::BrickLayout& layout = editor.layout();
        picture.meshes.push_back(
            {meshes.make({layout.origin, layout.spacing, volume::brick_cells}), {}, 1.0, true, true});
        geometry::BrickSurface mesher;
        geometry::SurfacePatch patch;
        for (std::uint32_t b = 0; b < static_cast<std::uint32_t>(layout.brick_count()); ++b) {
            mesher.make(editor.current(), b, patch);
            meshes.set_part(picture.meshes.front().mesh, b, patch);
            picture.bounds.add(display::bounds_of(patch));
        }
    }
    costs.triangles = meshes.triangles(picture.meshes.front().mesh);
    display::OrbitCamera whole;
    whole.fit(picture.bounds, static_cast<double>(costs.width) / costs.height);
    display::OrbitCamera near = whole;
    near.zoom(5.0);
    const auto cost = [&](const char* what, const display::OrbitCamera& camera, double grain) {
        picture.grain = grain;
        const auto views =
            display::views_of(camera, picture.bounds, costs.width, costs.height, display::StereoMode::mono);
        maker.draw(picture, views);
        double best = 1e30;
        for (int round = 0; round < std::max(rounds, 2); ++round) {
            const auto begin = Clock::now();
            maker.draw(picture, views);
            best = std::min(best, std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
        }
        costs.pictures.push_back({what, best, maker.renderer().drawn_triangles()});
    };
    cost("all of it, still", whole, 0.0);
    cost("all of it, moving", whole, display::grain_of_motion);
    cost("near, still", near, 0.0);
    cost("near, moving", near, display::grain_of_motion);
    return costs;
}

}  // namespace tactus::bench
