// SPDX-License-Identifier: Apache-2.0
// Whether the scene needs another picture: a coarse one while something moves, a fine one when all stands still.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"

#include <cstdint>
#include <span>

namespace tactus::view {

/// The same number for what looks the same: every mesh where it stands, seen from the same place. `mesh_changes`: of the
/// pool that the meshes are in. `legend`: drawn into the picture.
std::uint64_t looks_of(const display::Picture& picture, std::uint64_t mesh_changes,
                       std::span<const display::DrawnView> views, const display::Legend& legend);

class SceneMotion {
public:
    enum class Next { nothing, coarse, fine };

    /// What to draw now, for a scene that looks like that. `has_coarse`: a coarse picture is worth having; without it all
    /// are fine. `is_held`: somebody is about to move it. `now`: s.
    Next next(std::uint64_t looks, bool has_coarse, bool is_held, double now);
    /// The next picture is drawn whatever was before.
    void forget() { is_known_ = false; }

private:
    static constexpr double settles_s = 0.3;

    std::uint64_t looks_ = 0;
    double moved_at_ = 0.0;
    bool is_known_ = false, is_fine_ = false;
};

}  // namespace tactus::view
