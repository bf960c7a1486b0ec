// SPDX-License-Identifier: Apache-2.0
#include "devices/display/offscreen.hpp"

#include "devices/display/gl_context.hpp"
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
#include <utility>

namespace tactus {
namespace {

constexpr int max_pixels_per_side = 8192;

constexpr const char* background_vertex = R"(#version 330 core
out float height;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = 0.5 + 0.5 * corner.y;
    gl_Position = vec4(corner, 0.0, 1.0);
})";

constexpr const char* background_fragment = R"(#version 330 core
in float height;
out vec4 colour;
void main() { colour = vec4(mix(vec3(0.80, 0.81, 0.83), vec3(0.96, 0.97, 0.98), height), 1.0); })";

constexpr const char* mesh_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
uniform mat4 to_eye;
uniform mat4 to_clip;
out vec3 eye_position, eye_normal, surface;
void main() {
    vec4 at = to_eye * vec4(position, 1.0);
    eye_position = at.xyz;
    eye_normal = mat3(to_eye) * normal;
    surface = colour;
    gl_Position = to_clip * at;
})";

// Both lights stand with the camera: a key from upper left, a fill from the right. Shading is done in linear light.
constexpr const char* mesh_fragment = R"(#version 330 core
in vec3 eye_position, eye_normal, surface;
out vec4 colour;
void main() {
    vec3 n = normalize(eye_normal);
    vec3 v = normalize(-eye_position);
    // The triangle's own normal decides which side is seen: an interpolated one may point away at the rim.
    if (dot(n, cross(dFdx(eye_position), dFdy(eye_position))) < 0.0) n = -n;
    vec3 key = normalize(vec3(-0.4, 0.6, 0.7));
    vec3 fill = normalize(vec3(0.8, 0.1, 0.4));
    float diffuse = 0.75 * max(dot(n, key), 0.0) + 0.25 * max(dot(n, fill), 0.0);
    float ambient = 0.18 + 0.07 * n.y;
    float gloss = 0.12 * pow(max(dot(n, normalize(key + v)), 0.0), 40.0);
    vec3 light = pow(surface, vec3(2.2)) * (diffuse + ambient) + gloss;
    colour = vec4(pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
})";

GLuint compile(GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        std::array<char, 1024> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()) - 1, nullptr, log.data());
        throw Error(fmt::format("the graphics driver refuses a shader: {}", log.data()));
    }
    return shader;
}

GLuint link(const char* vertex, const char* fragment) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good == 0) throw Error("the graphics driver cannot link a shader");
    return program;
}

/// Colour and depth of `samples` samples per pixel (0: one, without multisampling), bound for drawing.
GLuint make_target(int width, int height, int samples) {
    GLuint frame = 0, buffers[2] = {};
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glGenRenderbuffers(2, buffers);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("the graphics driver cannot make a picture of {} x {} pixels", width, height));
    return frame;
}

void attribute(GLuint location, const std::vector<float>& values) {
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data(),
                 GL_STATIC_DRAW);
    glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(location);
}

void draw(const PictureMesh& mesh) {
    GLuint array = 0, indices = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    attribute(0, mesh.positions);
    attribute(1, mesh.normals);
    attribute(2, mesh.colours);
    glGenBuffers(1, &indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.triangles.size()), GL_UNSIGNED_INT, nullptr);
}

void check(std::span<const PictureMesh> meshes, int width, int height) {
    if (width < 1 || height < 1 || width > max_pixels_per_side || height > max_pixels_per_side)
        throw Error(
            fmt::format("a picture of {} x {} pixels; each side must be 1 to {}", width, height, max_pixels_per_side));
    for (const PictureMesh& mesh : meshes) {
        const std::size_t vertices = mesh.positions.size() / 3;
        if (mesh.positions.size() != 3 * vertices || mesh.normals.size() != 3 * vertices ||
            mesh.colours.size() != 3 * vertices || mesh.triangles.size() % 3 != 0)
            throw Error("a mesh for a picture needs position, normal and colour per vertex and whole triangles");
        if (std::ranges::any_of(mesh.triangles, [&](std::uint32_t v) { return v >= vertices; }))
            throw Error("a mesh for a picture names a vertex that it does not have");
    }
}

/// Nearest and farthest vertex along the line of sight, with a margin: the tighter, the finer the depth buffer.
std::pair<double, double> depth_range(std::span<const PictureMesh> meshes, const View& view) {
    const Vec3 ahead = glm::normalize(view.target - view.eye);
    double near = std::numeric_limits<double>::infinity(), far = 0.0;
    for (const PictureMesh& mesh : meshes)
        for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
            const Vec3 at(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
            const double depth = glm::dot(at - view.eye, ahead);
            near = std::min(near, depth);
            far = std::max(far, depth);
        }
    if (!(far > 0.0)) far = 2.0 * glm::length(view.target - view.eye);
    far *= 1.01;
    return {std::clamp(near * 0.99, far * 1e-4, far * 0.9), far};
}

}  // namespace

View fit_view(const Vec3& low, const Vec3& high, const Vec3& direction, const Vec3& up, double aspect) {
    View view;
    view.target = 0.5 * (low + high);
    view.up = up;
    const double half = 0.5 * view.vertical_field_of_view_rad;
    const double narrow = std::min(half, std::atan(std::tan(half) * aspect));
    const double radius = std::max(0.5 * glm::length(high - low), 1e-6);
    view.eye = view.target - glm::normalize(direction) * (radius / std::sin(narrow));
    return view;
}

Image render_picture(std::span<const PictureMesh> meshes, const View& view, int width, int height) {
    check(meshes, width, height);
    // The context is destroyed at the end, and with it every object made here, also when something throws.
    const SurfacelessContext context;
    GLint most_samples = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    const GLuint resolved = make_target(width, height, 0);
    const GLuint target = make_target(width, height, std::min(most_samples, 4));
    glViewport(0, 0, width, height);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

    GLuint no_attributes = 0;
    glGenVertexArrays(1, &no_attributes);
    glBindVertexArray(no_attributes);
    glUseProgram(link(background_vertex, background_fragment));
    glDrawArrays(GL_TRIANGLES, 0, 3);

    const auto [near, far] = depth_range(meshes, view);
    const glm::mat4 to_eye(glm::lookAt(view.eye, view.target, view.up));
    const glm::mat4 to_clip(glm::perspective(view.vertical_field_of_view_rad,
                                             static_cast<double>(width) / static_cast<double>(height), near, far));
    const GLuint program = link(mesh_vertex, mesh_fragment);
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "to_eye"), 1, GL_FALSE, glm::value_ptr(to_eye));
    glUniformMatrix4fv(glGetUniformLocation(program, "to_clip"), 1, GL_FALSE, glm::value_ptr(to_clip));
    glEnable(GL_DEPTH_TEST);
    for (const PictureMesh& mesh : meshes) draw(mesh);

    glBindFramebuffer(GL_READ_FRAMEBUFFER, target);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    Image image{width, height, std::vector<std::uint8_t>(row * static_cast<std::size_t>(height))};
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
        throw Error(fmt::format("the graphics driver reports error {:#x} for a picture", error));
    // OpenGL's first row is the lowest.
    for (std::size_t top = 0, bottom = static_cast<std::size_t>(height) - 1; top < bottom; ++top, --bottom)
        std::swap_ranges(image.rgb.data() + top * row, image.rgb.data() + (top + 1) * row,
                         image.rgb.data() + bottom * row);
    return image;
}

}  // namespace tactus
