// SPDX-License-Identifier: Apache-2.0
// Outlines of fragments in the slices of a scan: where they are now, and where they were scanned. No user interface.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "tools/analysis/beside.hpp"
#include "tools/render/scene_model.hpp"
#include "tools/window/slices/slice_plane.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace tactus::window {

/// A line through a slice, m; closed when its ends are the same.
using Outline = std::vector<Vec3>;

/// Outlines in which the slice at `at`, m along its normal, cuts a surface that lies at `pose`.
std::vector<Outline> cut_outlines(const geometry::TriangleSurface& surface, const Pose& pose, Slice slice, double at);

class PlanOutlines {
public:
    struct Piece {
        const std::vector<Outline>* lines;
        Vec3 colour;
        bool is_chosen;
        bool is_scanned;  ///< where the fragment was scanned, if it is elsewhere now
    };
    /// Of all fragments whose surfaces are ready; these are made beside the pictures. Valid until the next call.
    const std::vector<Piece>& cut(const std::map<std::size_t, render::SceneModel::PlanPiece>& pieces, Slice slice,
                                  double at);

private:
    struct Surface {
        std::shared_ptr<const observe::SeenBody> body;
        analysis::Beside<geometry::TriangleSurface> making;
        geometry::TriangleSurface triangles;
        double radius = 0.0;  ///< m, about the origin of the body
        bool is_made = false;
    };
    struct Cut {
        std::uint64_t body = 0;
        Pose pose;
        double at = 0.0;
        std::vector<Outline> lines;
    };
    const Surface* surface_of(const std::shared_ptr<const observe::SeenBody>& body);
    const std::vector<Outline>& lines_of(Cut& cut, std::uint64_t body, const Surface& surface, const Pose& pose,
                                         Slice slice, double at);

    std::map<std::uint64_t, Surface> surfaces_;  // by the content of the body
    std::array<std::map<std::size_t, std::array<Cut, 2>>, 3> cuts_;  // of a slice, by place: now, as scanned
    std::vector<Piece> found_;
};

}  // namespace tactus::window
