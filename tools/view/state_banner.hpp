// SPDX-License-Identifier: Apache-2.0
// Says at the foot of the window why a hand feels no force, since when, and how to go on; gone when forces are back.
#pragma once

#include "tools/view/painter.hpp"
#include "tools/view/workbench.hpp"

namespace tactus::view {

void state_banner(Workbench& bench, const Fonts& fonts);

}  // namespace tactus::view
