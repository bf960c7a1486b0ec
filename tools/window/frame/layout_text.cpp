// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/layout_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>

namespace tactus::window {

namespace {

// In the order of Panel.
constexpr std::array<std::string_view, 8> part_names{"patch", "scopes", "scene", "node",
                                                     "tree",  "slices", "steps", "task"};

bool is_share(double share) { return share > 0.0 && share <= 1.0; }

/// Empty: damaged.
std::vector<LayoutColumn> columns_of_line(const std::string& line) {
    std::vector<LayoutColumn> columns;
    std::istringstream words(line);
    double share = 0.0;
    while (words >> share) {
        if (!is_share(share)) return {};
        LayoutColumn column{share, {}};
        for (std::string name; words >> name && name != "|";) {
            const auto found = std::ranges::find(part_names, name);
            if (found == part_names.end() || !(words >> share) || !is_share(share)) return {};
            column.panels.push_back({static_cast<Panel>(found - part_names.begin()), share});
        }
        if (column.panels.empty()) return {};
        columns.push_back(std::move(column));
    }
    return words.eof() ? columns : std::vector<LayoutColumn>{};
}

}  // namespace

std::string text_of_borders(const std::vector<std::vector<LayoutColumn>>& arrangements) {
    std::string text;
    for (const auto& columns : arrangements) {
        std::string line;
        for (const LayoutColumn& column : columns) {
            line += fmt::format("{}{:.4f}", line.empty() ? "" : " | ", column.share);
            for (const PanelPlace& place : column.panels)
                line += fmt::format(" {} {:.4f}", part_names[static_cast<std::size_t>(place.panel)], place.share);
        }
        text += line + "\n";
    }
    return text;
}

std::vector<std::vector<LayoutColumn>> borders_of_text(std::string_view text) {
    std::vector<std::vector<LayoutColumn>> arrangements;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);)
        if (auto columns = columns_of_line(line); !columns.empty()) arrangements.push_back(std::move(columns));
    return arrangements;
}

}  // namespace tactus::window
