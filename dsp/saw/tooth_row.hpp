// SPDX-License-Identifier: Apache-2.0
// The cutting front of a row of teeth.
#pragma once

#include "dsp/carve/cut_front.hpp"
#include "dsp/carve/round_front.hpp"
#include "dsp/saw/cutting_law.hpp"
#include "dsp/saw/lag_norm.hpp"
#include "dsp/saw/saw_shape.hpp"
#include "dsp/volume/bricks.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::saw {

/// One node of the front: the centre of the round front of the kerf, half a kerf behind the teeth.
struct Tooth {
    Vec3 at{0.0, 0.0, 0.0};  ///< where the bone holds it, in the bone's frame, m
    Vec3 target{0.0, 0.0, 0.0};  ///< where the blade is held
    double moved = 0.0;  ///< m, by how far the hand moved the target in this tick
    double lifted = 0.0;  ///< m along −y: how far bone that other teeth bear on holds this one above its target
    Vec3 lag{0.0, 0.0, 0.0};  ///< target − at along the blade's axes, less `lifted`, m
    std::array<double, 3> density{};  ///< kg/m³ of the bone that stops it along x, y, z; 0: free
    double bending = 1.0;  ///< share of the contact stiffness across the blade that bending leaves
    bool seated = false;  ///< false: the blade drew it back into bone; its lag fades, and it bears again once it is out
    bool fresh = false;
    double touch = 0.0;  ///< 1 while bone stops its advance, then fading to 0: how far from bone it still rests

    /// Squared length of the lag; across the blade it counts by the share of stiffness.
    double raw_square() const noexcept { return lag.x * lag.x + lag.y * lag.y + bending * lag.z * lag.z; }
    /// The same with saturation, for the norm.
    double square() const noexcept { return saturated_square(raw_square()); }
};

/// What the teeth do in one tick.
struct Drive {
    bool running = false;
    double rate = 0.0;  ///< Hz, cycles of the stroke
    double dt = 0.001;  ///< s
    /// Share of the forces that the device rendered in the last tick, 0 to 1. Teeth cut by what the hand could feel.
    double rendered = 1.0;
    bool release = false;  ///< the tool is to let go of the bone
};

/// The teeth rest on bone that they have not cut yet. Each node follows its target: in air at once, against bone not at
/// all, except that a running blade advances it along its own force, by an implicit step of the cutting law. It never
/// moves away from its target, so its spring only loses energy: whatever the bone does, the force is passive, and bone
/// never pulls. The lag of a node that the blade draws back into bone fades.
///
/// The stiffness is that of the simulation, not of steel on bone: a real blade does not sink into bone by the lag of its
/// teeth. So a tooth beside the bone hangs no deeper than the teeth that bear, and is not caught at the bone's side. When
/// it meets bone itself, it bears from there on, and its lift fades.
class ToothRow {
public:
    ToothRow() = default;
    /// `stiffness`: N/m of the contact, which bending of the blade softens across it.
    ToothRow(const SawShape& shape, double stiffness);

    /// Follows the blade as far as bone allows without cutting.
    void follow(const volume::BoneSnapshot& bone, const Pose& pose, const Drive& drive) noexcept;

    /// Cuts for one tick: `spring` N/m is k of lag_norm.hpp. Returns the mean advance of the cutting nodes, m.
    double cut(const CuttingLaw& law, const Drive& drive, double spring) noexcept;

    /// After the cut: teeth that came to bear take more of the thrust. Their lifts fade into lags, as far as the springs
    /// then hold no more than they held when the hand had moved: with what teeth that cut, slid or left bone have freed.
    void settle() noexcept;

    /// ‖lag‖₈², m².
    double squared_norm() noexcept;

    std::span<const Tooth> teeth() const noexcept { return teeth_; }
    double pitch() const noexcept { return pitch_; }
    /// Number of bearing teeth that a node stands for.
    double bearing() const noexcept { return pitch_ * sharing_.teeth_per_m; }

    bool is_free(const volume::BoneSnapshot& bone, const Pose& pose) const noexcept;
    void seat(const Pose& pose) noexcept;  ///< every tooth rests where the blade has it
    void carry(const Pose& pose) noexcept;  ///< the blade jumped: the teeth go with it, with their lags
    void release(const Pose& pose, double kept) noexcept;  ///< teeth approach their targets: `kept` of their lags stays
    void forget() noexcept;  ///< bone holds no tooth

    void fill(carve::CutFront& front, const Pose& pose, bool running) const noexcept;

private:
    struct Walk;
    /// Where a tooth was, and whether it cut.
    struct Cut {
        Vec3 at{0.0, 0.0, 0.0};  ///< bone's frame
        Vec3 seen{0.0, 0.0, 0.0};  ///< about the blade of this tick, its axes
        bool bears = false;
    };
    /// The row at the end of an earlier tick. What it cut may still be in the version of the bone that is read.
    struct PastRow {
        std::vector<Cut> teeth;
        bool cut = false;  ///< a tooth bore
    };

    /// Where its spring pulls a tooth.
    Vec3 goal(const Tooth& tooth) const noexcept { return tooth.target - axes_[1] * tooth.lifted; }
    Vec3 place(const Pose& pose, std::size_t n) const noexcept;
    void set_pose(const Pose& pose) noexcept;
    void remember(const Drive& drive) noexcept;
    void pass(const volume::BoneSnapshot& bone, Tooth& tooth, double dt) const noexcept;
    void pursue(const Walk& walk, std::size_t n) noexcept;
    double descend(const Walk& walk, std::size_t n, double way) noexcept;
    void plunge(const Walk& walk, std::size_t n) noexcept;
    void hang(const Walk& walk) noexcept;
    void slide(const Walk& walk, std::size_t n, int axis) noexcept;
    std::optional<double> cut_below(const Vec3& at, std::size_t n) const noexcept;
    double advance(const CuttingLaw& law, const Tooth& tooth, double spring, double norm, double passes,
                   double rendered) const noexcept;

    SawShape shape_;
    ToothSharing sharing_;
    double pitch_ = 0.0, radius_ = 0.0, first_ = 0.0;
    std::vector<Tooth> teeth_;
    std::vector<double> squares_, cuts_, lifts_;
    std::array<PastRow, 8> past_;  // the last tick's, then rows kept every few milliseconds
    std::size_t oldest_ = 1;  // of those
    double since_kept_ = 0.0;  // s
    Vec3 origin_{0.0, 0.0, 0.0};  // of the blade
    Mat3 axes_{1.0};
    double fades_ = 0.0;  // share of a lift that fades in this tick
    double held_ = 0.0;  // m², the squared norm when the hand had moved and no tooth
};

}  // namespace tactus::saw
