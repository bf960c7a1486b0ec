// SPDX-License-Identifier: Apache-2.0
// The parts of a tool that do not cut, in contact with bone.
#pragma once

#include "dsp/volume/bricks.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::saw {

struct SawShape;

/// A ball of the body and the place where bone holds it.
struct BodyPoint {
    Vec3 local{0.0, 0.0, 0.0};  ///< of its centre, tool frame, m
    double full = 0.0;  ///< m, radius
    double radius = 0.0;  ///< m, in the voxels of the bone: small enough for a kerf in them
    double bending = 1.0;  ///< share of the stiffness across the tool, along z, that bending leaves
    Vec3 at{0.0, 0.0, 0.0}, target{0.0, 0.0, 0.0};  ///< bone's frame, m
};

/// A solid that nothing cuts, a guide for instance, at a place of its own.
struct PlacedSolid {
    const volume::BoneSnapshot* solid = nullptr;
    Pose pose;  ///< of its frame in that of the bone
    Pose back = pose.inverse();

    double value(const Vec3& p) const noexcept { return solid->value(back.apply(p)); }
    volume::Sample sample(const Vec3& p) const noexcept {
        volume::Sample here = solid->sample(back.apply(p));
        here.gradient = pose.rotate(here.gradient);
        return here;
    }
};

/// What a body meets: bone, and a guide that nothing cuts.
struct Solids {
    const volume::BoneSnapshot& bone;
    const PlacedSolid* guide = nullptr;  ///< null: none

    Solids(const volume::BoneSnapshot& bone_, const PlacedSolid* guide_ = nullptr) : bone(bone_), guide(guide_) {}
};

/// The balls of a blade: two rows of points on its faces near the teeth, which guide it in its kerf (thesis 6.2.2), and a
/// grid of balls as thick as the blade over all of it, near enough together that no edge or corner of bone gets between
/// them by 0.5 mm.
std::vector<BodyPoint> blade_body(const SawShape& shape, double stiffness);

/// A row of balls at the teeth, for what teeth do not cut.
std::vector<BodyPoint> blade_front(const SawShape& shape, double stiffness);

/// A straight shaft of `length` m behind a burr of `ball` m radius, along −y.
std::vector<BodyPoint> shaft_body(double ball, double radius, double length);

/// Each ball is a god object (Zilles and Salisbury 1995): it follows the tool and never crosses a surface, so that a thin
/// wall stops it as a thick one does. It slides along walls, with Coulomb friction while the tool stands still, and only
/// where that shortens its lag: the force is passive. Bone holds the tool back, against its cutting direction, only where
/// the ball would have to sink into it by more than its surface is rough.
class ToolBody {
public:
    ToolBody() = default;
    /// `stiffness`: N/m, upper bound of what the hand feels. `kerf`: m, the width that the tool cuts for itself; 0: its body
    /// needs none. `is_pinched`: walls may hold it from both sides, so that each spring is softer. Allocates.
    ToolBody(std::vector<BodyPoint> points, double stiffness, double kerf = 0.0, bool is_pinched = true);

    bool is_free(const Solids& solids, const Pose& pose) noexcept;
    /// Every ball rests where the tool has it.
    void seat(const Pose& pose) noexcept;
    void follow(const Solids& solids, const Pose& pose, bool running) noexcept;
    /// The tool jumped: the balls go with it, with their lags.
    void carry(const Pose& pose) noexcept;
    /// The balls approach their targets, whatever lies between: `kept` of their lags stays.
    void release(const Pose& pose, double kept) noexcept;

    struct Sum {
        Wrench wrench;  ///< about the given origin, N and N·m
        double magnitudes = 0.0;  ///< N, sum of the sizes of the balls' forces
        double lag = 0.0;  ///< m, the greatest
        double energy = 0.0;  ///< J, of the springs
        int count = 0;  ///< balls with a force
    };
    Sum push(const Vec3& about) noexcept;

    std::span<const BodyPoint> points() const noexcept { return points_; }

private:
    /// Balls side by side: while all of them are free and bone is far, they are not looked at one by one.
    struct Tile {
        std::size_t first = 0, count = 0;
        Vec3 centre{0.0, 0.0, 0.0};  // tool frame
        double reach = 0.0;  // m, from the centre to the surface of its farthest ball
        bool is_free = true;  // at rest where the tool has them
        bool is_near = false;  // `at` and `target` are up to date
    };

    Vec3 place(const Vec3& local) const noexcept { return origin_ + axes_ * local; }
    void set_pose(const Pose& pose) noexcept;
    double square(const Vec3& lag, double bending) const noexcept;
    void fit_to(double voxel) noexcept;
    void bring_up(Tile& tile) noexcept;
    template <class Field>
    void slide(const Field& field, BodyPoint& p, double voxel, bool running) const noexcept;
    template <class Field>
    void unhook(const Field& field, BodyPoint& p, double voxel) const noexcept;
    template <class Field>
    void step(const Field& field, BodyPoint& p, const Vec3& last, double voxel, bool running) const noexcept;

    std::vector<BodyPoint> points_;
    std::vector<Tile> tiles_;
    std::vector<double> squares_;  // of the balls that bone holds
    std::vector<std::uint32_t> held_;  // which they are
    double spring_ = 0.0, reach_ = 0.0, kerf_ = 0.0;
    double voxel_ = 0.0;  // m, to which the balls are fitted
    Vec3 origin_{0.0, 0.0, 0.0};
    Mat3 axes_{1.0};
};

}  // namespace tactus::saw
