// SPDX-License-Identifier: Apache-2.0
// Bodies of a scene: free, held, chosen, and where they would fit.
#include "assets/plan/plan_file.hpp"
#include "devices/display/shapes.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/leaving.hpp"
#include "tools/render/node_of.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/scene_model.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::render {

using namespace scene_colours;

namespace {

constexpr std::uint64_t max_in_legend = 6;

}  // namespace

void SceneModel::take_names() {
    for (const SceneOutline::Bodies& scene : outline_.scenes) {
        if (scene.plan.empty() || named_.contains(scene.plan)) continue;
        std::vector<NamedBody>& named = named_[scene.plan];
        try {
            const plan::CasePlan plan = plan::load_case_plan(scene.plan);
            // A plan that gives several the same colour says too little about them.
            bool is_coloured = true;
            for (std::size_t a = 0; a < plan.fragments.size(); ++a)
                for (std::size_t b = 0; b < a; ++b)
                    is_coloured = is_coloured && plan.fragments[a].colour != plan.fragments[b].colour;
            for (const plan::PlanFragment& fragment : plan.fragments)
                named.push_back({fragment.name, is_coloured ? std::optional(fragment.colour) : std::nullopt});
            use_hardware(plan::state_of(plan).reconstruction, std::filesystem::path(scene.plan).parent_path());
            take_vessels(scene.plan, scene.plan, plan);
        } catch (const Error&) {
            named.clear();  // the run says what is wrong
            use_hardware(nullptr);
        }
    }
}

std::string SceneModel::name_of_body(const SceneOutline::Bodies& scene, std::size_t place) const {
    if (const auto named = named_.find(scene.plan); named != named_.end() && place < named->second.size())
        return named->second[place].name;
    return place < scene.bodies.size() ? node_of(scene.bodies[place]) : fmt::format("fragment {}", place + 1);
}

Vec3 SceneModel::colour_of_body(const std::string& name, const SceneOutline::Bodies& scene, std::size_t place) const {
    if (const auto given = look_.colours.find(name); given != look_.colours.end()) return given->second;
    const auto named = named_.find(scene.plan);
    if (named != named_.end() && place < named->second.size() && named->second[place].colour)
        return *named->second[place].colour;
    return group_colours[place % group_colours.size()];
}

void SceneModel::colour_part(const std::string& name, const Vec3& colour) { look_.colours[name] = colour; }

void SceneModel::use_map(std::shared_ptr<const SurfaceMap> map, double range) {
    if (map == map_ && (!map || range == map_range_)) return;
    map_ = std::move(map);
    map_range_ = range;
    ++map_number_;
}

std::vector<std::shared_ptr<const observe::SeenBody>> SceneModel::plan_bodies() const {
    std::vector<std::shared_ptr<const observe::SeenBody>> all;
    for (const SceneOutline::Bodies& scene : outline_.scenes) {
        const auto seen = scene.plan.empty() ? std::nullopt : observer_.latest<observe::SeenScene>(scene.port);
        if (!seen) continue;
        for (std::size_t i = 0; i < seen->value.count; ++i) {
            const auto known = bodies_.find(seen->value.objects[i].body);
            all.push_back(known != bodies_.end() ? known->second.body : nullptr);
        }
        break;
    }
    return all;
}

std::vector<std::optional<Pose>> SceneModel::plan_poses() const {
    std::vector<std::optional<Pose>> all;
    for (const SceneOutline::Bodies& scene : outline_.scenes) {
        const auto seen = scene.plan.empty() ? std::nullopt : observer_.latest<observe::SeenScene>(scene.port);
        if (!seen) continue;
        for (std::size_t i = 0; i < seen->value.count; ++i) {
            const observe::SeenScene::Object& object = seen->value.objects[i];
            const auto known = bodies_.find(object.body);
            all.emplace_back();
            if (object.body != 0 && known != bodies_.end() && known->second.body && is_valid(object.pose))
                all.back() =
                    i < moved_.size() && moved_[i] ? *moved_[i] : object.pose * known->second.body->home.inverse();
        }
        break;
    }
    return all;
}

