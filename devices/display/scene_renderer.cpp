// SPDX-License-Identifier: Apache-2.0
#include "devices/display/scene_renderer.hpp"

#include "devices/display/gl_program.hpp"
#include "devices/display/scene_shaders.hpp"
#include "dsp/core/error.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace tactus::display {

namespace {

void set(GLint location, const Mat4& value) {
    const glm::mat4 single(value);
    glUniformMatrix4fv(location, 1, GL_FALSE, glm::value_ptr(single));
}
void set(GLint location, const Vec3& value) {
    glUniform3f(location, static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z));
}

float upwards(const DrawnView& view) { return view.flip == Flip::upside_down ? -1.0f : 1.0f; }

/// The clip plane in the frame of the mesh: the negative side is removed.
void set_clip(const GlProgram& program, const Picture& picture, const DrawnMesh& drawn) {
    glm::vec4 plane(0.0f, 0.0f, 0.0f, 1.0f);
    if (picture.clip && drawn.is_clipped) {
        const Pose back = drawn.pose.inverse();
        const Vec3 normal = back.rotate(picture.clip->normal), point = back.apply(picture.clip->point);
        plane = glm::vec4(glm::dvec4(-normal, glm::dot(normal, point)));
    }
    glUniform4fv(program.uniform("keep"), 1, glm::value_ptr(plane));
}

/// From a pixel of the target (x, y, 1) to the point of the clip plane behind it, in homogeneous coordinates of the
/// world. A line from the eye e through q meets the plane P at e (P·q) - q (P·e), which is linear in q.
glm::dmat3x4 onto_plane(const Plane& clip, const DrawnView& view) {
    const Mat4 from_clip = glm::inverse(view.projection.to_clip * view.projection.to_eye);
    // At the far plane; x and y of clip space are linear in the pixel.
    const double wide = 2.0 / view.width, high = 2.0 / view.height;
    const glm::dmat3x4 far{from_clip * glm::dvec4(wide, 0.0, 0.0, 0.0), from_clip * glm::dvec4(0.0, high, 0.0, 0.0),
                           from_clip * glm::dvec4(-1.0 - wide * view.x, -1.0 - high * view.y, 1.0, 1.0)};
    const glm::dvec4 eye = glm::inverse(view.projection.to_eye) * glm::dvec4(0.0, 0.0, 0.0, 1.0);
    const glm::dvec4 plane(clip.normal, -glm::dot(clip.normal, clip.point));
    return (glm::outerProduct(eye, plane) - glm::dot(plane, eye) * Mat4(1.0)) * far;
}

std::string with_lighting(const char* shader) {
    return fmt::format("#version 330 core\n{}{}", scene_shaders::lighting, shader);
}
std::string with_section(const char* shader) { return std::string(scene_shaders::section_colour) + shader; }

void check_version() {
    const GLubyte* const text = glGetString(GL_VERSION);
    GLint major = 0, minor = 0;
    if (text) {
        glGetIntegerv(GL_MAJOR_VERSION, &major);
        glGetIntegerv(GL_MINOR_VERSION, &minor);
    }
    if (!text || major * 10 + minor < 33)
        throw Error(fmt::format("pictures of the scene need OpenGL 3.3; the driver has {}",
                                text ? reinterpret_cast<const char*>(text) : "none"));
}

}  // namespace

struct SceneRenderer::Programs {
    GlProgram background{scene_shaders::background_vertex, scene_shaders::background_fragment};
    GlProgram mesh{scene_shaders::mesh_vertex,
                   with_lighting(with_section(scene_shaders::mesh_fragment).c_str()).c_str()};
    GlProgram quick_mesh{with_lighting(scene_shaders::quick_mesh_vertex).c_str(),
                         ("#version 330 core" + with_section(scene_shaders::quick_mesh_fragment)).c_str()};
    GlProgram points{scene_shaders::point_vertex, scene_shaders::point_fragment};
    GlProgram pick{scene_shaders::mesh_vertex, scene_shaders::pick_fragment};
    GLuint no_attributes = 0, point_array = 0, point_buffer = 0, pick_frame = 0, pick_buffers[2] = {};

    Programs() {
        glGenVertexArrays(1, &no_attributes);
        glGenVertexArrays(1, &point_array);
        glGenBuffers(1, &point_buffer);
    }
    ~Programs() {
        glDeleteVertexArrays(1, &no_attributes);
        glDeleteVertexArrays(1, &point_array);
        glDeleteBuffers(1, &point_buffer);
        glDeleteFramebuffers(1, &pick_frame);
        glDeleteRenderbuffers(2, pick_buffers);
    }
};

