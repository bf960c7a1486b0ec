// SPDX-License-Identifier: Apache-2.0
// Blocks of a report laid out on pages.
#pragma once

#include "tools/report/blocks/report_block.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::report {

/// Pages of A4, in points. What they hold lies within the part that A4 and Letter share, so that either prints it whole; a
/// table row is not divided, and each page of a table begins with its head.
std::vector<display::Figure> pages_of(const std::string& title, std::span<const ReportBlock> blocks);

struct Pdf {
    std::string bytes;
    std::string warning;  ///< of characters that no font has; empty: none
};

/// The pages as a PDF file with embedded fonts. Equal blocks give equal bytes. Throws Error if Cairo is missing.
Pdf pdf_of(const std::string& title, std::span<const ReportBlock> blocks);

}  // namespace tactus::report
