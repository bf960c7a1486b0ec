// SPDX-License-Identifier: Apache-2.0
// A labelled picture as a figure of an HTML page.
#pragma once

#include "tools/render/labelled_picture.hpp"

#include <string>

namespace tactus::report {

/// An image as a data URL with its texts over it; without an image a paragraph that says so.
std::string html_of(const render::LabelledPicture& picture);

}  // namespace tactus::report
