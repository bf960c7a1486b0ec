// SPDX-License-Identifier: Apache-2.0
// Self-contained HTML pages, readable offline.
#pragma once

#include "devices/display/figure.hpp"

#include <string>
#include <string_view>

namespace tactus::report::html {

/// Escapes text for HTML content and attributes.
std::string escaped(std::string_view text);

/// An inline drawing. `mark` (letters) makes the names in the drawing unique within the page.
std::string drawing(const display::Figure& figure, std::string_view mark);

/// A picture within the page, with its caption.
std::string picture(const display::Image& image, std::string_view caption);

/// A complete page with a heading. `title` is text, `body` is HTML.
std::string page(std::string_view title, const std::string& body);

}  // namespace tactus::report::html
