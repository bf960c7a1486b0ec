// SPDX-License-Identifier: Apache-2.0
// Pages that carry everything in one file, to be read without a net.
#pragma once

#include "devices/display/figure.hpp"

#include <string>
#include <string_view>

namespace tactus::picture::html {

/// Text as it may stand between tags and in attributes.
std::string escaped(std::string_view text);

/// A drawing within a page. `mark` keeps apart the names inside of several drawings of one page: letters.
std::string drawing(const display::Figure& figure, std::string_view mark);

/// A complete page with a heading. `title` is text, `body` is HTML.
std::string page(std::string_view title, const std::string& body);

}  // namespace tactus::picture::html
