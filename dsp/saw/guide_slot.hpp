// SPDX-License-Identifier: Apache-2.0
// A blade in the slots of a cutting guide: the pose that the slot leaves it, and the force on the hand.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/saw/saw_shape.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace tactus::saw {

/// One slot. Its frame is that of a blade that cuts on plan: x along the teeth, y into the bone, z across the blade,
/// origin on the planned plane.
struct GuideSlot {
    Pose frame;
    double low = -0.010, high = 0.010;  ///< m along x: ends of the walls
    double top = -0.015, bottom = 0.0;  ///< m along y: mouth, and the end near the bone
    double wall = -0.5e-3;  ///< m along z: one wall
    /// m along z: the other one, greater than `wall`; infinite: a ledge. A blade enters a ledge if all of it within
    /// the slot is within 3 mm of the wall, and stays while its nearest part is.
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
/// In the frame of the slot a blade is a plane z = c + a·x + b·y. Two walls bound it wherever it is in the slot. They are
/// crowned by `wall_crown`, 2.5 µm over 10 mm: the touch moves along an edge of the blade that lies on a wall, where it would
/// jump from one end to the other, and the torque with it. Beyond the ends of the slot they recede as parabolas of
/// `end_radius`, as far as the blade reaches. The poses that they permit are a
/// convex set in (c, a, b). The guided pose is the nearest of them in the metric of the springs: the walls are rigid, however
/// soft the springs, and the force is the gradient of an energy and therefore passive. Since the ends are round, a contact
/// moves where a corner of the blade passes one of the slot, and the force turns with it; at sharp ends it would jump.
/// Contact with each of the balls of `ToolBody` would not do: its force bends the hand, but a tilted hand would still tilt
/// the teeth, without limit on a device without torque.
///
/// The force grows up to `stiffness` · `max_lag`. A hand beyond that feels a constant force; the blade stays in the slot.
class SlotHold {
public:
    static constexpr double end_radius = 4e-3;  ///< m
    static constexpr double wall_crown = 0.05;  ///< 1/m, curvature
    static constexpr double fade_time = 0.1;  ///< s

    SlotHold() = default;
    SlotHold(const SawShape& shape, const SlotSettings& settings);

    /// One tick of `dt` s. A slot holds the blade from when it is entered until the blade has left it and its round
    /// ends do not touch it any more. A blade enters within 11.5° of the planned plane and at most 0.3 mm beyond the
    /// walls; it keeps that room. In the slot it may tilt by 60°. Of several slots the one holds it that it fits best
    /// over its whole length: ledges of neighbouring cuts are open to each other and their planes cross, so that a
    /// blade on one of them is near the other. A blade that touches a ledge keeps it unless it fits another one better
    /// by 0.5 mm. It then is released, as are one that is turned out of its slot, one that the hand holds farther from
    /// it than 1 mm, and one for which no slots are given: the force fades over `fade_time`. Allocates nothing.
    const Pose& follow(std::span<const GuideSlot> slots, const Pose& hand, double dt) noexcept;
    /// The hand jumped: without a fade.
    void drop() noexcept { *this = SlotHold(shape_, settings_); }

    /// Force on the hand at the pose of the last `follow`: that of the springs, and `on_blade` (about the origin of the
    /// guided pose) except for the part that the walls carry. They take it over within `fade_time` of `enter`.
    Wrench on_hand(const Wrench& on_blade) const noexcept;

