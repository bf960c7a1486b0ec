// SPDX-License-Identifier: Apache-2.0
// Structures that a saw must not injure: how near a blade is, and what of them it went through.
#pragma once

#include "dsp/training/planned_cut.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::training {

struct SparedStructure {
    std::string name;
    double margin = 0.0;    ///< m
    volume::Grid distance;  ///< signed distance to its surface, m, negative inside

    /// Distance from a point to the structure, m. Outside the grid it may be up to twice as large as it is.
    double at(const Vec3& point) const noexcept;
};

/// Distance of a blade from a structure, m, negative when it is in it. The blade is its middle plane, thickened by half
/// the kerf; the reciprocation makes it longer by half the stroke at both ends. Exact to 0.1 mm, and to 0.5 mm where a
/// large part of the blade is equally near. At most 20,000 samples; real-time safe.
double clearance_of(const SparedStructure& structure, const BladeSize& blade, const Pose& pose) noexcept;

/// Adds up what a moving blade went through of one structure.
class Injury {
public:
    Injury(const SparedStructure& structure, const BladeSize& blade);

    /// The blade moves in a straight line to `pose` and turns on the way at a constant rate; the first pose is where it
    /// begins. Both are followed in steps of less than a quarter of a voxel.
    void move_to(const Pose& pose);

    double injured_m3() const;  ///< volume of the voxels whose middle was in the blade
    double closest() const { return closest_; }  ///< m, least clearance so far; infinite before the first pose

private:
    void visit(const Pose& pose);

    const SparedStructure& structure_;
    BladeSize blade_;
    std::vector<Vec3> inside_;  // middles of its voxels, and whether the blade was there
    std::vector<std::uint8_t> hit_;
    double voxel_m3_ = 0.0, step_ = 0.0, reach_ = 0.0, closest_;
    double safe_ = 0.0;  // m that the blade may move before it can be as near as the structure's voxels or as before
    bool has_begun_ = false;
    Pose last_;
};

}  // namespace tactus::training
