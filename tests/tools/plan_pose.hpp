// SPDX-License-Identifier: Apache-2.0
// Poses in the files of plans and in what verbs print.
#pragma once

#include "dsp/core/types.hpp"

#include <nlohmann/json.hpp>

namespace tactus::test {

/// As a plan file ("position_m") or a verb and `truth.json` ("position_mm") have it; quaternion w x y z.
inline Pose pose_in(const nlohmann::json& j) {
    const bool is_mm = j.contains("position_mm");
    const nlohmann::json &p = j[is_mm ? "position_mm" : "position_m"], &q = j["quaternion_wxyz"];
    return {Vec3(p[0].get<double>(), p[1].get<double>(), p[2].get<double>()) * (is_mm ? 1e-3 : 1.0),
            {q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>()}};
}

}  // namespace tactus::test