    const Pose& pose() const noexcept { return guided_; }
    int slot() const noexcept { return slot_; }  ///< that holds the blade; -1: none
    /// N and N·m, of the springs; N as if all of it were at the clamp.
    double force() const noexcept;

private:
    /// Where the blade touches a wall, in the frame of the slot.
    struct Touch {
        double x = 0.0, y = 0.0;  // m
        double slope_x = 0.0, slope_y = 0.0;  // of the wall, which recedes
        double recess = 0.0;  // m by which the wall has receded
        double sign = 1.0;  // 1: the wall at greater z
        Vec3 normal{0.0};  // of the constraint in (c, a · lever, b · lever)
        double force = 0.0;  // m, its multiplier
    };
    static constexpr std::size_t max_touches = 3;
    /// The way of a plane to the nearest one that the walls permit.
    struct Solution {
        Vec3 offset{0.0};  // m, in (c, a · lever, b · lever)
        std::array<Touch, max_touches> touches{};  // of one touch maybe two near each other
        std::size_t count = 0;
    };
    /// The blade of the hand in the frame of a slot.
    struct Placement {
        Pose pose;
        Quat upright{1.0, 0.0, 0.0, 0.0};  // its orientation, turned the shortest way into the plane of the slot
        std::array<Vec3, 4> outline{};  // of the blade in that plane, at the clamp
        Vec3 clamp{0.0};
        Vec3 plane{0.0};  // (c, a, b), c at the clamp
    };

    Placement placed(const Pose& frame, const Pose& hand) const noexcept;
    Touch deepest(const GuideSlot& slot, const Placement& at, double sign, const Vec3& plane,
                  double crown = wall_crown) const noexcept;
    double beyond(const GuideSlot& slot, const Placement& at, const Touch& touch, const Vec3& plane) const noexcept;
    double gap(const GuideSlot& slot, const Placement& at) const noexcept;
    void stay(std::span<const GuideSlot> slots, const Pose& hand) noexcept;
    bool is_clear(double missed) const noexcept;
    bool is_wrong(std::span<const GuideSlot> slots, const Pose& hand) const noexcept;
    bool is_enterable(const GuideSlot& slot, const Placement& at) const noexcept;
    Placement as_held(Placement at) const noexcept;
    double misfit(const GuideSlot& slot, const Placement& at) const noexcept;
    void enter(std::span<const GuideSlot> slots, const Pose& hand, double most) noexcept;
    /// `found`: touches from which the search begins.
    Solution project(const GuideSlot& slot, const Vec3& hand, Solution found) const noexcept;
    void solve() noexcept;
    void pull() noexcept;
    void release(const Pose& hand, double dt) noexcept;
    void let_go() noexcept;
    void put() noexcept;
    Vec3 torque_of(const Vec3& general, const Pose& local) const noexcept;
    Wrench wedge(std::span<const Touch> touches, const Vec3& plane) const noexcept;
    double load_of(const Wrench& w) const noexcept;  // N, with torques at the lever
    Vec3 clamp_local() const noexcept;
    std::array<double, 2> bounds(const GuideSlot& slot) const noexcept;
    /// m by which the blade of the hand passes the walls; negative: it is free.
    double miss(const GuideSlot& slot, const Placement& at) const noexcept;
    /// m between the blade of the hand and a ledge; 0 between two walls.
    double apart(const GuideSlot& slot, const Placement& at) const noexcept;
    /// m from a ledge of the part of the blade that is farthest from it; 0 between two walls.
    double farthest(const GuideSlot& slot, const Placement& at) const noexcept;
    /// m, of the springs, in the metric of the clamp.
    double stretch() const noexcept;

    SawShape shape_;
    SlotSettings settings_;
    int slot_ = -1;
    double left_ = 0.0;  // s of the fade
    double room_ = 0.0;  // m beyond the walls
    double stiffness_ = 0.0;  // N/m: beyond `max_lag` less than that of the settings
    double share_ = 0.0;  // of the load on the blade that walls may carry
    double weakened_ = 1.0, max_load_ = 0.0;  // of the springs in a release; N, as it began
    GuideSlot walls_;  // of the last slot that held the blade
    Pose guided_;
    Placement hand_;
    Vec3 offset_{0.0};  // of the guided plane from that of the hand
    Wrench spring_;  // on the hand about the clamp, frame of the slot
    std::optional<Wrench> rest_;  // on the hand, of a released blade that is turned across its slot
    std::array<Touch, max_touches> touches_{};
    std::size_t touch_count_ = 0;
};

}  // namespace tactus::saw
