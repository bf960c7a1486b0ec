// SPDX-License-Identifier: Apache-2.0
// Clearances between plates, screws, implants, cuts and vessels.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::reconstruction {

/// All points within `radius` of a line segment: a screw, an implant (with rounded ends), a segment of a vessel.
struct Capsule {
    Vec3 a{0.0}, b{0.0};
    double radius = 0.0;
};

/// A segment of a plate.
struct Block {
    Vec3 centre{0.0};
    Mat3 axes{1.0};  ///< columns of unit length
    Vec3 half{0.0};
};

/// A cut, represented as a flat disc.
struct Disc {
    Vec3 centre{0.0}, normal{0.0, 0.0, 1.0};
    double radius = 0.0;
};

/// m between surfaces; negative: they overlap. Exact for two capsules; with blocks and discs to 1e-6 of the capsule's
/// length, and never below -radius; of two blocks never below 0.
double distance(const Capsule& a, const Capsule& b) noexcept;
double distance(const Capsule& a, const Block& b) noexcept;
double distance(const Capsule& a, const Disc& b) noexcept;
double distance(const Block& a, const Block& b) noexcept;

Capsule capsule_of(const Screw& screw);
Capsule capsule_of(const DentalImplant& implant);
std::vector<Block> blocks_of(const Plate& plate);  ///< one per segment of its centreline
/// Returns one disc per plane in order, in the frame of the jaw: centred at its origin, as wide as the donor's outline
/// there (10 mm without a donor). The first and the last plane also cut the jaw, and are at least farthest_from_limb
/// wide.
std::vector<Disc> cuts_of(const FibulaInputs& inputs, const FibulaPlan& plan);

/// A vessel in the frame of the jaw.
struct PlacedVessel {
    std::string name;
    VesselKind kind = VesselKind::artery;
    double radius = 0.0;  ///< m
    std::vector<std::vector<Vec3>> lines;
};

enum class Nearness { to_cut, to_vessel, to_hardware };
const char* name_of(Nearness nearness);  ///< "cut", "vessel", "hardware"

/// The nearest object of one kind to a plate, screw or implant.
struct Clearance {
    std::string object;  ///< "plate 'chin'", "screw 3 of plate 'chin'", "implant 'molar'"
    Nearness nearness = Nearness::to_cut;
    std::string other;
    double distance = 0.0;  ///< m; negative: they overlap
};

/// Returns the smallest clearances. A plate bridges the cuts and touches its own screws: neither is measured. Objects
/// without any object of a kind have no entry.
std::vector<Clearance> clearances(const Flap& flap, std::span<const Disc> cuts, std::span<const PlacedVessel> vessels);

}  // namespace tactus::reconstruction
