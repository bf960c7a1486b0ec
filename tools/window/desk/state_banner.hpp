// SPDX-License-Identifier: Apache-2.0
// Says at the foot of the window why a hand feels no force, since when, and how to go on; gone when forces are back.
#pragma once

#include "tools/window/document/workbench.hpp"
#include "tools/window/widgets/painter.hpp"

namespace tactus::window {

void state_banner(Workbench& bench, const Fonts& fonts);

}  // namespace tactus::window
