// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/scene_motion.hpp"

#include "dsp/core/hash.hpp"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace tactus::window {

namespace {

void add(Hash& hash, const Vec3& v) { hash.add_bytes(glm::value_ptr(v), sizeof v); }
void add(Hash& hash, const display::Mat4& m) { hash.add_bytes(glm::value_ptr(m), sizeof m); }
void add(Hash& hash, const display::Legend& legend) {
    hash.add_text(legend.title);
    for (const auto& [title, low_text, high_text, low, high] : legend.scales) {
        for (const std::string& text : {title, low_text, high_text}) hash.add_text(text);
        add(hash, low);
        add(hash, high);
    }
    for (const display::Legend::Entry& entry : legend.entries) {
        hash.add_text(entry.text);
        add(hash, entry.colour);
    }
    for (const std::string& warning : legend.warnings) hash.add_text(warning);
}

}  // namespace

std::uint64_t looks_of(const display::Picture& picture, std::uint64_t mesh_changes,
                       std::span<const display::DrawnView> views, const display::Legend& legend) {
    Hash hash;
    hash.add_word(mesh_changes);
    for (const display::DrawnMesh& drawn : picture.meshes) {
        hash.add_word(static_cast<std::uint64_t>(drawn.mesh));
        add(hash, drawn.pose.position);
        hash.add_bytes(glm::value_ptr(drawn.pose.orientation), sizeof drawn.pose.orientation);
        hash.add_bytes(&drawn.opacity, sizeof drawn.opacity);
        hash.add_word(static_cast<std::uint64_t>(drawn.scan));
        add(hash, drawn.tint);
        hash.add_bytes(&drawn.tinted, sizeof drawn.tinted);
    }
    for (const geometry::SurfaceVertex& point : picture.points) hash.add_bytes(&point, sizeof point);
    if (picture.clip) {
        add(hash, picture.clip->point);
        add(hash, picture.clip->normal);
    }
    for (const display::DrawnView& view : views) {
        add(hash, view.projection.to_eye);
        add(hash, view.projection.to_clip);
        for (const int n :
             {view.x, view.y, view.width, view.height, static_cast<int>(view.channel), static_cast<int>(view.flip)})
            hash.add_word(static_cast<std::uint64_t>(n));
    }
    add(hash, legend);
    return hash.value();
}

void MotionGrain::drew(std::size_t triangles) {
    // A level of detail has a quarter to a third of the triangles of the next: fewer than this share of the most come
    // from a level that need not be.
    constexpr std::size_t most = 100'000, few = most / 8, max_smooth = 15'000;
    constexpr double step = 1.5, coarsest = 20.0;
    if (triangles > most) pixels_ = std::min(pixels_ * step, coarsest);
    else if (triangles < few) pixels_ = std::max(pixels_ / step, display::grain_of_motion);
    samples_ = triangles > max_smooth ? 1 : 4;
}

SceneMotion::Next SceneMotion::next(std::uint64_t looks, bool has_coarse, bool is_held, double now) {
    if (!is_known_ || looks != looks_) {
        is_known_ = true;
        looks_ = looks;
        moved_at_ = now;
        is_fine_ = !has_coarse;
        return has_coarse ? Next::coarse : Next::fine;
    }
    if (is_fine_ || is_held || now - moved_at_ < settles_s) return Next::nothing;
    is_fine_ = true;
    return Next::fine;
}

}  // namespace tactus::window
