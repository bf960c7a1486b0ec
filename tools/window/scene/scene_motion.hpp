// SPDX-License-Identifier: Apache-2.0
// Decides when to redraw the scene: coarsely while it moves, finely when it is still.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::window {

/// A hash of everything that affects the picture: meshes, poses, views and legend. `mesh_changes`: counter of the mesh
/// pool.
std::uint64_t looks_of(const display::Picture& picture, std::uint64_t mesh_changes,
                       std::span<const display::DrawnView> views, const display::Legend& legend);

/// How coarsely to draw what moves where the processor draws: as coarsely as its triangles need.
class MotionGrain {
public:
    /// After a picture of what moves, in which so many triangles were drawn.
    void drew(std::size_t triangles);
    /// Cell size of the level of detail, pixels: `display::grain_of_motion`, or larger after pictures with too many
    /// triangles.
    double pixels() const { return pixels_; }
    /// Samples per pixel that such a scene is worth.
    int samples() const { return samples_; }

private:
    double pixels_ = display::grain_of_motion;
    int samples_ = 4;
};

class SceneMotion {
public:
    enum class Next { nothing, coarse, fine };

    /// What to draw now for a scene with this hash. `has_coarse`: coarse pictures are useful; otherwise all are fine.
    /// `is_held`: the user holds the view. `now`: s.
    Next next(std::uint64_t looks, bool has_coarse, bool is_held, double now);
    /// Forces a redraw.
    void forget() { is_known_ = false; }

private:
    static constexpr double settles_s = 0.3;

    std::uint64_t looks_ = 0;
    double moved_at_ = 0.0;
    bool is_known_ = false, is_fine_ = false;
};

}  // namespace tactus::window
