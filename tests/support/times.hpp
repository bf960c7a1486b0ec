// SPDX-License-Identifier: Apache-2.0
// Times that tests name.
#pragma once

#include "dsp/core/time.hpp"

namespace tactus {

inline constexpr Flicks ms = flicks_per_second / 1000;

}  // namespace tactus
