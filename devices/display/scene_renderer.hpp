// SPDX-License-Identifier: Apache-2.0
// Draws a scene with OpenGL 3.3 into whatever is bound: a window, or a picture without one. The context in which it was
// made must be current in every call.
#pragma once

#include "devices/display/mesh_pool.hpp"
#include "dsp/display/camera.hpp"
#include "dsp/display/screen.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus::display {

/// A mesh where it stands. World frame: LPS, m.
struct DrawnMesh {
    MeshPool::Mesh mesh = 0;
    Pose pose;
    double opacity = 1.0;  ///< below 1 what is behind shines through
    bool is_clipped = true;  ///< by the picture's clip plane
    bool is_closed = false;  ///< nobody sees it from within: what looks away need not be drawn
    bool shines_through = false;  ///< faintly seen also where something stands before it: arrows, axes
};

/// Pixels that the cells of a mesh may be wide while something moves: its outline is off by a pixel at most.
inline constexpr double grain_of_motion = 4.0;

/// Everything that is to be seen.
struct Picture {
    std::vector<DrawnMesh> meshes;
    std::vector<geometry::SurfaceVertex>
        points;  ///< dots that lie on top of what is less than 2 mm before them; normals unused
    double point_size = 7.0;  ///< pixels
    std::optional<Plane> clip;  ///< what is above it is taken away, and cut bodies show a flat section
    Vec3 section{0.72, 0.56, 0.46};  ///< sRGB of a section
    Vec3 sky{0.96, 0.97, 0.98}, ground{0.78, 0.80, 0.83};  ///< sRGB of the background, above and below
    Bounds bounds;  ///< of all of it
    double grain = 0.0;  ///< pixels that the cells of meshes may be wide, for pictures of what moves; 0: every triangle
};

/// Which part of the picture a view may write to.
enum class Channel : std::uint8_t { all, red, cyan, back_left, back_right };

/// One view of a scene in a rectangle of the target, pixels from the lower left.
struct DrawnView {
    Projection projection;
    int x = 0, y = 0, width = 0, height = 0;
    Channel channel = Channel::all;
    Flip flip = Flip::none;  ///< light and background come from above for who sees it
};

/// The views of a camera: one, or two eyes `separation` m apart that meet at the camera's target. By default the eyes
/// are a thirtieth of the distance apart, which is easy on them.
std::vector<DrawnView> views_of(const OrbitCamera& camera, const Bounds& scene, int width, int height, StereoMode mode,
                                std::optional<double> separation = {});
/// The views of a rig that shows one screen in the target: the projections of one eye, or of the left and the right one.
std::vector<DrawnView> views_of(std::span<const RigView> eyes, int width, int height, StereoMode mode,
                                Flip flip = Flip::none);

/// What is seen at a place of the picture.
struct Picked {
    Vec3 position{0.0};  ///< in the world, m
    std::size_t mesh = 0;  ///< number in Picture::meshes
};

class SceneRenderer {
public:
    /// Throws Error when the current context is not OpenGL 3.3 or later, or when there is none.
    SceneRenderer();
    ~SceneRenderer();

    /// Drawn by the processor (Mesa's llvmpipe and softpipe).
    bool is_software() const { return is_software_; }

    MeshPool& meshes() { return *pool_; }

    /// Draws every view after clearing its rectangle. Meshes whose pose is not finite are left out. Leaves depth test,
    /// blending, scissor and clipping off, and the whole colour mask on.
    void draw(const Picture& picture, std::span<const DrawnView> views);
    /// Triangles of the last `draw`.
    std::size_t drawn_triangles() const { return drawn_triangles_; }

    /// The surface point at (x, y) of the target, pixels from the lower left; nothing where there is only background.
    std::optional<Picked> pick(const Picture& picture, const DrawnView& view, double x, double y);

private:
    struct Programs;
    void draw_meshes(const Picture& picture, const DrawnView& view, bool see_through);
    void draw_hidden(const Picture& picture, const DrawnView& view);
    void draw_points(const Picture& picture, const Projection& projection);

    std::unique_ptr<Programs> programs_;
    std::unique_ptr<MeshPool> pool_;
    std::size_t drawn_triangles_ = 0;
    bool is_software_ = false;
};

}  // namespace tactus::display
