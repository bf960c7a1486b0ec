// SPDX-License-Identifier: Apache-2.0
// The format readers of load_mesh: parse the bytes of a file into points and triangles.
#pragma once

#include "assets/volume/patient_frame.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::mesh {

/// Triangles of a file (polygons become fans) with points in the file's unit and frame, not merged or checked.
struct MeshText {
    geometry::TriangleSurface surface;
    std::optional<volume::Frame> frame;  ///< from "SPACE=RAS" or "SPACE=LPS" in a header or comment
    std::optional<double> unit;          ///< m, from "unit=mm" and the like
    std::vector<std::string> notes{};    ///< contents besides triangles, which were ignored
};

MeshText read_stl(const std::string& bytes, const std::string& file);
MeshText read_ply(const std::string& bytes, const std::string& file);
MeshText read_obj(const std::string& bytes, const std::string& file);

/// The frame that a header or comment states, if any.
std::optional<volume::Frame> stated_frame(std::string_view text);
/// The unit that a header or comment states, m, if any.
std::optional<double> stated_unit(std::string_view text);

/// Splits text at whitespace without copying it.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}
    /// The next word, "" at the end.
    std::string_view next();
    /// The next word as a number. Throws Error naming `file` when it is not a number.
    double number(const std::string& file);

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace tactus::mesh
