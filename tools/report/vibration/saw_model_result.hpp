// SPDX-License-Identifier: Apache-2.0
// The model of a saw beside its recordings as a result.
#pragma once

#include "tools/analysis/vibration/saw_modelling.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>

namespace tactus::report {

struct MadeSawModel {
    std::filesystem::path file;
    const analysis::SawModelling* made;
    const analysis::SawModelSettings* settings;
};

const Fields<MadeSawModel>& saw_model_fields();

}  // namespace tactus::report
