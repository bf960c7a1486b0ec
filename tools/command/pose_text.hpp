// SPDX-License-Identifier: Apache-2.0
// Poses as text and JSON.
#pragma once

#include "tools/analysis/bone/fragment_file.hpp"

#include <string>
#include <string_view>

namespace tactus::command {

/// {position_mm, quaternion_wxyz}, in a JSON type.
template <class Json>
Json pose_json(const Pose& pose) {
    const analysis::PoseNumbers numbers = analysis::numbers_of(pose);
    return {{"position_mm", numbers.position_mm}, {"quaternion_wxyz", numbers.quaternion_wxyz}};
}

/// "X,Y,Z,QW,QX,QY,QZ" in mm. Throws Error naming the option.
Pose pose_of_text(const std::string& text, std::string_view option);

}  // namespace tactus::command
