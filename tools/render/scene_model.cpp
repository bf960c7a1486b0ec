// SPDX-License-Identifier: Apache-2.0
#include "tools/render/scene_model.hpp"

#include "assets/bone/bone.hpp"
#include "devices/display/shapes.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/render/node_of.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/section_grey.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <exception>

namespace tactus::render {

using namespace scene_colours;

namespace {

geometry::SurfaceGrid grid_of(const volume::BrickLayout& layout) {
    return {layout.origin, layout.spacing, volume::brick_cells};
}

StillSurface still_surface(const std::string& path, const std::string& name, const std::stop_token& stop) {
    const StopScope scope(stop);
    StillSurface made;
    try {
        const bone::Bone loaded = bone::load_bone(path);
        const volume::BoneEditor editor(loaded.distance, loaded.density,
                                        {.band = 0.003, .max_dirty = 1, .max_versions = 1});
        made.grid = grid_of(editor.layout());
        made.bricks.resize(static_cast<std::size_t>(editor.layout().brick_count()));
        geometry::BrickSurface mesher;
        for (std::size_t brick = 0; brick < made.bricks.size() && !stop.stop_requested(); ++brick)
            mesher.make(editor.current(), static_cast<std::uint32_t>(brick), made.bricks[brick]);
    } catch (const Error& error) {
        made.problem = fmt::format("{} is not drawn: {}", name, error.message());
    }
    return made;
}

}  // namespace

SceneModel::SceneModel(SceneOutline outline, observe::Observer& observer, display::SceneRenderer& renderer)
    : observer_(observer), renderer_(renderer), notes_mesh_(renderer.meshes().make()) {
    follow(std::move(outline));
}

SceneModel::~SceneModel() {
    for (const auto& [name, bone] : bones_) {
        renderer_.meshes().remove(bone.mesh);
        renderer_.scans().remove(bone.scan);
    }
    for (const auto& [path, bone] : still_bones_) {
        if (bone.mesh >= 0) renderer_.meshes().remove(bone.mesh);
        renderer_.scans().remove(bone.scan);
    }
    for (const auto& [hash, body] : bodies_) {
        renderer_.meshes().remove(body.mesh);
        renderer_.scans().remove(body.scan);
    }
    for (const auto& [path, task] : tasks_) remove(task);
    for (const auto& [port, rope] : ropes_) renderer_.meshes().remove(rope.mesh);
    for (const auto& [file, vessels] : vessels_) remove(vessels);
    for (const auto& [name, mesh] : shapes_) renderer_.meshes().remove(mesh);
    for (const HardwareMesh& one : hardware_) renderer_.meshes().remove(one.mesh);
    renderer_.meshes().remove(notes_mesh_);
}

void SceneModel::follow(SceneOutline outline) {
    const std::vector<std::string> before = outline_.ports(), now = outline.ports();
    outline_ = std::move(outline);
    // Existing outputs stay observed: a bone that is observed anew would be sent as a whole.
    for (const std::string& port : before)
        if (!std::ranges::binary_search(now, port)) observer_.watch(port, observe::Watch::nothing);
    for (const std::string& port : now) observer_.watch(port, observe::Watch::latest);
    display::MeshPool& meshes = renderer_.meshes();
    std::erase_if(bones_, [&](const auto& bone) {
        const bool gone =
            std::ranges::none_of(outline_.bones, [&](const auto& kept) { return kept.port == bone.first; });
        if (gone) meshes.remove(bone.second.mesh);
        if (gone) renderer_.scans().remove(bone.second.scan);
        return gone;
    });
    std::erase_if(ropes_, [&](const auto& rope) {
        const bool gone =
            std::ranges::find(outline_.ropes, rope.first, &SceneOutline::Rope::shape) == outline_.ropes.end();
        if (gone) meshes.remove(rope.second.mesh);
        return gone;
    });
    std::erase_if(still_bones_, [&](const auto& bone) {
        const bool gone = std::ranges::find(outline_.still_bones, bone.first, &SceneOutline::StillBone::path) ==
                          outline_.still_bones.end();
        if (gone && bone.second.mesh >= 0) meshes.remove(bone.second.mesh);
        if (gone) renderer_.scans().remove(bone.second.scan);
        return gone;
    });
    std::erase_if(tasks_, [&](const auto& task) {
        const bool gone =
            std::ranges::find(outline_.tasks, task.first, &SceneOutline::Task::path) == outline_.tasks.end();
        if (gone) remove(task.second);
        return gone;
    });
    std::erase_if(bodies_, [&](const auto& body) {
        const bool gone = !shown_.contains(body.first);
        if (gone) meshes.remove(body.second.mesh);
        if (gone) renderer_.scans().remove(body.second.scan);
        return gone;
    });
    for (const auto& [name, mesh] : shapes_) meshes.remove(mesh);
    shapes_.clear();  // the length of a blade may have changed
    forget_vessels();
    plan_written_.reset();  // which vessels are ropes may have changed
    if (std::ranges::all_of(outline_.scenes, [](const auto& scene) { return scene.plan.empty(); }))
        use_hardware(nullptr);
    take_names();
    is_fitting_ = true;
    waits_ = 0;
}

std::size_t SceneModel::triangles() const {
    std::size_t count = 0;
    for (const display::DrawnMesh& drawn : picture_.meshes) count += renderer_.meshes().triangles(drawn.mesh);
    return count;
}

/// A constant mesh, made on first use.
display::MeshPool::Mesh SceneModel::shape_mesh(const std::string& name, const geometry::SurfacePatch& patch) {
    const auto known = shapes_.find(name);
    if (known != shapes_.end()) return known->second;
    const display::MeshPool::Mesh mesh = renderer_.meshes().make();
    renderer_.meshes().set_part(mesh, 0, patch);
    return shapes_[name] = mesh;
}

std::optional<Pose> SceneModel::pose_of(const std::string& port) {
    if (port.empty()) return std::nullopt;
    const auto seen = observer_.latest<Pose>(port);
    if (!seen) return std::nullopt;
    if (is_valid(seen->value)) return seen->value;
    legend_.warnings.push_back(fmt::format("{} is not a valid pose: not drawn", port));
    return std::nullopt;
}

bool SceneModel::is_bone(std::size_t index) const {
    return index < picture_.meshes.size() &&
           std::ranges::any_of(
               bones_, [&](const auto& bone) { return bone.second.mesh == picture_.meshes[index].mesh; });
}

double SceneModel::number_of(const std::string& port, double otherwise) const {
    const auto seen = port.empty() ? std::nullopt : observer_.latest<double>(port);
    return seen && std::isfinite(seen->value) ? seen->value : otherwise;
}

void SceneModel::show(display::MeshPool::Mesh mesh, const Pose& pose, const display::Bounds& local, double opacity,
                      bool is_clipped, bool is_fitted) {
    picture_.meshes.push_back({mesh, pose, opacity, is_clipped, is_clipped && opacity >= 1.0});
    if (local.empty()) return;
    for (const Vec3& corner : local.corners()) {
        picture_.bounds.add(pose.apply(corner));
        if (is_fitting_ && is_fitted) bounds_.add(pose.apply(corner));
    }
}

display::Picture& SceneModel::update() {
    picture_.meshes.clear();
    picture_.points.clear();
    picture_.bounds = {};
    parts_.clear();
    part_of_mesh_.clear();
    legend_ = {};
    legend_.title = outline_.title;
    notes_.vertices.clear();
    notes_.triangles.clear();
    remeshed_ = 0;
    constexpr std::chrono::milliseconds max_work{10};
    until_ = std::chrono::steady_clock::now() + max_work;
    if (making_.is_ready()) try {
            take_body(making_.take());
        } catch (const std::exception& error) {
            do_not_make(made_body_, error.what());
        }
    deepest_ = 0.0;
    if (is_fitting_) bounds_ = {};
    is_waiting_ = false;
    is_making_ = making_.is_busy();
    shows_grey_ = has_made_scan_ = is_making_scan_ = false;
    labels_.clear();
    show_bones();
    show_still_bones();
    show_bodies();
    show_targets();
    show_compared();
    show_hardware();
    show_blades();
    show_balls();
    show_gripper();
    show_guides();
    show_ropes();
    show_vessels();
    show_tasks();
    for (const auto& handle : outline_.handles)
        if (const auto pose = pose_of(handle.pose)) display::add_axes(notes_, *pose, 0.02);
    // They rarely change.
    if (notes_ != shown_notes_) renderer_.meshes().set_part(notes_mesh_, 0, shown_notes_ = notes_);
    show(notes_mesh_, {}, display::bounds_of(notes_), 1.0, false, !outline_.handles.empty());
    picture_.meshes.back().shines_through = true;
    // What never comes must not let the bounds follow the tools for ever.
    constexpr int max_waits = 200;
    is_fitting_ = is_fitting_ && (bounds_.empty() || is_making_ || (is_waiting_ && ++waits_ < max_waits));
    if (shows_grey_) legend_.scales.push_back(section_scale());
    if (deepest_ > 0.0)
        legend_.entries.push_back({fmt::format("penetration, {:.2f} mm at most", deepest_ * 1e3), {0.85, 0.05, 0.05}});
    return picture_;
}

void SceneModel::show_part(const std::string& name, bool wanted) {
    if (wanted) look_.hidden.erase(name);
    else look_.hidden.insert(name);
}

void SceneModel::choose_part(const std::string& name, bool adds) {
    std::vector<std::string>& chosen = look_.chosen;
    const bool was_only = chosen.size() == 1 && chosen.front() == name;
    const auto known = std::ranges::find(chosen, name);
    if (adds && known != chosen.end()) return static_cast<void>(chosen.erase(known));
    if (!adds) chosen.clear();
    if (!name.empty() && !was_only) chosen.push_back(name);
}

std::string SceneModel::part_of(std::size_t index) const {
    for (const auto& [mesh, name] : part_of_mesh_)
        if (mesh == index) return name;
    return {};
}

bool SceneModel::is_part_shown(const std::string& name, const Vec3& colour) {
    parts_.push_back({name, colour, !look_.hidden.contains(name)});
    return parts_.back().is_shown;
}

void SceneModel::show_bones() {
    for (const auto& [port] : outline_.bones) {
        const auto seen = observer_.bone(port);
        is_waiting_ = is_waiting_ || !seen;
        if (!seen) continue;
        BoneMesh& bone = bones_[port];
        const bool is_new = bone.of.lock() != seen;
        if (is_new) {
            if (bone.mesh >= 0) renderer_.meshes().remove(bone.mesh);
            renderer_.scans().remove(bone.scan);
            bone = {renderer_.meshes().make(grid_of(seen->layout)), seen, 0, {}, -1, {}, 0, false, {}, {}};
        }
        const std::vector<std::uint32_t> changed = seen->changed_since(bone.update);
        bone.left.insert(changed.begin(), changed.end());
        bone.update = seen->update;
        if (is_new) bone.bricks = bone.left.size();
        while (!bone.left.empty()) {
            const std::uint32_t brick = bone.left.extract(bone.left.begin()).value();
            mesher_.make(seen->snapshot(), brick, patch_);
            renderer_.meshes().set_part(bone.mesh, brick, patch_);
            if (!bone.is_whole) bone.bounds.add(display::bounds_of(patch_));
            ++remeshed_;
            // A bone that is not seen yet is more urgent than the next picture.
            constexpr std::chrono::milliseconds for_first{40};
            if (!has_time(bone.is_whole ? std::chrono::milliseconds() : for_first)) break;
        }
        bone.is_whole = bone.is_whole || bone.left.empty();
        is_making_ = is_making_ || !bone.is_whole;
        if (!is_part_shown(node_of(port), still_colour)) continue;
        // Not in shreds; the view makes room for all of it.
        if (!bone.is_whole) {
            const volume::BrickLayout& layout = seen->layout;
            bounds_.add(layout.origin);
            bounds_.add(layout.origin + layout.spacing * Vec3(layout.size[0], layout.size[1], layout.size[2]));
            const double done = 1.0 - static_cast<double>(bone.left.size()) / static_cast<double>(bone.bricks);
            legend_.entries.push_back(
                {fmt::format("{}: the surface is being made, {:.0f} %", node_of(port), 1e2 * done), still_colour});
            continue;
        }
        part_of_mesh_.emplace_back(picture_.meshes.size(), node_of(port));
        show(bone.mesh, {}, bone.bounds);
        find_scan(bone, *seen);
        show_scan(bone.scan, {});
        if (legend_.scales.empty()) legend_.scales.push_back(display::density_scale(mesher_.colours));
    }
}

void SceneModel::take_still(StillMesh& bone) {
    if (bone.making.is_busy()) {
        if (!bone.making.is_ready()) return;
        bone.made = bone.making.take();
        bone.is_made = true;
    }
    if (!bone.is_made) return;
    bone.problem = bone.made.problem;
    if (bone.problem.empty() && bone.mesh < 0) bone.mesh = renderer_.meshes().make(bone.made.grid);
    for (; bone.taken < bone.made.bricks.size() && has_time(); ++bone.taken) {
        const geometry::SurfacePatch& patch = bone.made.bricks[bone.taken];
        renderer_.meshes().set_part(bone.mesh, static_cast<std::uint32_t>(bone.taken), patch);
        bone.bounds.add(display::bounds_of(patch));
    }
    if (bone.taken < bone.made.bricks.size()) return;
    bone.is_whole = true;
    bone.made = {};
    bone.taken = 0;
}

void SceneModel::show_still_bones() {
    for (const auto& [name, path, at] : outline_.still_bones) {
        auto known = still_bones_.find(path);
        if (known == still_bones_.end()) {
            known = still_bones_.emplace(path, StillMesh{}).first;
            if (is_spread_)
                known->second.making.begin(analysis::Lane::scene, [path, name](const std::stop_token& stop) {
                    return still_surface(path, name, stop);
                });
            else known->second.made = still_surface(path, name, {});
            known->second.is_made = !is_spread_;
        }
        if (!known->second.is_whole) take_still(known->second);
        if (!known->second.is_whole) {
            is_making_ = true;
            continue;
        }
        if (!known->second.problem.empty()) {
            legend_.warnings.push_back(known->second.problem);
            continue;
        }
        if (!is_part_shown(name, still_colour)) continue;
        part_of_mesh_.emplace_back(picture_.meshes.size(), name);
        show(known->second.mesh, pose_of(at).value_or(Pose{}), known->second.bounds);
        if (has_density_ && known->second.scan < 0)
            if (const auto images = densities_of(path); images.size() == 1) make_scan(known->second.scan, images[0]);
        show_scan(known->second.scan, {});
        if (legend_.scales.empty()) legend_.scales.push_back(display::density_scale(mesher_.colours));
    }
}

void SceneModel::show_force(const std::string& port, const Vec3& at, double ahead) {
    const auto seen = port.empty() ? std::nullopt : observer_.latest<Wrench>(port);
    if (!seen) return;
    const Vec3 force = seen->value.force;
    if (!is_finite(seen->value)) {
        legend_.warnings.push_back(fmt::format("{} is not a number: not drawn", port));
        return;
    }
    const double size = glm::length(force), reach = std::max(bounds_.radius(), 5e-3);
    // A force of 10 N is drawn half as long as the scene.
    legend_.entries.push_back({fmt::format("{}: {:.1f} N (10 N: {:.3g} mm)", port, size, 1e3 * reach), force_colour});
    if (size <= 0.02) return;
    const Vec3 from = at + force * (ahead / size);
    display::add_arrow(notes_, from, from + force * (0.1 * reach), 0.014 * reach, force_colour);
}

}  // namespace tactus::render
