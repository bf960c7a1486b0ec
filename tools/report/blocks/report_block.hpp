// SPDX-License-Identifier: Apache-2.0
// Parts of a report that become HTML or PDF.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/render/labelled_picture.hpp"

#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tactus::report {

struct Heading {
    std::string text;
    bool is_warning = false;
    int depth = 1;  ///< 2 and more: within a section
};

struct Paragraph {
    std::string text;
};

struct ReportList {
    std::vector<std::string> items;
    bool is_warning = false;
};

/// Cells that are numbers stand at the right of their column in HTML.
struct ReportTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
    std::vector<Vec3> marks{};  ///< per row: sRGB of a square before it; empty: none
    std::vector<bool> warnings{};  ///< per row: it is one; empty: none
};

struct Drawing {
    display::Figure figure;
    std::string caption;
};

/// Pictures two in a row.
struct PictureGrid {
    std::vector<render::LabelledPicture> pictures;
};

using ReportBlock = std::variant<Heading, Paragraph, ReportList, ReportTable, Drawing, PictureGrid>;

/// HTML of the blocks, for html::page. Drawings get names that begin with `mark` (letters).
std::string html_of(std::span<const ReportBlock> blocks, std::string_view mark);

}  // namespace tactus::report
