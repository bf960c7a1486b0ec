// SPDX-License-Identifier: Apache-2.0
// Scans of vessels with known truth, and how a track compares with it.
#pragma once

#include "dsp/simulate/vessel_phantom.hpp"
#include "dsp/vessel/track.hpp"

#include <string>

namespace tactus::simulate {

/// Samples of 1 mm; vessels are 1 above a background of 0 unless stated.
struct VesselCase {
    std::string name;
    volume::Grid scan;
    Vec3 seed{0.0};
    std::vector<std::vector<Vec3>>
        lines;  ///< centre lines, points at most 0.15 samples apart; the first holds the seed
    double radius = 0.0;                   ///< m, of the first line
    std::optional<Vec3> joint;             ///< where the lines meet
};

// Radii in samples; `noise` in units of contrast.

/// A helix of 14 samples radius.
VesselCase helix_case(double radius, double noise, std::uint64_t seed);
/// A straight tube that ends twice inside of the scan.
VesselCase ends_case(double radius, double noise, std::uint64_t seed);
/// Two vessels leave at `angle_deg`. `ratio` 1: both turn by half the angle and have 0.8 of the radius; otherwise one goes
/// straight on and the other has `ratio` of the radius.
VesselCase branch_case(double radius, double angle_deg, double ratio, std::uint64_t seed);
/// A narrowing of a round lumen.
struct TrueStenosis {
    double radius = 4.0;  ///< samples
    double percent = 70.0;  ///< of the diameter, in the middle
    double length = 4.0;  ///< radii, from end to end
    enum class Shape { cosine, flat } shape = Shape::cosine;  ///< flat: even, with shoulders of a quarter of the length
    double aside = 0.0;  ///< share of what is lost that is lost on one side alone: 0 round, 1 wholly
    std::optional<Vec3> direction =
        std::nullopt;  ///< unit, of the vessel; 0 to 0.9 in x, 0 or more in y and z; none: near z
};
VesselCase stenosis_case(const TrueStenosis& stenosis, std::uint64_t seed, double noise = 0.2);
/// Interrupted over two radii.
VesselCase gap_case(double radius, std::uint64_t seed);
/// A vessel of 350 half a sample beside a wall of 1000, along 20 radii; noise 70.
VesselCase bone_case(double radius, std::uint64_t seed);
/// Nothing but noise, `correlation` as in add_noise.
volume::Grid noise_case(double correlation, std::uint64_t seed);

/// Lengths in samples unless stated.
struct TrackError {
    double rms = 0.0;  ///< distance of nodes to the nearest line, two radii away from its ends; without lost stretches
    double mean_radius = 0.0;  ///< of these nodes of the first branch
    double worst = 0.0;  ///< greatest of these distances
    double overshoot = 0.0;  ///< past an end of the first line, in its radii
    double covered = 0.0;  ///< share of all lines with a node closer than 1.5 radii
    double joint = 0.0;  ///< nearest start of a side branch to the joint, radii; infinite: no side branch
};
TrackError compared(const vessel::Track& track, const VesselCase& with);

}  // namespace tactus::simulate