void SceneModel::take_body(const MadeBody& made) {
    BodyMesh& mesh = bodies_[made.look.body->content_hash];
    if (mesh.mesh < 0) mesh.mesh = renderer_.meshes().make(made.grid);
    mesh.body = made.look.body;
    mesh.colour = made.look.colour;
    mesh.map = made.look.map_number;
    mesh.field = made.field;
    mesh.has_paint = made.surface.has_paint;
    mesh.bounds = made.surface.bounds;
    renderer_.meshes().set_part(mesh.mesh, 0, made.surface.patch, made.levels);
}

/// One that cannot be drawn does not keep the others from it.
void SceneModel::do_not_make(std::uint64_t content, const std::string& why) { unmade_[content] = why; }

/// Null: it was not seen, or is being made. Until new colours are made, it has those before.
SceneModel::BodyMesh* SceneModel::mesh_of(std::uint64_t content, const Vec3& colour) {
    const auto known = bodies_.find(content);
    const bool is_known = known != bodies_.end();
    if (is_known && known->second.colour == colour && known->second.map == map_number_) return &known->second;
    BodyLook look{is_known ? known->second.body : nullptr, colour, map_, map_range_, map_number_};
    for (const auto& body : observer_.bodies())
        if (!look.body && body->content_hash == content && !body->distance.values.empty()) look.body = body;
    if (!look.body) return nullptr;
    if (!is_spread_) try {
            take_body(make_body(std::move(look)));
        } catch (const Error& error) {
            do_not_make(content, error.message());
        }
    else if (!making_.is_busy()) {
        made_body_ = content;
        making_.begin(analysis::Lane::scene,
                      analysis::leaving([look = std::move(look)]() mutable { return make_body(std::move(look)); }));
    }
    const auto now = bodies_.find(content);
    return now == bodies_.end() ? nullptr : &now->second;
}

