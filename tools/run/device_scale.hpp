// SPDX-License-Identifier: Apache-2.0
// --device-scale: adapts one tool to devices of different strength.
#pragma once

#include "tools/run/patch_choice.hpp"

#include <optional>

namespace tactus::run {

/// Sets `device_scale` of each saw and burr of the patch: forces and stiffness on the device are those of the tool
/// times this factor; the tool cuts as with factor 1. Throws Error if the patch has neither.
void choose_device_scale(PatchChoice& choice, std::optional<double> scale);

}  // namespace tactus::run
