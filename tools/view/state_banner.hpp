// SPDX-License-Identifier: Apache-2.0
// Says over the panels why a hand feels no force, since when, and how to go on; gone when forces are back.
#pragma once

#include "tools/view/painter.hpp"
#include "tools/view/workbench.hpp"

namespace tactus::view {

/// `corner`: its upper left, on the screen.
void state_banner(Workbench& bench, Point corner, const Fonts& fonts);

}  // namespace tactus::view
