// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/view_pictures.hpp"

#include "devices/display/picture_maker.hpp"
#include "dsp/view/brick_surface.hpp"
#include "dsp/volume/bricks.hpp"
#include "tools/picture/scene/scene_model.hpp"

#include <algorithm>
#include <chrono>

namespace tactus::bench {

PictureCosts picture_costs(const Grid& distance, const Grid& density, int rounds) {
    using Clock = std::chrono::steady_clock;
    PictureCosts costs{0, 800, 600, {}};
    PictureMaker maker(costs.width, costs.height);
    MeshPool& meshes = maker.renderer().meshes();
    Picture picture;
    {
        const BoneEditor editor(distance, density, {.band = 2.2e-3, .max_dirty = 1, .max_versions = 1});
        const BrickLayout& layout = editor.layout();
        picture.meshes.push_back({meshes.make({layout.origin, layout.spacing, brick_cells}), {}, 1.0, true, true});
        BrickSurface mesher;
        SurfacePatch patch;
        for (std::uint32_t b = 0; b < static_cast<std::uint32_t>(layout.brick_count()); ++b) {
            mesher.make(editor.current(), b, patch);
            meshes.set_part(picture.meshes.front().mesh, b, patch);
            picture.bounds.add(bounds_of(patch));
        }
    }
    costs.triangles = meshes.triangles(picture.meshes.front().mesh);
    OrbitCamera whole;
    whole.fit(picture.bounds, static_cast<double>(costs.width) / costs.height);
    OrbitCamera near = whole;
    near.zoom(5.0);
    const auto cost = [&](const char* what, const OrbitCamera& camera, double grain) {
        picture.grain = grain;
        const auto views = views_of(camera, picture.bounds, costs.width, costs.height, StereoMode::mono);
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
    cost("all of it, moving", whole, grain_of_motion);
    cost("near, still", near, 0.0);
    cost("near, moving", near, grain_of_motion);
    return costs;
}

}  // namespace tactus::bench
