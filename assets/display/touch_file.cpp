// SPDX-License-Identifier: Apache-2.0
#include "assets/display/touch_file.hpp"

#include "assets/table/number_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tactus::display {

namespace {

constexpr std::array<std::string_view, 4> kinds{"workspace", "screen", "image", "mirror"};

double number(const table::NumberTable& table, const char* column, std::size_t row) {
    const std::string& text = table.text(column)[row];
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        throw Error({table.file, table.lines[row], 0}, fmt::format("column {}: '{}' is not a number", column, text));
    return value;
}

Vec3 place(const table::NumberTable& table, std::array<const char*, 3> columns, std::size_t row) {
    return 1e-3 * Vec3(number(table, columns[0], row), number(table, columns[1], row), number(table, columns[2], row));
}

}  // namespace

std::vector<Touch> load_touches(const std::filesystem::path& path) {
    const table::NumberTable table = table::load_number_table(path);
    table.know({"of", "screen", "u", "v", "x_mm", "y_mm", "z_mm", "at_x_mm", "at_y_mm", "at_z_mm"});
    std::vector<Touch> touches;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        Touch touch;
        const std::string& of = table.text("of")[row];
        const auto kind = std::ranges::find(kinds, of);
        if (kind == kinds.end())
            throw Error({table.file, table.lines[row], 0},
                        fmt::format("'{}' is none of {}{}", of, fmt::join(kinds, ", "),
                                    did_you_mean(of, std::vector<std::string>(kinds.begin(), kinds.end()))));
        touch.of = static_cast<Touch::Of>(kind - kinds.begin());
        touch.reading = place(table, {"x_mm", "y_mm", "z_mm"}, row);
        if (touch.of == Touch::Of::workspace) touch.place = place(table, {"at_x_mm", "at_y_mm", "at_z_mm"}, row);
        if (touch.of == Touch::Of::screen || touch.of == Touch::Of::image) {
            touch.screen = table.text("screen")[row];
            touch.shown = {number(table, "u", row), number(table, "v", row)};
            if (touch.screen.empty())
                throw Error({table.file, table.lines[row], 0},
                            "this mark needs the name of its screen in column 'screen'");
        }
        touches.push_back(std::move(touch));
    }
    if (touches.empty()) throw Error({table.file, 0, 0}, "the file has no touches");
    return touches;
}

std::string touches_text(std::span<const Touch> touches) {
    std::string text = "of,screen,u,v,x_mm,y_mm,z_mm,at_x_mm,at_y_mm,at_z_mm\n";
    for (const Touch& touch : touches) {
        const Vec3 at = touch.reading * 1e3, known = touch.place * 1e3;
        const bool is_mark = touch.of == Touch::Of::screen || touch.of == Touch::Of::image;
        text += fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},", kinds[static_cast<std::size_t>(touch.of)],
                            is_mark ? touch.screen : "", touch.shown.x, touch.shown.y, at.x, at.y, at.z);
        text += touch.of == Touch::Of::workspace ? fmt::format("{:.6f},{:.6f},{:.6f}\n", known.x, known.y, known.z)
                                                 : "0,0,0\n";
    }
    return text;
}

std::vector<Vec3> load_places(const std::filesystem::path& path) {
    const table::NumberTable table = table::load_number_table(path);
    table.know({"x_mm", "y_mm", "z_mm"});
    std::vector<Vec3> places;
    for (std::size_t row = 0; row < table.rows(); ++row) places.push_back(place(table, {"x_mm", "y_mm", "z_mm"}, row));
    return places;
}

}  // namespace tactus::display