std::vector<DrawnView> views_of(const OrbitCamera& camera, const Bounds& scene, int width, int height, StereoMode mode,
                                std::optional<double> separation) {
    const bool halves = mode == StereoMode::side_by_side;
    const double aspect = static_cast<double>(halves ? width / 2 : width) / std::max(height, 1);
    if (mode == StereoMode::mono) return {{camera.projection(aspect, scene), 0, 0, width, height, Channel::all}};
    // Both eyes share a virtual screen at the target.
    const double tall = camera.distance * std::tan(0.5 * camera.vertical_field_of_view_rad);
    const Vec3 right = camera.orientation * Vec3(tall * aspect, 0.0, 0.0);
    const Vec3 up = camera.orientation * Vec3(0.0, tall, 0.0);
    const Screen window{camera.target - right - up, camera.target + right - up, camera.target - right + up};
    const Eyes eyes = eyes_of({camera.eye(), camera.orientation}, separation.value_or(camera.distance / 30.0));
    const ScreenView both[] = {{0, eyes.left, through_screen(window, eyes.left, scene)},
                               {0, eyes.right, through_screen(window, eyes.right, scene)}};
    return views_of(both, width, height, mode);
}

std::vector<DrawnView> views_of(std::span<const ScreenView> eyes, int width, int height, StereoMode mode, Flip flip) {
    if (eyes.size() < 2 || mode == StereoMode::mono)
        return {{eyes.front().projection, 0, 0, width, height, Channel::all, flip}};
    const Projection &left = eyes[0].projection, &right = eyes[1].projection;
    const int half = width / 2;
    switch (mode) {
        case StereoMode::side_by_side:
            return {{left, 0, 0, half, height, Channel::all, flip},
                    {right, half, 0, width - half, height, Channel::all, flip}};
        case StereoMode::anaglyph:
            return {{left, 0, 0, width, height, Channel::red, flip}, {right, 0, 0, width, height, Channel::cyan, flip}};
        default:
            return {{left, 0, 0, width, height, Channel::back_left, flip},
                    {right, 0, 0, width, height, Channel::back_right, flip}};
    }
}

SceneRenderer::SceneRenderer() {
    check_version();
    programs_ = std::make_unique<Programs>();
    scans_ = std::make_unique<ScanPool>();
    pool_ = std::make_unique<MeshPool>();
    is_software_ = is_software_driver();
}

SceneRenderer::~SceneRenderer() = default;

void SceneRenderer::set_section(const GlProgram& program, const Picture& picture, const DrawnView& view,
                                const DrawnMesh& drawn) const {
    const bool is_cut = picture.clip && drawn.is_clipped, has_scan = is_cut && drawn.scan >= 0;
    glUniform1i(program.uniform("is_cut"), is_cut ? 1 : 0);
    glUniform1i(program.uniform("has_scan"), has_scan ? 1 : 0);
    scans_->bind(has_scan ? drawn.scan : -1);
    if (!has_scan) return;
    const glm::dmat3x4 to_scan = scans_->to_texture(drawn.scan) * matrix_of(drawn.to_scan * drawn.pose.inverse()) *
                                 onto_plane(*picture.clip, view);
    // Only directions count; small numbers keep their digits in single precision.
    const double size = std::abs(to_scan[2][3]) > 0.0 ? std::abs(to_scan[2][3]) : 1.0;
    const glm::mat3x4 single(to_scan / size);
    glUniformMatrix3x4fv(program.uniform("to_scan"), 1, GL_FALSE, glm::value_ptr(single));
}

