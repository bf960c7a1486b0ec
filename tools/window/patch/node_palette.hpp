// SPDX-License-Identifier: Apache-2.0
// The list of node types that opens on the canvas: type some words, choose, and the node is there.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/patch/type_search.hpp"
#include "tools/window/widgets/painter.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class NodePalette {
public:
    explicit NodePalette(Workbench& bench) : bench_(bench) {}

    /// `at`: pixels of the window; `world`: where the node will stand. `from`: an output that will feed it, or empty.
    void open(Point at, Point world, const std::string& from, const ValueType* type);
    /// Returns the name of a node that was added, or nothing.
    std::string draw(const Fonts& fonts);

private:
    std::string add(const NodeType& type);
    void preview(const NodeType& type) const;

    Workbench& bench_;
    bool wants_open_ = false;
    Point at_, world_;
    std::string from_, words_, lane_;
    const ValueType* type_ = nullptr;
    std::vector<const NodeType*> found_;
    std::size_t chosen_ = 0;
};

}  // namespace tactus::window
