// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand and of the whole body as results.
#pragma once

#include "tools/analysis/vibration/body_exposure.hpp"
#include "tools/report/vibration/record_fields.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

/// Of the hand, on one day.
struct HandExposure {
    std::vector<Tried<analysis::ExposureOperation>> operations;
    std::optional<double> a8;  ///< m/s²; none: see `no_day`
    std::string no_day;        ///< why there is no A(8) of the day

    bool is_lower_bound() const;
};

/// Of the whole body, on one day.
struct BodyExposure {
    std::string body;  ///< whole or rail
    std::vector<Tried<analysis::BodyOperation>> operations;
    std::optional<analysis::BodyDay> day;  ///< of health only; none: see `no_day`
    std::string no_day;
};

const Fields<analysis::ExposureOperation>& hand_operation_fields();
const Fields<HandExposure>& hand_exposure_fields();

/// An axis with its operation.
struct BodyAxisOf {
    const analysis::BodyOperation* operation;
    const analysis::BodyOperation::Axis* axis;

    double factor() const;
    double a8() const;  ///< m/s²
    /// Time until the axis alone makes A(8) reach `value`, s.
    double time_to(double value) const;
};

const Fields<BodyAxisOf>& body_axis_fields();
const Fields<BodyExposure>& body_exposure_fields();

/// Axes in the order of the operation.
std::vector<BodyAxisOf> axes_of(const analysis::BodyOperation& operation);

}  // namespace tactus::report
