// SPDX-License-Identifier: Apache-2.0
// Pictures of bones with the sides of the patient, a scale and names.
#pragma once

#include "devices/display/offscreen.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::render {

/// A name at a place of the scene.
struct PictureLabel {
    std::string text;
    Vec3 at{0.0};  ///< m
    Vec3 colour{0.0};
};

/// The sides of the patient towards which a direction in LPS points, the nearest first: "L", "AL". One of three letters
/// at most is left out.
std::string sides_along(const Vec3& direction);

/// What is written over a picture; pixels from its left upper corner.
struct PictureText {
    double x = 0.0, y = 0.0;  ///< of the base line
    char anchor = 's';  ///< start, middle, end
    double size = 13.0;
    std::string text;
    std::optional<Vec3> mark;  ///< colour of a square before it
};

struct LabelledPicture {
    display::Image image;  ///< empty: nothing was shown
    std::vector<PictureText> texts;
    double bar_x = 0.0, bar_y = 0.0, bar_length = 0.0;  ///< the scale's bar
    std::string caption;
};

/// A picture seen along `direction`. Throws Error when none can be made.
LabelledPicture labelled_picture(const std::vector<display::PictureMesh>& meshes, const Vec3& direction,
                                 const std::string& caption, std::span<const PictureLabel> labels = {});

}  // namespace tactus::render
