// SPDX-License-Identifier: Apache-2.0
// Parts of a fibula free flap besides its bone: vessels, perforators, plates, implants, and the sites where its vessels
// are joined.
#pragma once

#include "dsp/core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::reconstruction {

enum class VesselKind { artery, vein };
const char* name_of(VesselKind kind);  ///< "artery", "vein"

/// A vessel of the donor leg, from the scan.
struct FlapVessel {
    std::string name;
    VesselKind kind = VesselKind::artery;
    double radius = 1.5e-3;  ///< m, outer
    std::vector<Vec3> points;  ///< m, frame of the donor; at least two, in order along the vessel
};

/// The point where a branch to the skin leaves the bone, frame of the donor.
struct Perforator {
    std::string name;
    Vec3 at{0.0};
};

/// A vessel of the neck to which a vessel of the flap is joined, frame of the jaw.
struct RecipientSite {
    std::string name;
    VesselKind kind = VesselKind::artery;
    Vec3 at{0.0};
};

struct Screw {
    Vec3 head{0.0};  ///< m
    Vec3 axis{0.0, 0.0, 1.0};  ///< unit, into the bone
    double length = 12e-3, diameter = 2e-3;  ///< m; placeholders, without a source
};

/// A plate in the frame of the jaw.
struct Plate {
    std::string name;
    double width = 7.0e-3, thickness = 2.5e-3;  ///< m (BoneReconstructionPlanner)
    std::vector<Vec3> points;  ///< m: its centreline on the bone's outer contour
    std::vector<Vec3> outward;  ///< unit, of each point: away from the bone
    std::vector<Screw> screws;
    /// Parameters with which `plate_on` created it.
    struct Laid {
        double height = 0.0;  ///< m
        int screws_per_segment = 0;
    };
    std::optional<Laid> laid{};  ///< none: unknown
};

/// A dental implant, frame of the jaw.
struct DentalImplant {
    std::string name;
    Vec3 head{0.0};  ///< m
    Vec3 axis{0.0, 0.0, -1.0};  ///< unit, into the bone
    double diameter = 4e-3, length = 14e-3;  ///< m (BoneReconstructionPlanner)
};

/// A skin paddle, frame of the donor.
struct SkinPaddle {
    Vec3 at{0.0};  ///< its centre
    double length = 60e-3, width = 40e-3;  ///< m, along and across the donor's line; placeholders, without a source
};

/// Thresholds of warnings.
struct FlapLimits {
    double clearance = 1.0e-3;  ///< m between plates, screws, implants, cuts and vessels (BoneReconstructionPlanner)
    double perforator_to_cut = 3.0e-3;  ///< m: a placeholder, without a source
    double over_in_situ = 0.10;  ///< strain over that in the leg at which a vessel no longer reaches: a placeholder
    double kink = 3.0;  ///< bend radius in radii of a vessel, below which it may kink; unverified value
    double twist = 1.5707963267948966;  ///< rad: flaps survived 90° in 8 of 8, 180° in 3 of 8 (rat, Güven 2012)
};

struct Flap {
    std::vector<FlapVessel> vessels;
    std::vector<Perforator> perforators;
    std::vector<RecipientSite> sites;
    std::vector<Plate> plates;
    std::vector<DentalImplant> implants;
    std::optional<SkinPaddle> paddle;
    double margin = 10e-3;  ///< required distance in m of the first and last cut from the tumour: a placeholder
    FlapLimits limits;
};

}  // namespace tactus::reconstruction
