// SPDX-License-Identifier: Apache-2.0
// Parts of a report that become HTML or PDF.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/picture/report/plan_picture.hpp"

#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tactus::picture {

struct Heading {
    std::string text;
};

struct Paragraph {
    std::string text;
    bool is_warning = false;
};

struct ReportTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

struct Drawing {
    display::Figure figure;
    std::string caption;
};

using ReportBlock = std::variant<Heading, Paragraph, ReportTable, Drawing, LabelledPicture>;

/// HTML of the blocks, for html::page. Drawings get names that begin with `mark` (letters).
std::string html_of(std::span<const ReportBlock> blocks, std::string_view mark);

/// A PDF file, A4. Text that its standard fonts (WinAnsi) cannot show becomes '?'.
std::string pdf_of(const std::string& title, std::span<const ReportBlock> blocks);

}  // namespace tactus::picture
