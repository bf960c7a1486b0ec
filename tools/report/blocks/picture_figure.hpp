// SPDX-License-Identifier: Apache-2.0
// A labelled picture as a drawing list.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/render/labelled_picture.hpp"

namespace tactus::report {

/// The image with its names, sides and scale bar over it, in pixels of the image. Text below `min_size` is enlarged to it.
display::Figure figure_of(const render::LabelledPicture& picture, double min_size = 0.0);

}  // namespace tactus::report
