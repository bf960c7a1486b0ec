// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/mark_lines.hpp"

#include <algorithm>
#include <vector>

namespace tactus::report {

namespace {

constexpr display::Colour mark_colour{0x7A, 0x3D, 0x9A};
constexpr double letter = 5.6, row_height = 12.0;  // of a text of size 10
constexpr std::size_t max_rows = 5;

/// Bytes that begin a character.
std::size_t letters(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

void draw_marks(display::Figure& figure, const MarkedArea& area, std::span<const analysis::MarkPlace> places,
                const std::function<double(double)>& x_of) {
    std::vector<analysis::MarkPlace> sorted(places.begin(), places.end());
    std::ranges::stable_sort(sorted, {}, &analysis::MarkPlace::frequency);
    std::vector<double> taken(max_rows, area.x - 1e3);  // right end of the last name in each row
    for (const analysis::MarkPlace& place : sorted) {
        if (place.frequency < area.lowest || place.frequency > area.highest) continue;
        const double x = x_of(place.frequency);
        figure.line({{x, area.y}, {x, area.y + area.height}}, mark_colour, 1.1, 3.0);
        const std::string name = place.name();
        const double length = letter * static_cast<double>(letters(name));
        const bool leftwards = x + 3.0 + length > area.x + area.width;
        const double from = leftwards ? x - 3.0 - length : x + 3.0;
        const auto row = std::ranges::find_if(taken, [&](double end) { return from > end + 4.0; });
        if (row == taken.end()) continue;  // the line is there; its name is in the text
        *row = from + length;
        figure.text(
            {leftwards ? x - 3.0 : x + 3.0, area.y + 11.0 + row_height * static_cast<double>(row - taken.begin())},
            name, 10.0, mark_colour, leftwards ? display::TextAnchor::end : display::TextAnchor::start);
    }
}

}  // namespace tactus::report
