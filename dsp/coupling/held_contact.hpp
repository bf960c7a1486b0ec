// SPDX-License-Identifier: Apache-2.0
// Contact of the held body with all other bodies of a scene, in the form that the couplings use.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/coupling/scene.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace tactus::coupling {

class HeldContact {
public:
    /// Capacity for pointshells with `max_points` points in total; all memory is allocated here.
    explicit HeldContact(std::size_t max_points);

    /// Sets body `held` of `scene` (which must stay alive), at pose handle ∘ `grip`, against all others. Bodies of the
    /// same unit move with it from their poses in `scene` and touch the others too. `both_ways`: also tests the others'
    /// points against the held body's distance. When `held` is no valid place in the scene, nothing is held and nothing
    /// touches.
    void set(const Scene& scene, int held, const Pose& grip, const contact::ContactLaw& law, bool both_ways,
             std::size_t budget = std::numeric_limits<std::size_t>::max()) noexcept;

    contact::ContactSum operator()(const Pose& handle, contact::ContactParts parts) noexcept;
    /// m; see HeldContactLike. 0 when something may be in contact.
    double clearance(const Pose& handle) const noexcept;
    /// Of all bodies of the held unit: greatest distance of their surface from the handle, and root mean square distance
    /// of their points, m; 0 without points.
    double reach() const noexcept { return reach_; }
    double gyration() const noexcept { return std::sqrt(gyration2_); }
    /// m: half of the finest voxel of all fields that something is tested against; infinite without any. A wall that a
    /// field can hold is thicker, so a motion of this length that starts outside of it does not end behind it.
    double safe_step() const noexcept { return safe_step_; }

private:
    void add(const SceneObject& mine, const Pose& beside, const SceneObject& other, bool both_ways) noexcept;
    void measure(const Body& body, const Pose& in_hand) noexcept;
    std::span<const contact::ContactPair> place(const Pose& handle) noexcept;

    contact::PointshellContact kernel_;
    contact::ContactLaw law_;
    // The maximum number of pairs: one half of the objects against the other half.
    static constexpr std::size_t max_pairs = Scene::max_objects * Scene::max_objects / 2;
    std::array<contact::ContactPair, max_pairs> pairs_;
    std::array<Pose, max_pairs> beside_;  ///< pose of a pair's moving body in the frame of the held one
    std::size_t count_ = 0, budget_ = 0;
    double reach_ = 0.0, gyration2_ = 0.0, measured_ = 0.0;  ///< m, m², number of points in them
    double safe_step_ = std::numeric_limits<double>::infinity();
    Pose grip_;
};

}  // namespace tactus::coupling
