// SPDX-License-Identifier: Apache-2.0
// A planning case of the bundled fracture.
#pragma once

#include "assets/library/fragments.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "graph/node/assets.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <memory>

namespace tactus::test {

/// The bundled fracture, coarse, its left half locked; a third one, a copy of the left, lies far away.
inline std::shared_ptr<const plan::CaseBones> broken() {
    static const std::shared_ptr<const plan::CaseBones> made = [] {
        auto c = std::make_shared<plan::CaseBones>();
        c->bones = library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm});
        c->bones.push_back(c->bones[0]);
        for (const char* name : {"left", "right", "copy"}) c->plan.fragments.push_back({name, name, 0, Vec3(1.0)});
        plan::PlanStep lock;
        lock.kind = plan::StepKind::lock;
        lock.fragments = {0};
        plan::add_step(c->plan, lock);
        plan::PlanStep away;
        away.fragments = {2};
        away.poses = {{Vec3(0.0, 0.2, 0.0), {1.0, 0.0, 0.0, 0.0}}};
        plan::add_step(c->plan, away);
        return c;
    }();
    return made;
}

/// Where a hand holds the right half, beside its place.
inline const Pose beside{Vec3(2.5, -1.5, 2.0) * mm, rotation_by({0.08, -0.06, 0.07})};

/// How far `pose` takes points of the fracture from where `wanted` takes them, at most, m.
inline double off(const Pose& pose, const Pose& wanted = {}) {
    double most = 0.0;
    for (const Vec3& c : {Vec3(0.0, 0.0, 12.0), Vec3(30.0, 0.0, 0.0), Vec3(0.0, 6.0, -12.0)})
        most = std::max(most, glm::length(pose.apply(c * mm) - wanted.apply(c * mm)));
    return most;
}

}  // namespace tactus::test
