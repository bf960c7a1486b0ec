// SPDX-License-Identifier: Apache-2.0
// What is recorded of an attempt at each activation: the columns of task.csv.
#pragma once

#include <array>
#include <string_view>

namespace tactus::training {

struct AttemptRow {
    double px = 0.0, py = 0.0, pz = 0.0;            ///< m, of the blade in the scene
    double qw = 1.0, qx = 0.0, qy = 0.0, qz = 0.0;
    double fx = 0.0, fy = 0.0, fz = 0.0;            ///< N, on the hand
    double contact = 0.0;                           ///< 1: the blade touches the bone
    double removed = 0.0;                           ///< m³ so far
    double heat = -1.0;                             ///< s above the temperature that harms; below 0: not known
};

inline constexpr std::size_t attempt_columns = 13;
inline constexpr std::array<std::string_view, attempt_columns> attempt_column_names{
    "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz", "fx_N", "fy_N", "fz_N", "contact", "removed_m^3", "heat_s"};
static_assert(sizeof(AttemptRow) == attempt_columns * sizeof(double));

}  // namespace tactus::training
