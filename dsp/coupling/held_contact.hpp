// SPDX-License-Identifier: Apache-2.0
// Contact of the body in the hand with everything else of a scene, as the couplings ask for it.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/coupling/scene.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace tactus::coupling {

class HeldContact {
public:
    /// Room for pointshells of together `most_points` points; memory is taken here and not later.
    explicit HeldContact(std::size_t most_points);

    /// From now on: body `held` of `scene` (which must live meanwhile), standing at handle ∘ `grip`, against all others.
    /// What is of one unit with it moves along, where it stands in `scene`, and touches what else there is.
    /// `both_ways`: the points of the others are tried against the held body's distance too. A `held` that is no place
    /// in the scene is not there and touches nothing.
    void set(const Scene& scene, int held, const Pose& grip, const contact::ContactLaw& law, bool both_ways,
             std::size_t budget = std::numeric_limits<std::size_t>::max()) noexcept;

    contact::ContactSum operator()(const Pose& handle, contact::ContactParts parts) noexcept;
    /// m; see HeldContactLike. 0 when something may be touching.
    double clearance(const Pose& handle) const noexcept;
    /// Farthest point of the held body from the handle and root mean square distance, m; 0 without points.
    double reach() const noexcept;
    double gyration() const noexcept;

private:
    void add(const SceneObject& mine, const Pose& beside, const SceneObject& other, bool both_ways) noexcept;
    std::span<const contact::ContactPair> place(const Pose& handle) noexcept;

    contact::PointshellContact kernel_;
    contact::ContactLaw law_;
    // Half of the objects against the other half is the most there can be.
    static constexpr std::size_t most_pairs = Scene::most_objects * Scene::most_objects / 2;
    std::array<contact::ContactPair, most_pairs> pairs_;
    std::array<Pose, most_pairs> beside_;  ///< of the moving body of a pair in the frame of the held one
    std::size_t count_ = 0, budget_ = 0;
    const contact::Pointshell* held_shell_ = nullptr;
    Pose grip_;
};

}  // namespace tactus::coupling
