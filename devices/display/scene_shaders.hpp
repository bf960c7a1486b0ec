// SPDX-License-Identifier: Apache-2.0
// The shaders of the scene. Lighting is computed in linear RGB and converted to sRGB.
#pragma once

namespace tactus::display::scene_shaders {

inline constexpr const char* background_vertex = R"(#version 330 core
out float height;
uniform float upwards;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    height = 0.5 + 0.5 * corner.y * upwards;
    gl_Position = vec4(corner, 0.0, 1.0);
})";

inline constexpr const char* background_fragment = R"(#version 330 core
in float height;
uniform vec3 sky, ground;
out vec4 colour;
void main() { colour = vec4(mix(ground, sky, height), 1.0); })";

// `keep`: a plane in the frame of the mesh; its negative side is removed.
inline constexpr const char* mesh_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 to_eye, to_clip;
uniform vec4 keep;
out vec3 eye_position, eye_normal;
out vec4 surface;
void main() {
    vec4 at = to_eye * vec4(position, 1.0);
    eye_position = at.xyz;
    eye_normal = mat3(to_eye) * normal;
    surface = colour;
    gl_ClipDistance[0] = dot(keep, vec4(position, 1.0));
    gl_Position = to_clip * at;
})";

// The lights move with the camera: key light from the upper left, fill light from the right, rim light from behind;
// `way` flips them for images seen in a mirror. `v` points to the eye.
inline constexpr const char* lighting = R"(
uniform vec2 way;
vec3 lit(vec3 n, vec3 v, vec3 surface) {
    vec3 key = normalize(vec3(-0.45 * way.x, 0.65 * way.y, 0.65));
    vec3 fill = normalize(vec3(0.85 * way.x, 0.05 * way.y, 0.35));
    float diffuse = 0.78 * max(dot(n, key), 0.0) + 0.24 * max(dot(n, fill), 0.0);
    float ambient = 0.17 + 0.08 * n.y * way.y;
    float gloss = 0.10 * pow(max(dot(n, normalize(key + v)), 0.0), 48.0);
    float edge = 1.0 - max(dot(n, v), 0.0);
    float rim = 0.10 * pow(edge, 4.0);
    vec3 light = pow(surface, vec3(2.2)) * (diffuse + ambient) * (1.0 - 0.25 * edge * edge) + gloss + rim;
    return pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2));
})";

// A section shows the back faces of the far wall: in a flat colour, or in the grey of the scan where the line of sight
// crosses the plane. `to_scan` maps a pixel to that position in the scan.
inline constexpr const char* section_colour = R"(
uniform vec3 section;
uniform bool is_cut, has_scan;
uniform mat3x4 to_scan;
uniform sampler3D scan;
vec3 cut_colour() {
    if (!has_scan) return section;
    vec4 at = to_scan * vec3(gl_FragCoord.xy, 1.0);
    vec3 place = at.xyz / at.w;
    if (any(lessThan(place, vec3(0.0))) || any(greaterThan(place, vec3(1.0)))) return section;
    return vec3(texture(scan, place).r);
})";

inline constexpr const char* mesh_fragment = R"(
in vec3 eye_position, eye_normal;
in vec4 surface;
uniform float opacity;
uniform vec4 tint;
out vec4 colour;
void main() {
    if (is_cut && !gl_FrontFacing) {
        colour = vec4(cut_colour(), opacity * surface.a);
        return;
    }
    vec3 n = normalize(eye_normal);
    // The face normal decides which side is visible; an interpolated normal may point away at the rim.
    if (dot(n, cross(dFdx(eye_position), dFdy(eye_position))) < 0.0) n = -n;
    colour = vec4(lit(n, normalize(-eye_position), mix(surface.rgb, tint.rgb, tint.a)), opacity * surface.a);
})";

// Lights both sides per vertex: in software rendering that is much cheaper for triangles of a few pixels.
inline constexpr const char* quick_mesh_vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 to_eye, to_clip;
uniform vec4 keep, tint;
out vec4 front;
out vec3 back;
void main() {
    vec4 at = to_eye * vec4(position, 1.0);
    vec3 n = normalize(mat3(to_eye) * normal), v = normalize(-at.xyz);
    vec3 surface = mix(colour.rgb, tint.rgb, tint.a);
    front = vec4(lit(n, v, surface), colour.a);
    back = lit(-n, v, surface);
    gl_ClipDistance[0] = dot(keep, vec4(position, 1.0));
    gl_Position = to_clip * at;
})";

inline constexpr const char* quick_mesh_fragment = R"(
in vec4 front;
in vec3 back;
uniform float opacity;
out vec4 colour;
void main() { colour = vec4(gl_FrontFacing ? front.rgb : is_cut ? cut_colour() : back, opacity * front.a); })";

// Depth is biased towards the viewer, so that dots on a surface stay visible.
inline constexpr const char* point_vertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 colour;
uniform mat4 to_eye, to_clip;
uniform float size;
out vec4 surface;
void main() {
    vec4 at = to_eye * vec4(position, 1.0);
    float away = length(at.xyz);
    at.xyz *= max(away - 0.002, 0.5 * away) / away;
    surface = colour;
    gl_ClipDistance[0] = 1.0;
    gl_PointSize = size;
    gl_Position = to_clip * at;
})";

inline constexpr const char* point_fragment = R"(#version 330 core
in vec4 surface;
out vec4 colour;
void main() {
    vec2 from_middle = 2.0 * gl_PointCoord - 1.0;
    if (dot(from_middle, from_middle) > 1.0) discard;
    colour = surface;
})";

inline constexpr const char* pick_fragment = R"(#version 330 core
uniform uint number;
out uint picked;
void main() { picked = number; })";

}  // namespace tactus::display::scene_shaders
