// SPDX-License-Identifier: Apache-2.0
// A fibula free flap: plans the cuts of a straight donor bone so that its segments fill a gap between planes of a jaw.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/jaw_curve.hpp"
#include "dsp/reconstruction/section.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tactus::reconstruction {

/// A planned cut of the jaw, or a joint between two segments.
struct JawPlane {
    Vec3 origin{0.0};             ///< on the axis of the segments, m
    std::optional<Vec3> normal;   ///< none: the plane bisects the angle between its two segments (not at the ends)
    std::optional<Vec3> y;  ///< direction in the plane that sets the roll of the segment after it; none:
        ///< superior, projected into the plane
};

enum class Leg { left, right };

/// The part of the jaw that is resected.
enum class Resection {
    between,  ///< between the first and the last plane
    after_first,  ///< beyond the first plane: a hemimandibulectomy with the condyle
    before_last,  ///< before the last plane
    none  ///< the jaw is already resected
};
const char* name_of(Resection resection);  ///< "between", "after-first", ...

/// Inputs of a plan. Frame LPS for jaw and donor; their origins may differ.
struct FibulaInputs {
    std::vector<JawPlane> planes;  ///< 2 to 6, in order along the jaw
    Vec3 line_point{0.0};  ///< on the donor's axis
    Vec3 line_direction{0.0, 0.0, 1.0};  ///< from distal to proximal
    Leg leg = Leg::left;  ///< defines medial and lateral
    double between =
        1.5e-3;  ///< m: wanted space between osteotomies along the line (BoneReconstructionPlanner's default)
    double distal_margin = 75e-3;  ///< m of donor left at the ankle (BoneReconstructionPlanner's default)
    double proximal_margin = 60e-3;  ///< m left at the knee: a placeholder, not from a source
    double farthest_from_line = 15e-3;  ///< m: sections of a straight donor have their centre nearer to the line
    double short_segment = 20e-3;  ///< m: with a periosteal branch in 94 % (Laugharne 2015)
    double very_short_segment = 15e-3;  ///< m: in 83 %
    /// Position along the line, m from line_point, where the line meets the more distal plane of each segment, in the
    /// order of the jaw's planes. Empty: segments are placed from the distal margin (without a donor: from line_point)
    /// with the wanted spacing.
    std::vector<double> along_line;
    double roll = 0.0;  ///< rad: rotation of the donor about its axis, right-handed from plane to plane
    bool reversed = false;  ///< the donor's line runs against the order of the planes
    double kerf = 0.4e-3;  ///< m of bone removed by the blade beside a segment: a placeholder, without a source
    std::optional<CurveSplit> from_curve;  ///< the curve from which the planes were made
    Resection resection = Resection::between;
    std::optional<geometry::TriangleSurface> jaw;  ///< for resection; plan_fibula does not use it
    std::optional<geometry::TriangleSurface> donor;  ///< its surface; gaps and margins need it
};

struct FibulaSegment {
    double length_centre = 0.0;  ///< m, between the origins of its planes
    std::optional<double> length_shortest, length_longest;  ///< m, along the line between the outlines of its sections
    std::array<double, 2> tilt{};  ///< rad, between each plane's normal and the axis
    std::array<double, 2> lean_medial{}, lean_anterior{};  ///< rad: each cut's tilt seen along the other of the two
    std::array<std::optional<double>, 2> area{};  ///< m², of each cut, without the marrow cavity
    std::array<std::optional<double>, 2> farthest{};  ///< m: of each cut's outline from the line
    double end_angle = 0.0;  ///< rad, between its two planes
    std::array<double, 2> along_line{};  ///< m from line_point to its planes, along the line
    std::array<Plane, 2> donor_plane;  ///< normals along the line
    Pose donor_to_target;
};

enum class PlanWarning {
    short_segment,  ///< may lack blood supply
    very_short_segment,
    close_osteotomies,  ///< less space between two segments than wanted
    wide_kerf,  ///< the bone between two segments is thinner than the two cuts that bound it
    distal_margin,
    proximal_margin,
    section_mismatch,  ///< a joint does not bisect: its two sections differ
    line_downwards  ///< the line seems to run from the knee to the ankle
};
const char* name_of(PlanWarning warning);  ///< "short-segment", ...

struct FibulaWarning {
    PlanWarning code;
    std::string text;
    int segment = 0;  ///< from 0; for a joint: the segment before it; -1: the whole plan
};

struct FibulaPlan {
    std::vector<FibulaSegment> segments;
    std::vector<double> wedges;  ///< rad, at each joint: the angle of the wedge between two segments in the donor
    std::vector<double> off_bisector;  ///< rad, at each joint: angle between its plane and the bisecting one
    std::vector<double> rolls;  ///< rad, at each joint: rotation between the donor's outlines about its axis
    std::vector<std::optional<double>> contact;  ///< m², at each joint: overlap of the two cuts on its plane
    std::optional<double> kerf_loss;  ///< m³: bone removed by the blade at all cuts, each as deep as its section
    std::optional<double> left_distal, left_proximal;  ///< m of donor at the ankle and at the knee; none: no donor
    std::vector<std::optional<double>> clearances;  ///< m, along the line between neighbouring segments; none: no donor
    std::vector<FibulaWarning> warnings;
};

/// Returns planes at the joints of a split; the end planes are normal to the first and last segments.
std::vector<JawPlane> planes_on(const CurveSplit& split);

/// Each segment's axis runs from one plane's origin to the next one's. The frame of a segment in the jaw has z along
/// its axis and x = y of its first plane × z; that of the donor has z along the line and x medial (line × posterior).
/// Both have their origin where the axis meets the first plane. A reversed donor has z against the line, and keeps its
/// superior side. Only the parts of the donor's surface that lie along the line are used. The transform maps one frame
/// to the other, and the cuts of the donor are the jaw's planes mapped back (after BoneReconstructionPlanner).
/// Throws Error for fewer than two or more than six planes, origins closer than 1 mm, an end plane without normal, a
/// plane that is nearly parallel to a segment (tilt above 75°), a y that does not define a segment's rotation, a donor
/// that leaves the line, a donor that is too short, and positions that are out of order.
FibulaPlan plan_fibula(const FibulaInputs& inputs);

class DonorBone;
/// The same with a prepared donor: the inputs' line, leg, farthest_from_line and donor are not used.
FibulaPlan plan_fibula(const FibulaInputs& inputs, const DonorBone& donor);

}  // namespace tactus::reconstruction
