// SPDX-License-Identifier: Apache-2.0
// The errors of a patch below its panels: each leads to its node, and is repaired by a button or in its line.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/widgets/painter.hpp"

#include <string>
#include <vector>

namespace tactus::window {

class FaultList {
public:
    explicit FaultList(Workbench& bench) : bench_(bench) {}

    /// Its height within this room; 0: the patch has no errors.
    double height(double room, const Fonts& fonts) const;
    /// Returns the node that is to be shown because its error was clicked; empty: none.
    std::string draw(double height, const Fonts& fonts);

private:
    void draw_fault(std::size_t index, const Fault& fault, std::string& wanted);
    void draw_repairs(std::size_t index, const Fault& fault);

    Workbench& bench_;
    std::int64_t version_ = -1;
    std::vector<std::string> lines_;  ///< as they are edited
    std::function<void()> repair_;    ///< after all are drawn
};

}  // namespace tactus::window
