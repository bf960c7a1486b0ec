// SPDX-License-Identifier: Apache-2.0
// The layouts of the window: which panels stand where. No user interface. A new panel is an enumerator here, a place in
// layout.cpp and a case in Desk::draw_panel.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace tactus::window {

enum class Layout { patch, plan, train };

/// "patch", "plan", "train".
std::optional<Layout> layout_of_name(std::string_view name);
std::string_view name_of(Layout layout);

enum class Panel {
    patch,  ///< the picture of the patch
    scopes,  ///< of its signals
    scene,  ///< in space
    node,  ///< parameters of the selected node, the list of node types, parts of the scene
    tree,  ///< what a plan has in space
    slices,  ///< of the scan
    steps,  ///< of a plan
    task  ///< force, depth, time and score of a trainee
};

/// How much room a panel wants; `line`: little, because it is empty.
enum class PanelRoom { none, line, full };

struct PanelPlace {
    Panel panel;
    double share;  ///< of the height of its column
    bool is_line = false;
};
struct LayoutColumn {
    double share;  ///< of the width of the window
    std::vector<PanelPlace> panels;  ///< from the top
};

/// Width from which there is a third column, in units of text: pixels per scale.
inline constexpr double three_columns = 2200.0;

/// The columns from left to right, for a window of that width in units of text. A panel without room is left out, and
/// the others take its place; shares add up to 1.
std::vector<LayoutColumn> columns_of(Layout layout, double width, const std::function<PanelRoom(Panel)>& room);

bool shows(const std::vector<LayoutColumn>& columns, Panel panel);

/// Moves the border behind place `index` by a part of the whole: what the one gets, its neighbour loses.
void move_border(std::vector<LayoutColumn>& columns, std::size_t index, double by);
void move_border(LayoutColumn& column, std::size_t index, double by);

}  // namespace tactus::window
