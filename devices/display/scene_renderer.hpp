// SPDX-License-Identifier: Apache-2.0
// Draws a scene with OpenGL 3.3 into the bound framebuffer: a window or an offscreen image. Its context must be current
// in every call.
#pragma once

#include "devices/display/mesh_pool.hpp"
#include "devices/display/scan_pool.hpp"
#include "dsp/display/camera.hpp"
#include "dsp/display/screen.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tactus::display {

class GlProgram;

/// A mesh with its pose. World frame: LPS, m.
struct DrawnMesh {
    MeshPool::Mesh mesh = 0;
    Pose pose;
    double opacity = 1.0;  ///< below 1: transparent
    bool is_clipped = true;  ///< cut by the clip plane of the frame
    bool is_closed = false;  ///< never visible from inside: back faces are not drawn
    bool shines_through = false;  ///< faintly visible when occluded: arrows, axes
    ScanPool::Scan scan = -1;  ///< scan drawn on a section of the mesh; -1: the flat section colour
    Pose to_scan = {};  ///< from the frame of the mesh to that of the scan's grid
    Vec3 tint{0.0};  ///< sRGB, blended over the colours of the surface by the fraction `tinted`, 0 to 1
    double tinted = 0.0;
};

/// Level-of-detail cell size during motion, pixels: the outline is off by one pixel at most.
inline constexpr double grain_of_motion = 4.0;

/// The complete content of a frame.
struct Picture {
    std::vector<DrawnMesh> meshes;
    std::vector<geometry::SurfaceVertex>
        points;  ///< dots drawn on top of surfaces less than 2 mm in front of them; normals unused
    double point_size = 7.0;  ///< pixels
    std::optional<Plane> clip;  ///< the positive side is removed; cut bodies show a flat section, or their scan
    Vec3 section{0.72, 0.56, 0.46};  ///< sRGB of a section
    Vec3 sky{0.96, 0.97, 0.98}, ground{0.78, 0.80, 0.83};  ///< sRGB of the background, above and below
    Bounds bounds;  ///< of all meshes
    bool is_quick = false;  ///< lit per vertex instead of per pixel: cheap with software rendering
    double grain = 0.0;  ///< level-of-detail cell size for moving scenes, pixels; 0: all triangles
};

/// The colour channels or buffer that a view writes to.
enum class Channel : std::uint8_t { all, red, cyan, back_left, back_right };

/// One view of a scene in a rectangle of the target, pixels from the lower left.
struct DrawnView {
    Projection projection;
    int x = 0, y = 0, width = 0, height = 0;
    Channel channel = Channel::all;
    Flip flip = Flip::none;  ///< light and background appear from above to the viewer
};

/// The views of a camera: one, or two eyes `separation` m apart that converge at the camera's target. Default
/// separation: a thirtieth of the distance, which is comfortable.
std::vector<DrawnView> views_of(const OrbitCamera& camera, const Bounds& scene, int width, int height, StereoMode mode,
                                std::optional<double> separation = {});
/// Returns the views of one screen of a display: the projection of one eye, or of the left and the right eye.
std::vector<DrawnView> views_of(std::span<const ScreenView> eyes, int width, int height, StereoMode mode,
                                Flip flip = Flip::none);

/// Progress of a frame that is drawn in steps.
struct DrawnSoFar {
    std::size_t view = 0, mesh = 0, side = 0, triangle = 0;  ///< next item to draw; side: of a transparent mesh
    bool is_see_through = false;  ///< the opaque meshes of the view are done
    bool operator==(const DrawnSoFar&) const = default;
};

/// The surface point at a pixel.
struct Picked {
    Vec3 position{0.0};  ///< in the world, m
    std::size_t mesh = 0;  ///< index in Picture::meshes
};

class SceneRenderer {
public:
    /// Throws Error when there is no current context of OpenGL 3.3 or later.
    SceneRenderer();
    ~SceneRenderer();

    /// True for software rendering (Mesa's llvmpipe and softpipe).
    bool is_software() const { return is_software_; }

    MeshPool& meshes() { return *pool_; }
    ScanPool& scans() { return *scans_; }

    /// Clears and draws every view. Skips meshes whose pose is not finite. Afterwards depth test, blending, scissor and
    /// clipping are off, and the colour mask is complete.
    void draw(const Picture& picture, std::span<const DrawnView> views);
    /// Draws at most that many triangles of a frame, starting at `so_far`, which it advances. The last step also draws
    /// the hidden parts of meshes that shine through. The framebuffer must still hold the previous steps, and picture
    /// and views must be unchanged. Returns true when the frame is complete, with the same pixels as by `draw`.
    bool draw_some(const Picture& picture, std::span<const DrawnView> views, DrawnSoFar& so_far,
                   std::size_t max_triangles);
    /// Number of triangles of the last `draw` or `draw_some`.
    std::size_t drawn_triangles() const { return drawn_triangles_; }

    /// Returns the surface point at (x, y) of the target, pixels from the lower left; nothing on the background.
    std::optional<Picked> pick(const Picture& picture, const DrawnView& view, double x, double y);

private:
    struct Programs;
    bool draw_view(const Picture& picture, const DrawnView& view, DrawnSoFar& so_far, std::size_t most);
    bool draw_meshes(const Picture& picture, const DrawnView& view, DrawnSoFar& so_far, std::size_t most);
    void set_section(const GlProgram& program, const Picture& picture, const DrawnView& view,
                     const DrawnMesh& drawn) const;
    void draw_hidden(const Picture& picture, const DrawnView& view);
    void draw_points(const Picture& picture, const Projection& projection);

    std::unique_ptr<Programs> programs_;
    std::unique_ptr<MeshPool> pool_;
    std::unique_ptr<ScanPool> scans_;
    std::size_t drawn_triangles_ = 0;
    bool is_software_ = false;
};

}  // namespace tactus::display
