// SPDX-License-Identifier: Apache-2.0
#include "nodes/plan/case_bodies.hpp"

#include <utility>

namespace tactus::nodes {

std::shared_ptr<const BodyParts> body_of_fragment(const bone::Bone& bone) {
    std::vector<contact::SurfacePoint> points = bone.points;
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    for (contact::SurfacePoint& p : points) p.position -= middle;
    volume::Grid field = bone.distance;
    field.origin -= middle;
    return std::make_shared<const BodyParts>(contact::make_pointshell(points), contact::make_voxmap(std::move(field)),
                                             Pose{middle, {1.0, 0.0, 0.0, 0.0}}, false);
}

CaseBodies::CaseBodies(const std::vector<bone::Bone>& bones) {
    for (const bone::Bone& bone : bones) parts_.push_back(body_of_fragment(bone));
}

void CaseBodies::arrange(const fit::Arrangement& now) noexcept {
    scene_.count = parts_.size();
    for (std::size_t n = 0; n < parts_.size(); ++n) {
        const int fragment = static_cast<int>(n);
        coupling::SceneObject& object = scene_.objects[n];
        object.body = now.is_hidden(fragment) ? coupling::Body{} : parts_[n]->body();
        object.body.home = parts_[n]->home;
        object.unit = now.outermost(fragment);
        show_place(now, fragment);
    }
    is_changed_ = true;
}

void CaseBodies::show_unit(const fit::Arrangement& now, int fragment) noexcept {
    for (int n = 0; n < static_cast<int>(parts_.size()); ++n) {
        const int fitted = now.was_fitted_to(n);
        if (now.move_together(fragment, n) || (fitted >= 0 && now.move_together(fragment, fitted))) show_place(now, n);
    }
    is_changed_ = true;
}

void CaseBodies::show_place(const fit::Arrangement& now, int fragment) noexcept {
    coupling::SceneObject& object = scene_.objects[static_cast<std::size_t>(fragment)];
    object.pose = now.pose(fragment) * home(fragment);
    object.stands = now.is_locked(fragment) || now.fitted_to(fragment) != fit::Arrangement::none;
    object.hangs_on = now.is_locked(fragment) ? -1 : now.fitted_to(fragment);
}

const coupling::Scene& CaseBodies::scene() noexcept {
    if (is_changed_) {
        ++scene_.version;
        scene_.content_hash = coupling::hash_of(scene_);
        is_changed_ = false;
    }
    return scene_;
}

}  // namespace tactus::nodes
