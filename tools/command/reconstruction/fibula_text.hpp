// SPDX-License-Identifier: Apache-2.0
// The cuts of a fibula as JSON and text, in mm and degrees.
#pragma once

#include "assets/file/json.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"

namespace tactus::command {

file::Json fibula_json(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan);
void print_fibula(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan);

}  // namespace tactus::command
