// SPDX-License-Identifier: Apache-2.0
// The parameters of a node for display in a form.
#pragma once

#include "graph/compile/schedule.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::window {

struct ParameterField {
    enum class Kind { quantity, choice, flag, text, vector, asset } kind = Kind::quantity;
    std::string name, about;
    std::string type;      ///< of an asset: "bone"
    std::string text;      ///< value as written in a patch
    std::string standard;  ///< its default; empty for an asset
    bool is_set = false;   ///< set in the patch
    bool is_live = false;  ///< can be changed while the patch runs
    bool is_driven = false;
    // Of a quantity, in its unit:
    std::string unit;
    double value = 0.0, least = 0.0, most = 0.0, normal = 0.0;  ///< normal: the default
    std::vector<std::string> options;  ///< for a choice; for an asset: the assets of the patch
};

/// The parameters of a node, in order of declaration.
std::vector<ParameterField> parameters_of(const compile::Schedule& plan, int node);

/// Those of a node that is not part of a plan, by its type and what the patch says of it.
std::vector<ParameterField> parameters_of(const NodeType& type, const patch::Patch& patch,
                                          const patch::PatchNode& node);

/// Gives a field the value that a node's text sets, if it does.
void take_setting(ParameterField& field, const patch::PatchNode& node);

/// For quantities with a range too wide for a slider: change per pixel of dragging, in its unit; proportional to the
/// value, at least as for a value of 1. None: use a slider.
std::optional<double> drag_speed(const ParameterField& field);

/// "0.8 N/mm" for a number of the form.
std::string quantity_text(double value, std::string_view unit);

}  // namespace tactus::window