void SceneModel::show_bodies() {
    shown_.clear();
    pieces_.clear();
    std::unordered_set<std::uint64_t> told;  // bodies whose problem is in the legend
    bool has_paint = false, has_old_colours = false;
    // The scene with the most bodies first: bodies that other scenes share with it are not drawn twice.
    std::vector<const SceneOutline::Bodies*> scenes;
    for (const auto& scene : outline_.scenes) scenes.push_back(&scene);
    std::ranges::stable_sort(scenes, std::greater{}, [](const auto* scene) { return scene->bodies.size(); });
    for (const SceneOutline::Bodies* scene : scenes) {
        const auto seen = observer_.latest<observe::SeenScene>(scene->port);
        is_waiting_ = is_waiting_ || !seen || seen->value.count == 0;
        if (!seen) continue;
        if (!scene->plan.empty() && seen->value.count != std::exchange(fragment_count_, seen->value.count)) {
            // The fragments of an opened plan appear one after another: the bounds are those of all.
            is_fitting_ = true;
            waits_ = 0;
        }
        const std::unordered_set<std::uint64_t> of_others = shown_;
        for (std::size_t i = 0; i < seen->value.count; ++i) {
            const auto& object = seen->value.objects[i];
            if (of_others.contains(object.body) || (object.body == 0 && scene->plan.empty())) continue;
            const std::string name = name_of_body(*scene, i);
            const Vec3 colour = colour_of_body(name, *scene, i);
            if (object.body == 0) {
                // Scenes of two ports may be of one plan.
                if (std::ranges::find(parts_, name, &Part::name) != parts_.end()) continue;
                is_part_shown(name, colour);
                parts_.back().place = static_cast<int>(i);
                parts_.back().is_out_of_plan = true;
                continue;
            }
            if (const auto why = unmade_.find(object.body); why != unmade_.end()) {
                if (told.insert(object.body).second)
                    legend_.warnings.push_back(fmt::format("{} is not drawn: {}", name, why->second));
                continue;
            }
            // Two bodies of one shape share a mesh, which has the colours of the first.
            const bool is_first = shown_.insert(object.body).second;
            const auto known = bodies_.find(object.body);
            BodyMesh* mesh = is_first                 ? mesh_of(object.body, colour)
                             : known != bodies_.end() ? &known->second
                                                      : nullptr;
            is_waiting_ = is_waiting_ || !mesh;
            if (!mesh) continue;
            Pose pose = object.pose;
            const SceneOutline::Held* held = nullptr;
            for (const auto& candidate : outline_.held)
                // Nothing is held by a node that does not run.
                if (candidate.scene == scene->port &&
                    (candidate.place.empty() || observer_.latest<double>(candidate.place)) &&
                    std::lround(number_of(candidate.place, candidate.held)) == static_cast<long>(i))
                    held = &candidate;
            // The pose from the node that holds a body takes precedence.
            const auto hand = held ? pose_of(held->hand) : std::nullopt;
            if (held)
                if (const auto now = pose_of(held->pose)) pose = *now;
            if (!scene->plan.empty() && i < moved_.size() && moved_[i]) pose = *moved_[i] * mesh->body->home;
            if (!scene->plan.empty()) content_at_[i] = object.body;
            const bool is_shown = is_part_shown(name, colour);
            Part& part = parts_.back();
            part.place = static_cast<int>(i);
            part.unit = object.unit;
            part.fits = object.hangs_on;
            part.is_locked = object.stands == 1 && object.hangs_on < 0 && !scene->plan.empty();
            part.is_held = held != nullptr;
            if (!is_shown) continue;
            // A long legend would cover the scene.
            if (held || seen->value.count <= max_in_legend)
                legend_.entries.push_back({name + (held ? ", held" : ""), colour});
            if (!is_valid(pose)) {
                legend_.warnings.push_back(fmt::format("{} has no valid pose: not drawn", name));
                continue;
            }
            part_of_mesh_.emplace_back(picture_.meshes.size(), name);
            show(mesh->mesh, pose, mesh->bounds);
            if (!is_first && !map_ && mesh->colour != colour) {
                picture_.meshes.back().tint = colour;
                picture_.meshes.back().tinted = 1.0;
            }
            find_scan(*mesh, *scene, i);
            show_scan(mesh->scan, mesh->body->home);
            if (!scene->plan.empty()) pieces_[i] = {mesh->body, colour, pose, is_chosen(name)};
            if (is_chosen(name)) mark(mesh->bounds, pose);
            has_paint = has_paint || mesh->has_paint;
            has_old_colours = has_old_colours || mesh->map != map_number_;
            if (!held) continue;
            if (hand) {
                // The pose commanded by the hand, if it differs.
                const Pose grip = held->grip.empty() ? held->grip_at : pose_of(held->grip).value_or(held->grip_at);
                const Pose wanted = *hand * grip;
                const double apart = glm::length(wanted.position - pose.position) +
                                     mesh->bounds.radius() *
                                         glm::length(glm::axis(glm::conjugate(pose.orientation) * wanted.orientation)) *
                                         std::abs(glm::angle(glm::conjugate(pose.orientation) * wanted.orientation));
                if (apart > 0.2e-3) show(mesh->mesh, wanted, mesh->bounds, 0.22, false, false);
                show_force(held->wrench, hand->position);
            } else {
                show_force(held->wrench, pose.position);
            }
            show_penetration(*mesh, pose, i, seen->value);
        }
    }
    if (map_)
        for (display::Legend::Scale& scale : map_scales(map_->kind, map_range_)) legend_.scales.push_back(scale);
    if (has_old_colours) legend_.warnings.push_back("the fragments still get their new colours ...");
    if (has_paint) legend_.entries.push_back({"painted fracture", paint_colour});
}

bool SceneModel::is_chosen(const std::string& name) const {
    return std::ranges::find(look_.chosen, name) != look_.chosen.end();
}

/// The bounding box of a chosen part.
void SceneModel::mark(const display::Bounds& bounds, const Pose& pose) {
    const std::array<Vec3, 8> corners = bounds.corners();
    const double thick = 0.006 * bounds.radius();
    for (std::size_t a = 0; a < corners.size(); ++a)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const std::size_t b = a ^ (std::size_t{1} << axis); b > a) {
                const Vec3 low = glm::min(corners[a], corners[b]) - Vec3(thick),
                           high = glm::max(corners[a], corners[b]) + Vec3(thick);
                display::add_box(notes_, low, high, hand_colour, pose);
            }
}

