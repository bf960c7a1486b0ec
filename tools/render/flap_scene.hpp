// SPDX-License-Identifier: Apache-2.0
// Meshes of a reconstruction for pictures: bone, plates, screws, implants, vessels, sites.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/clearance.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "tools/render/labelled_picture.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::render {

inline constexpr Vec3 flap_artery_colour{0.78, 0.10, 0.12}, flap_vein_colour{0.18, 0.28, 0.72},
    plate_colour{0.62, 0.66, 0.70}, screw_colour{0.30, 0.32, 0.36}, implant_colour{0.85, 0.65, 0.20},
    resected_colour{0.80, 0.30, 0.28}, site_colour{0.15, 0.55, 0.25};

/// With smooth normals; `colours`: one for all vertices, or one each.
display::PictureMesh picture_mesh(const geometry::TriangleSurface& surface, const Pose& pose,
                                  std::span<const Vec3> colours);

/// A closed tube about a line.
display::PictureMesh tube_mesh(const std::vector<Vec3>& line, double radius, const Vec3& colour);
display::PictureMesh ball_mesh(const Vec3& centre, double radius, const Vec3& colour);

/// A plate with its screws, an implant, or a site.
struct Hardware {
    std::string name;  ///< "plate p1", "implant i1"
    Vec3 colour{0.0};
    std::vector<display::PictureMesh> meshes;
};
std::vector<Hardware> hardware_of(const reconstruction::Flap& flap);
/// The vessels to which those of the flap are joined, as balls: "site" and the name.
std::vector<Hardware> sites_of(const reconstruction::Flap& flap);

/// Plates, screws, implants and sites, with labels for implants and sites.
void add_hardware(std::vector<display::PictureMesh>& meshes, std::vector<PictureLabel>& labels,
                  const reconstruction::Flap& flap);
void add_vessels(std::vector<display::PictureMesh>& meshes, std::vector<PictureLabel>& labels,
                 std::span<const reconstruction::PlacedVessel> vessels);

}  // namespace tactus::render
