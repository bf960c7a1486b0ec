// SPDX-License-Identifier: Apache-2.0
// The pictures of a scene, one for each screen of a display, in tiles of a panel and in windows of their own.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"
#include "tools/render/sight.hpp"
#include "tools/window/scene/screen_window.hpp"
#include "tools/window/scene/texture_target.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace tactus::window {

using render::Sight;

class SceneScreens {
public:
    /// The tile of a screen in the panel, pixels from the upper left.
    struct Tile {
        int x = 0, y = 0, width = 0, height = 0;
        std::uint32_t texture = 0;
        std::uint64_t version = 0;  ///< of what the texture holds
        std::vector<display::DrawnView> views;  ///< viewports in pixels of the picture
        int picture_width = 0, picture_height = 0;
    };

    /// Lays out the screens in a panel of the given size, as large as their aspect ratios allow.
    void lay_out(const Sight& sight, int width, int height);
    const std::vector<Tile>& tiles() const { return tiles_; }

    /// Opens a window for every screen with a monitor or window setting, or for all. Throws Error and then opens none.
    void open(const Sight& sight, bool all);
    void close() { windows_.clear(); }
    bool are_open() const { return !windows_.empty(); }
    /// Closes windows whose close button was pressed.
    void tend();

    /// Computes and returns the views of all screens.
    std::vector<display::DrawnView> aim(Sight& sight, const display::OrbitCamera& camera, const display::Bounds& scene);
    /// Samples per pixel. Without a graphics card, multisampling of many small triangles is slow.
    int samples = 4;
    /// Draws the scene for all screens with the computed views.
    void draw(display::SceneRenderer& renderer, const display::Picture& picture, const Sight& sight,
              const display::Legend& legend);
    /// The same in steps, one with each call, while the tiles show the picture before: for slow pictures, without windows
    /// of their own. `draw` gives up what is not complete.
    void begin_steps();
    void draw_step(display::SceneRenderer& renderer, const display::Picture& picture);
    bool has_steps_left() const { return has_steps_left_; }
    /// How long the step took, s: the next ones are as long as they should be.
    void took(double step_s);
    /// Shows the last picture again in the windows, after they were uncovered or resized.
    void show();

private:
    struct Target {
        std::unique_ptr<TextureTarget> left = std::make_unique<TextureTarget>();
        std::unique_ptr<TextureTarget> next;  ///< what is drawn in steps
        TextureTarget right;
        bool has_two = false;
    };
    struct Opened {
        std::size_t screen = 0;
        std::unique_ptr<ScreenWindow> window;
    };

    ScreenWindow* window_of(std::size_t screen) const;
    void draw_legend(std::size_t screen, TextureTarget& target, const Sight& sight, const display::Legend& legend,
                     std::span<const display::DrawnView> views);

    std::vector<Tile> tiles_;
    std::vector<std::unique_ptr<Target>> targets_;
    std::vector<Opened> windows_;
    bool has_steps_left_ = false;
    std::size_t step_tile_ = 0, step_triangles_ = 20'000;
    display::DrawnSoFar step_;
    std::string legend_text_;
    display::Image legend_image_;
    double legend_scale_ = 0.0;
};

}  // namespace tactus::window
