// SPDX-License-Identifier: Apache-2.0
// Markups of 3D Slicer (.mrk.json): named points, lines, angles, curves and planes.
//
// The requirements of Slicer's reader below are taken from its source, Modules/Loadable/Markups/MRML, files
// vtkMRMLMarkupsJsonStorageNode.cxx, vtkMRMLMarkupsPlaneJsonStorageNode.cxx and vtkMRMLMarkupsPlaneNode.cxx, and from
// its schema, Resources/Schema/markups-schema-v1.0.3.json:
//
// - `@schema` ends with markups-schema-v1.N.N.json; `type` is Fiducial, Line, Angle, Curve, ClosedCurve, Plane or ROI.
// - `position` has three numbers and `orientation`, if present, nine; `positionStatus` is undefined, preview or defined.
//   A file in LPS is converted to RAS by negating the first two rows of positions and of every matrix.
// - A plane without `planeType` is taken for one through three points. A `pointNormal` plane has one control point, its
//   origin; its normal is the third column of `baseToNode` times `objectToBase`. Without `baseToNode` it is (0, 0, 1):
//   `center`, `normal` and `orientation` are written by Slicer and never read.
// - `objectToBase` and `baseToNode` have 16 numbers, row by row, `size` has three and `planeBounds` four; otherwise the
//   file is refused. Since both matrices have their rows negated, no turn of the object in its base is written as
//   diag(-1, -1, 1, 1).
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::markup {

enum class Kind { fiducial, line, angle, curve, plane };

struct ControlPoint {
    std::string label;
    Vec3 position{0.0};  ///< m, LPS
    std::string description;
    Mat3 orientation{1.0};  ///< columns are the axes, LPS
};

struct Markup {
    Kind kind = Kind::fiducial;
    std::string name;
    std::vector<ControlPoint> points;  ///< for a plane one, its origin
    bool is_locked = false;
    bool has_fixed_count = false;  ///< points can be moved, not added or removed
    std::optional<Vec3> colour;  ///< sRGB, 0 to 1
    Vec3 normal{0.0, 0.0, 1.0};  ///< of a plane, LPS, unit length
    double side = 40e-3;  ///< m, of the square drawn for a plane
};

/// The text of a file with these markups, in mm and LPS. A plane has all members that Slicer writes, so that programs
/// that read `center` and `normal` find the same plane as those that read the matrices. The rotation of the square
/// about the normal is arbitrary, because the plane of a cut has none.
std::string text_of(std::span<const Markup> markups);

struct ReadPoints {
    std::vector<ControlPoint> points;
    std::vector<std::size_t> firsts{};  ///< first point of each markup that has points
    std::vector<std::string> notes;  ///< one line each: points that were skipped because they have no position
};

/// The points of one markup, counted from 0 among those that have points. Throws Error naming `file` if there are fewer.
std::vector<ControlPoint> points_of_markup(const ReadPoints& read, std::size_t index, const std::string& file);

/// The control points of all markups of a .mrk.json, in LPS or RAS and mm. Those whose status is `undefined` or `preview`
/// have no position yet: they are skipped and listed in the notes. `file` is the name in messages. Throws Error for
/// other text, other units, an unknown status, and a defined point without a position.
ReadPoints points_of_text(std::string_view text, const std::string& file);

/// The same from a point list of Slicer before 4.13 (.fcsv): comments that state the coordinate system (LPS or 1, RAS or
/// 0), then a line per point, `id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID`. Throws Error if the
/// system is not stated, because then left and right are unknown.
ReadPoints points_of_fcsv(std::string_view text, const std::string& file);

/// Reads either format, by the extension: .fcsv, otherwise JSON.
ReadPoints read_points(const std::filesystem::path& path);

}  // namespace tactus::markup
