// SPDX-License-Identifier: Apache-2.0
// The parameters of a node as a form shows them.
#pragma once

#include "graph/compile/plan.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::view {

struct ParameterField {
    enum class Kind { quantity, choice, flag, text, vector, asset } kind = Kind::quantity;
    std::string name, about;
    std::string text;      ///< its value as a patch would write it
    std::string standard;  ///< its default; empty for an asset
    bool is_set = false;   ///< the patch writes it
    bool is_live = false;  ///< can be turned while the patch runs
    bool is_driven = false;
    // Of a quantity, in its unit:
    std::string unit;
    double value = 0.0, least = 0.0, most = 0.0, normal = 0.0;  ///< normal: by default
    std::vector<std::string> options;  ///< of a choice; of an asset those the patch names
};

/// Of one node of a plan, in the order of its declaration.
std::vector<ParameterField> parameters_of(const compile::Plan& plan, int node);

/// Of a quantity whose range is so wide that no slider finds what is common: by how much a pixel of dragging turns it, in
/// its unit. Relative to its value, and at least as for a value of 1. None: a slider does.
std::optional<double> drag_speed(const ParameterField& field);

/// "0.8 N/mm" for a number that a form gives.
std::string quantity_text(double value, std::string_view unit);

}  // namespace tactus::view
