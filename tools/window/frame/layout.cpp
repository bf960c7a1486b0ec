// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/layout.hpp"

#include <algorithm>
#include <array>

namespace tactus::window {

namespace {

constexpr std::array<std::string_view, 3> names{"patch", "plan", "train"};
constexpr double min_share = 0.15;

using Columns = std::vector<LayoutColumn>;

Columns all_columns(Layout layout, bool is_wide) {
    switch (layout) {
        case Layout::patch:
            if (is_wide)
                return {{0.5, {{Panel::patch, 1.0}}},
                        {0.3, {{Panel::scene, 0.55}, {Panel::scopes, 0.45}}},
                        {0.2, {{Panel::node, 1.0}}}};
            return {{0.64, {{Panel::patch, 0.58}, {Panel::scopes, 0.42}}},
                    {0.36, {{Panel::scene, 0.55}, {Panel::node, 0.45}}}};
        case Layout::plan:
            if (is_wide)
                return {{0.2, {{Panel::tree, 0.5}, {Panel::node, 0.5}}},
                        {0.55, {{Panel::scene, 0.65}, {Panel::slices, 0.35}}},
                        {0.25, {{Panel::steps, 0.7}, {Panel::scopes, 0.3}}}};
            return {{0.66, {{Panel::scene, 0.65}, {Panel::slices, 0.35}}},
                    {0.34, {{Panel::tree, 0.3}, {Panel::steps, 0.4}, {Panel::node, 0.3}}}};
        case Layout::train: return {{0.72, {{Panel::scene, 1.0}}}, {0.28, {{Panel::task, 1.0}}}};
    }
    return {};
}

template <class Item>
void normalise(std::vector<Item>& items) {
    double sum = 0.0;
    for (const Item& item : items) sum += item.share;
    for (Item& item : items) item.share /= sum;
}

template <class Item>
void move(std::vector<Item>& items, std::size_t index, double by) {
    if (index + 1 >= items.size()) return;
    double &first = items[index].share, &second = items[index + 1].share;
    const double both = first + second, least = std::min(min_share, 0.5 * both);
    first = std::clamp(first + by, least, both - least);
    second = both - first;
}

}  // namespace

std::optional<Layout> layout_of_name(std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Layout>(found - names.begin());
}

std::string_view name_of(Layout layout) { return names[static_cast<std::size_t>(layout)]; }

Columns columns_of(Layout layout, double width, const std::function<PanelRoom(Panel)>& room) {
    Columns columns = all_columns(layout, width >= three_columns);
    for (LayoutColumn& column : columns) {
        std::erase_if(column.panels, [&](const PanelPlace& place) { return room(place.panel) == PanelRoom::none; });
        for (PanelPlace& place : column.panels) place.is_line = room(place.panel) == PanelRoom::line;
        normalise(column.panels);
    }
    std::erase_if(columns, [](const LayoutColumn& column) { return column.panels.empty(); });
    // Something is shown always.
    if (columns.empty() && layout != Layout::patch) return columns_of(Layout::patch, width, room);
    normalise(columns);
    return columns;
}

bool shows(const Columns& columns, Panel panel) {
    return std::ranges::any_of(columns, [&](const LayoutColumn& column) {
        return std::ranges::find(column.panels, panel, &PanelPlace::panel) != column.panels.end();
    });
}

void move_border(Columns& columns, std::size_t index, double by) { move(columns, index, by); }
void move_border(LayoutColumn& column, std::size_t index, double by) { move(column.panels, index, by); }

}  // namespace tactus::window
