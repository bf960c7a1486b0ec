// SPDX-License-Identifier: Apache-2.0
// Pictures of a plan's fragments for a page: with the sides of the patient, a scale and the fragments' names.
#pragma once

#include "devices/display/offscreen.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::picture {

/// A name at a place of the scene.
struct PictureLabel {
    std::string text;
    Vec3 at{0.0};  ///< m
    Vec3 colour{0.0};
};

/// The sides of the patient towards which a direction in LPS points, the nearest first: "L", "AL". One of three letters
/// at most is left out.
std::string sides_along(const Vec3& direction);

/// A figure of HTML, seen along `direction`. Nothing to show: a paragraph that says so. Throws Error when no picture
/// can be made.
std::string plan_picture(const std::vector<display::PictureMesh>& meshes, const Vec3& direction,
                         const std::string& caption, std::span<const PictureLabel> labels = {});

}  // namespace tactus::picture