/// Where the held fragment would fit, seen through.
void SceneModel::show_targets() {
    for (const auto& target : outline_.targets) {
        const auto fits = observer_.latest<bool>(target.fits);
        const auto scene = observer_.latest<observe::SeenScene>(target.scene);
        const long place = std::lround(number_of(target.place, -1.0));
        if (!fits || !fits->value || !scene || place < 0 || place >= static_cast<long>(scene->value.count)) continue;
        const auto pose = pose_of(target.pose);
        const auto body = bodies_.find(scene->value.objects[static_cast<std::size_t>(place)].body);
        if (!pose || body == bodies_.end()) continue;
        show(body->second.mesh, *pose, body->second.bounds, 0.35, false, false);
        const auto from = std::ranges::find(outline_.scenes, target.scene, &SceneOutline::Bodies::port);
        const std::string name = from == outline_.scenes.end() ? fmt::format("fragment {}", place + 1)
                                                               : name_of_body(*from, static_cast<std::size_t>(place));
        legend_.entries.push_back({fmt::format("see-through: where {} fits", name), hand_colour});
    }
}

void SceneModel::compare(std::vector<std::optional<Pose>> poses, const std::string& name) {
    compared_ = std::move(poses);
    compared_name_ = name;
}

/// What lies alike is drawn once. A fragment that was never shown has no surface yet.
void SceneModel::show_compared() {
    if (compared_.empty()) return;
    const std::vector<std::optional<Pose>> here = plan_poses();
    bool is_any = false;
    for (std::size_t n = 0; n < compared_.size(); ++n) {
        const auto content = content_at_.find(n);
        const auto known = content == content_at_.end() ? bodies_.end() : bodies_.find(content->second);
        if (!compared_[n] || known == bodies_.end()) continue;
        const BodyMesh& mesh = known->second;
        const auto at = [&](const Pose& file) { return file.apply(mesh.body->home.position); };
        if (n < here.size() && here[n]) {
            const Quat turn = glm::conjugate(here[n]->orientation) * compared_[n]->orientation;
            const double apart = glm::length(at(*here[n]) - at(*compared_[n])) +
                                 2.0 * mesh.bounds.radius() * glm::length(Vec3(turn.x, turn.y, turn.z));
            if (apart < 0.05e-3) continue;
        }
        show(mesh.mesh, *compared_[n] * mesh.body->home, mesh.bounds, 0.5, true, false);
        picture_.meshes.back().tint = compared_colour;
        picture_.meshes.back().tinted = 1.0;
        is_any = true;
    }
    if (is_any) legend_.entries.push_back({fmt::format("see-through: {}", compared_name_), compared_colour});
}

/// Points of the held body that penetrate another body.
void SceneModel::show_penetration(const BodyMesh& held, const Pose& pose, std::size_t place,
                                  const observe::SeenScene& scene) {
    constexpr double worst = 0.5e-3;
    for (std::size_t i = 0; i < scene.count; ++i) {
        const auto other = bodies_.find(scene.objects[i].body);
        if (i == place || other == bodies_.end() || !is_valid(scene.objects[i].pose)) continue;
        const Pose into = scene.objects[i].pose.inverse() * pose;
        for (const Vec3& point : held.body->points) {
            const double depth = -other->second.field.sample(into.apply(point)).value;
            if (!(depth > 2e-6)) continue;
            deepest_ = std::max(deepest_, depth);
            const Vec3 at = pose.apply(point);
            const Vec3 colour = glm::mix(Vec3(1.0, 0.80, 0.10), Vec3(0.85, 0.05, 0.05), std::min(depth / worst, 1.0));
            picture_.points.push_back({{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
                                       {},
                                       geometry::packed_colour(colour)});
        }
    }
}

}  // namespace tactus::render
