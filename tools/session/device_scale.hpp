// SPDX-License-Identifier: Apache-2.0
// --device-scale: one tool on devices of different strength.
#pragma once

#include "tools/session/patch_choice.hpp"

#include <optional>

namespace tactus::session {

/// Sets `device_scale` of each saw and burr of the patch: forces and stiffness on the device are so many times those of
/// the tool, which cuts as with 1. Throws Error when the patch has neither.
void choose_device_scale(PatchChoice& choice, std::optional<double> scale);

}  // namespace tactus::session
