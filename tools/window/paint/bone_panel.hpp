// SPDX-License-Identifier: Apache-2.0
// The bone in three dimensions, in the colours of its labels: turned, and painted on its surface.
#pragma once

#include "devices/display/scene_renderer.hpp"
#include "tools/window/paint/bone_mesh.hpp"
#include "tools/window/paint/paint_bench.hpp"
#include "tools/window/scene/texture_target.hpp"
#include "tools/window/widgets/painter.hpp"

#include <future>
#include <memory>
#include <optional>
#include <string>

namespace tactus::window {

class BonePanel {
public:
    explicit BonePanel(PaintBench& bench);

    /// Fills the current child window.
    void draw(const Fonts& fonts);
    void look_from(display::NamedView view) { camera_.look_from(view), is_aimed_ = false; }
    bool is_ready() const { return mesh_.has_value(); }
    /// Pixel of a position in the last picture, relative to the window; none behind the eye.
    std::optional<Point> place_of(const Vec3& position) const;

private:
    Vec3 direction_at(Point pixel) const;
    std::optional<Vec3> surface_at(Point pixel) const;
    void steer(Point size);
    void use_tool(Point corner);
    void render(int width, int height);
    void add_vessels();

    PaintBench& bench_;
    std::future<BoneMesh> making_;
    std::optional<BoneMesh> mesh_;
    std::unique_ptr<display::SceneRenderer> renderer_;
    TextureTarget target_;
    display::OrbitCamera camera_;
    display::Picture picture_;
    display::MeshPool::Mesh bone_ = 0;
    std::size_t vessels_ = 0;
    Point corner_, size_{1.0, 1.0};
    std::string shown_, coloured_;
    bool is_aimed_ = false;
};

}  // namespace tactus::window