/// The opaque meshes, or those that are not; true: all of them.
bool SceneRenderer::draw_meshes(const Picture& picture, const DrawnView& view, DrawnSoFar& so_far, std::size_t most) {
    const Projection& projection = view.projection;
    const GlProgram& program = picture.is_quick ? programs_->quick_mesh : programs_->mesh;
    program.use();
    set(program.uniform("to_clip"), projection.to_clip);
    set(program.uniform("section"), picture.section);
    glUniform2f(program.uniform("way"), view.flip == Flip::left_right ? -1.0f : 1.0f, upwards(view));
    // Back faces first, so that transparent bodies are blended in a fixed order.
    constexpr std::array hidden_sides{GL_FRONT, GL_BACK};
    const std::size_t sides = so_far.is_see_through ? hidden_sides.size() : 1;
    for (; so_far.mesh < picture.meshes.size(); ++so_far.mesh) {
        const DrawnMesh& drawn = picture.meshes[so_far.mesh];
        if ((drawn.opacity < 1.0) != so_far.is_see_through || !is_valid(drawn.pose)) continue;
        const Mat4 to_eye = projection.to_eye * matrix_of(drawn.pose);
        set(program.uniform("to_eye"), to_eye);
        glUniform1f(program.uniform("opacity"), static_cast<float>(drawn.opacity));
        set_clip(program, picture, drawn);
        set_section(program, picture, view, drawn);
        glUniform4f(program.uniform("tint"), static_cast<float>(drawn.tint.x), static_cast<float>(drawn.tint.y),
                    static_cast<float>(drawn.tint.z), static_cast<float>(drawn.tinted));
        for (; so_far.side < sides; ++so_far.side) {
            const std::size_t left = most - std::min(most, drawn_triangles_);
            if (left == 0) return false;
            const bool is_culled = so_far.is_see_through || (drawn.is_closed && !picture.clip);
            if (is_culled) glEnable(GL_CULL_FACE);
            glCullFace(so_far.is_see_through ? hidden_sides[so_far.side] : GL_BACK);
            const std::size_t now = pool_->draw(drawn.mesh, projection.to_clip * to_eye, view.width, view.height,
                                                picture.grain, {so_far.triangle, left});
            glDisable(GL_CULL_FACE);
            drawn_triangles_ += now;
            so_far.triangle += now;
            if (now == left) return false;
            so_far.triangle = 0;
        }
        so_far.side = 0;
    }
    so_far.mesh = 0;
    return true;
}

/// Draws the occluded part of meshes that shine through.
void SceneRenderer::draw_hidden(const Picture& picture, const DrawnView& view) {
    Picture hidden;
    hidden.is_quick = picture.is_quick;
    for (const DrawnMesh& drawn : picture.meshes)
        if (drawn.shines_through) hidden.meshes.push_back({drawn.mesh, drawn.pose, 0.3, false, false, false});
    if (hidden.meshes.empty()) return;
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    DrawnSoFar none;
    none.is_see_through = true;
    draw_meshes(hidden, view, none, std::numeric_limits<std::size_t>::max());
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
}

void SceneRenderer::draw_points(const Picture& picture, const Projection& projection) {
    if (picture.points.empty()) return;
    glBindVertexArray(programs_->point_array);
    glBindBuffer(GL_ARRAY_BUFFER, programs_->point_buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(picture.points.size() * sizeof(geometry::SurfaceVertex)),
                 picture.points.data(), GL_STREAM_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(geometry::SurfaceVertex), nullptr);
    glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(geometry::SurfaceVertex),
                          reinterpret_cast<const void*>(offsetof(geometry::SurfaceVertex, colour)));
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(2);
    const GlProgram& program = programs_->points;
    program.use();
    set(program.uniform("to_eye"), projection.to_eye);
    set(program.uniform("to_clip"), projection.to_clip);
    glUniform1f(program.uniform("size"), static_cast<float>(picture.point_size));
    glEnable(GL_PROGRAM_POINT_SIZE);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(picture.points.size()));
    glDisable(GL_PROGRAM_POINT_SIZE);
}

/// From where it was left; true: all of it.
bool SceneRenderer::draw_view(const Picture& picture, const DrawnView& view, DrawnSoFar& so_far, std::size_t most) {
    const bool red = view.channel != Channel::cyan, cyan = view.channel != Channel::red;
    if (view.channel == Channel::back_left) glDrawBuffer(GL_BACK_LEFT);
    if (view.channel == Channel::back_right) glDrawBuffer(GL_BACK_RIGHT);
    glColorMask(red, cyan, cyan, GL_TRUE);
    glViewport(view.x, view.y, view.width, view.height);
    glScissor(view.x, view.y, view.width, view.height);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    const bool is_begun = so_far.is_see_through || so_far.mesh > 0 || so_far.triangle > 0;
    if (!is_begun) {
        glClear(GL_DEPTH_BUFFER_BIT);
        glDisable(GL_DEPTH_TEST);
        programs_->background.use();
        set(programs_->background.uniform("sky"), picture.sky);
        set(programs_->background.uniform("ground"), picture.ground);
        glUniform1f(programs_->background.uniform("upwards"), upwards(view));
        glBindVertexArray(programs_->no_attributes);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CLIP_DISTANCE0);
    glFrontFace(view.projection.is_mirrored ? GL_CW : GL_CCW);
    if (!so_far.is_see_through) {
        if (!draw_meshes(picture, view, so_far, most)) return false;
        draw_points(picture, view.projection);
        so_far.is_see_through = true;
    }
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (!draw_meshes(picture, view, so_far, most)) return false;
    draw_hidden(picture, view);
    return true;
}

