// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tactus {

inline constexpr double period = 0.001;  // s, of a force loop

}  // namespace tactus
