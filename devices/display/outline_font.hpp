// SPDX-License-Identifier: Apache-2.0
// Texts as outlines: of a scalable system font, or of a built-in bitmap font.
#pragma once

#include "devices/display/figure.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::display {

class OutlineFont {
public:
    explicit OutlineFont(bool bold);
    ~OutlineFont();

    /// Closed outlines of a text in UTF-8, for the non-zero rule, with its base line at the origin, x to the right, y
    /// downwards, in units of `size` (of the em); sets `width` to the sum of advances.
    std::vector<std::vector<FigurePoint>> outlines(const std::string& text, double size, double& width) const;

private:
    struct Data;
    std::unique_ptr<const Data> data_;
};

}  // namespace tactus::display
