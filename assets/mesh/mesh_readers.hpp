// SPDX-License-Identifier: Apache-2.0
// The readers behind load_mesh, one per format: from the bytes of a file to points and triangles as they stand there.
#pragma once

#include "assets/volume/patient_frame.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::mesh {

/// Triangles of a file (polygons as fans) with its points in its own unit and frame, not yet joined or checked.
struct MeshText {
    geometry::TriangleSurface surface;
    std::optional<volume::Frame> frame;  ///< from "SPACE=RAS" or "SPACE=LPS" in a header or comment
};

MeshText read_stl(const std::string& bytes, const std::string& file);
MeshText read_ply(const std::string& bytes, const std::string& file);
MeshText read_obj(const std::string& bytes, const std::string& file);

/// What a header or comment says about the frame, if it does.
std::optional<volume::Frame> stated_frame(std::string_view text);

/// Splits text at blanks and line ends without copying it.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}
    /// The next word, "" at the end.
    std::string_view next();
    /// The next word as a number. Throws Error naming `file` when it is none.
    double number(const std::string& file);

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace tactus::mesh
