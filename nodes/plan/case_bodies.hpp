// SPDX-License-Identifier: Apache-2.0
// The fragments of a plan as bodies of a scene.
#pragma once

#include "assets/plan/case_bones.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/fit/arrangement/arrangement.hpp"
#include "nodes/contact/body_parts.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace tactus::nodes {

/// The body of a fragment, with its origin at the mean of its surface points. Throws Error like BodyParts.
std::shared_ptr<const BodyParts> body_of_fragment(const bone::Bone& bone);

/// Allocates in the constructor only; no other function allocates, waits or throws.
class CaseBodies {
public:
    /// Throws Error like body_of_fragment.
    explicit CaseBodies(const std::vector<bone::Bone>& bones);
    explicit CaseBodies(std::vector<std::shared_ptr<const BodyParts>> parts) : parts_(std::move(parts)) {}

    std::size_t count() const noexcept { return parts_.size(); }
    /// Pose of a body in the frame of its scan.
    const Pose& home(int fragment) const noexcept { return parts_[static_cast<std::size_t>(fragment)]->home; }

    /// Rebuilds the whole scene.
    void arrange(const fit::Arrangement& now) noexcept;
    /// Updates only the poses of one body and of those that move with it. A fit to one of them may have become invalid.
    void show_unit(const fit::Arrangement& now, int fragment) noexcept;
    /// The scene, with a new version after a change.
    const coupling::Scene& scene() noexcept;

private:
    void show_place(const fit::Arrangement& now, int fragment) noexcept;

    std::vector<std::shared_ptr<const BodyParts>> parts_;
    coupling::Scene scene_;
    bool is_changed_ = false;
};

}  // namespace tactus::nodes
