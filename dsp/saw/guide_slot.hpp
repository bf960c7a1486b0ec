// SPDX-License-Identifier: Apache-2.0
// A blade in the slots of a cutting guide: the pose that the slot leaves it, and the force on the hand.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/saw/saw_shape.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace tactus::saw {

/// One slot. Its frame is that of a blade that cuts on plan: x along the teeth, y into the bone, z across the blade,
/// origin on the planned plane.
struct GuideSlot {
    Pose frame;
    double low = -0.010, high = 0.010;  ///< m along x: ends of the walls
    double top = -0.015, bottom = 0.0;  ///< m along y: mouth, and the end near the bone
    double wall = -0.5e-3;  ///< m along z: one wall
    /// m along z: the other one, greater than `wall`; infinite: a ledge, which holds a blade within 3 mm of it.
    double other_wall = 1.0e-3;
};

struct SlotSettings {
    double stiffness = 20e3;  ///< N/m across the slot, at the clamp of the blade
    double lever = 0.010;  ///< m: rotations about the axes in the slot have the stiffness · lever²
    /// m, of the blade within the slot; the kerf, because the set of the teeth touches the walls.
    double thickness = 1.0e-3;
};

/// The pose of the hand, moved no farther than the slot requires.
///
/// In the frame of the slot a blade is a plane z = c + a·x + b·y. Walls bound it at the corners of the region in which
/// blade and slot overlap, so all poses that they permit are a convex polytope in (c, a, b). The guided pose is the
/// nearest of them in the metric of the springs, computed exactly: the force is the gradient of an energy and therefore
/// passive, and walls are rigid, however soft the springs. Contact with each of the balls of `ToolBody` would not do:
/// its force bends the hand, but a tilted hand would still tilt the teeth, without limit on a device without torque.
class SlotHold {
public:
    SlotHold() = default;
    SlotHold(const SawShape& shape, const SlotSettings& settings);

    /// One tick of `dt` s. The nearest slot holds the blade from when it is entered, with the blade between its walls, until
    /// no part of the blade is left between them. Its force then fades over 50 ms. If no slots are given, the blade is
    /// released in the same way. Allocates nothing.
    const Pose& follow(std::span<const GuideSlot> slots, const Pose& hand, double dt) noexcept;
    /// The hand jumped: without a fade.
    void drop() noexcept { *this = SlotHold(shape_, settings_); }

    /// Force on the hand at the pose of the last `follow`: that of the springs, and `on_blade` (about the origin of the
    /// guided pose) except for the part that the walls carry.
    Wrench on_hand(const Wrench& on_blade) const noexcept;

    const Pose& pose() const noexcept { return guided_; }
    int slot() const noexcept { return slot_; }  ///< that holds the blade; -1: none
    /// N and N·m, of the springs; N as if all of it were at the clamp.
    double force() const noexcept;

private:
    static constexpr std::size_t max_corners = 12;
    /// A corner of the overlap, in the frame of the slot. `drift` maps a motion of the blade in the plane of the slot to
    /// that of the corner: 0 for one of the slot, 1 for one of the blade.
    struct Corner {
        double x = 0.0, y = 0.0;
        std::array<double, 4> drift{};  // row by row
    };
    struct Active {
        Vec3 normal{0.0};  // of the constraint in (c, a · lever, b · lever)
        double force = 0.0;  // its multiplier, N
        double sign = 1.0;
        std::size_t corner = 0;
    };

    std::size_t overlap(const GuideSlot& slot, const Pose& local,
                        std::array<Corner, max_corners>& corners) const noexcept;
    void solve(const GuideSlot& slot, std::span<const Corner> corners) noexcept;
    void release(const Pose& hand, double dt) noexcept;
    void place(const Pose& frame, const Pose& hand) noexcept;
    void put() noexcept;
    Vec3 clamp_local() const noexcept;
    std::array<double, 2> bounds(const GuideSlot& slot) const noexcept;
    /// m by which the blade of the hand passes the walls; negative: it is free.
    double miss(const GuideSlot& slot, std::span<const Corner> corners) const noexcept;
    /// m between the blade of the hand and a ledge; 0 between two walls.
    double apart(const GuideSlot& slot, std::span<const Corner> corners) const noexcept;

    SawShape shape_;
    SlotSettings settings_;
    int slot_ = -1;
    double left_ = 0.0;  // s of the fade
    double room_ = 0.0;  // m beyond the walls
    Pose frame_, hand_, guided_;
    Vec3 plane_{0.0};  // (c, a, b) of the hand, c at the clamp
    Vec3 offset_{0.0};  // of the guided plane from it
    double clamp_x_ = 0.0, clamp_y_ = 0.0;  // of the clamp in the slot
    std::array<Corner, max_corners> corners_{};
    std::array<Active, 3> active_{};
    std::size_t active_count_ = 0;
};

}  // namespace tactus::saw
