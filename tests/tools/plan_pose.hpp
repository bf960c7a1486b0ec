// SPDX-License-Identifier: Apache-2.0
// Poses in the files of plans.
#pragma once

#include "dsp/core/types.hpp"

#include <nlohmann/json.hpp>

namespace tactus::test {

/// As a plan file has it: m, quaternion w x y z.
inline Pose pose_in(const nlohmann::json& j) {
    const nlohmann::json &p = j["position_m"], &q = j["quaternion_wxyz"];
    return {Vec3(p[0].get<double>(), p[1].get<double>(), p[2].get<double>()),
            {q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>()}};
}

}  // namespace tactus::test
