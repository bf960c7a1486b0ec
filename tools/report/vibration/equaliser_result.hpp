// SPDX-License-Identifier: Apache-2.0
// A measured response, and a filter made of one, as results.
#pragma once

#include "tools/analysis/vibration/equalisation.hpp"
#include "tools/analysis/vibration/measurement.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::report {

struct MadeEqualiser {
    std::filesystem::path file;
    const analysis::Equalisation* made;
    std::string kind;  ///< minimum or linear
};

const Fields<MadeEqualiser>& equaliser_fields();

struct MeasuredResponse {
    const analysis::Measurement* found;
    std::filesystem::path csv;
    double fit_lowest;  ///< Hz
    std::optional<MadeEqualiser> equaliser;
};

const Fields<MeasuredResponse>& measurement_fields();

}  // namespace tactus::report
