// SPDX-License-Identifier: Apache-2.0
// Colours of the scene by gaps or by the distance from the healthy side: computed beside the window, and again
// after each step.
#pragma once

#include "tools/analysis/beside.hpp"
#include "tools/render/surface_map.hpp"
#include "tools/window/document/case_run.hpp"
#include "tools/window/scene/scene_panel.hpp"

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>

namespace tactus::window {

class PlanMap {
public:
    using Kind = render::SurfaceMap::Kind;

    PlanMap(Workbench& bench, CaseRun& run, ScenePanel& scene) : bench_(bench), run_(run), scene_(scene) {}

    /// Once per picture.
    void tend();
    /// None: the fragments have their own colours.
    void show(std::optional<Kind> kind);
    const std::optional<Kind>& shown() const { return kind_; }
    bool is_busy() const { return making_.is_busy(); }
    /// m, distance of the fullest colour.
    double range() const { return range_; }
    void set_range(double range);

private:
    void draw_range();

    Workbench& bench_;
    CaseRun& run_;
    ScenePanel& scene_;
    std::optional<Kind> kind_, made_;  ///< made: what `map_` or `making_` is of
    double range_ = 1e-3;
    std::int64_t of_ = 0;
    std::size_t seen_ = 0;  ///< bodies that were drawn when it was made
    analysis::Beside<render::SurfaceMap> making_;
    double drawn_range_ = 1e-3;
    std::chrono::steady_clock::time_point ranged_at_{}, drawn_at_{};  ///< the range was changed; was drawn
};

}  // namespace tactus::window