void SceneRenderer::draw(const Picture& picture, std::span<const DrawnView> views) {
    DrawnSoFar none;
    draw_some(picture, views, none, std::numeric_limits<std::size_t>::max());
}

bool SceneRenderer::draw_some(const Picture& picture, std::span<const DrawnView> views, DrawnSoFar& so_far,
                              std::size_t max_triangles) {
    drawn_triangles_ = 0;
    glEnable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    for (; so_far.view < views.size(); so_far = {so_far.view + 1}) {
        const DrawnView& view = views[so_far.view];
        if (view.width < 1 || view.height < 1) continue;
        if (!draw_view(picture, view, so_far, max_triangles)) break;
    }
    glFrontFace(GL_CCW);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    for (const GLenum what : {GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_CLIP_DISTANCE0}) glDisable(what);
    glBindVertexArray(0);
    return so_far.view == views.size();
}

std::optional<Picked> SceneRenderer::pick(const Picture& picture, const DrawnView& view, double x, double y) {
    const double u = 2.0 * (x - view.x) / std::max(view.width, 1) - 1.0;
    const double v = 2.0 * (y - view.y) / std::max(view.height, 1) - 1.0;
    if (!(std::abs(u) <= 1.0 && std::abs(v) <= 1.0)) return std::nullopt;
    GLint frame_before = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &frame_before);
    if (programs_->pick_frame == 0) {
        glGenFramebuffers(1, &programs_->pick_frame);
        glBindFramebuffer(GL_FRAMEBUFFER, programs_->pick_frame);
        glGenRenderbuffers(2, programs_->pick_buffers);
        const std::pair<GLenum, GLenum> kinds[] = {{GL_R32UI, GL_COLOR_ATTACHMENT0},
                                                   {GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT}};
        for (std::size_t i = 0; i < 2; ++i) {
            glBindRenderbuffer(GL_RENDERBUFFER, programs_->pick_buffers[i]);
            glRenderbufferStorage(GL_RENDERBUFFER, kinds[i].first, 1, 1);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, kinds[i].second, GL_RENDERBUFFER, programs_->pick_buffers[i]);
        }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, programs_->pick_frame);
    glViewport(0, 0, 1, 1);
    const GLuint nothing[4] = {};
    const GLfloat farthest = 1.0f;
    glClearBufferuiv(GL_COLOR, 0, nothing);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    // The picked pixel is scaled to the whole target.
    const Mat4 to_clip = glm::scale(Mat4(1.0), Vec3(view.width, view.height, 1.0)) *
                         glm::translate(Mat4(1.0), Vec3(-u, -v, 0.0)) * view.projection.to_clip;
    const GlProgram& program = programs_->pick;
    program.use();
    set(program.uniform("to_clip"), to_clip);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CLIP_DISTANCE0);
    for (std::size_t i = 0; i < picture.meshes.size(); ++i) {
        const DrawnMesh& drawn = picture.meshes[i];
        // Arrows, axes and the boxes of chosen parts are signs, not surfaces.
        if (drawn.opacity < 1.0 || drawn.shines_through || !is_valid(drawn.pose)) continue;
        const Mat4 to_eye = view.projection.to_eye * matrix_of(drawn.pose);
        set(program.uniform("to_eye"), to_eye);
        set_clip(program, picture, drawn);
        glUniform1ui(program.uniform("number"), static_cast<GLuint>(i + 1));
        pool_->draw(drawn.mesh, to_clip * to_eye, 1, 1, 0.0);
    }
    GLuint number = 0;
    GLfloat depth = 1.0f;
    glReadPixels(0, 0, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, &number);
    glReadPixels(0, 0, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CLIP_DISTANCE0);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(frame_before));
    if (number == 0) return std::nullopt;
    const glm::dvec4 at = glm::inverse(view.projection.to_clip * view.projection.to_eye) *
                          glm::dvec4(u, v, 2.0 * static_cast<double>(depth) - 1.0, 1.0);
    return Picked{Vec3(at) / at.w, number - 1};
}

}  // namespace tactus::display
