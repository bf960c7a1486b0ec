// SPDX-License-Identifier: Apache-2.0
// Formulas over quantities with units, compiled to a program.
#pragma once

#include "graph/formula/measure.hpp"
#include "graph/formula/program.hpp"
#include "graph/formula/slope.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::formula {

/// A variable of a formula. Its values are in SI units.
struct Variable {
    std::string name;
    Measure measure;
    std::string unit{};  ///< as written
    Interval range{};    ///< SI; everything when none is given
};

/// A constant: "k" of "0.8 N/mm".
struct Constant {
    std::string name;
    double value = 0.0;  ///< SI
    Measure measure;
};

struct Formula {
    Program program;
    Measure measure;  ///< of the result
};

/// Compiles `text`. Precedence, from weak to strong: or; and; not; < <= > >= == !=; + -; * / %; sign; ^ (from the right,
/// so that -2^2 is -4 and 2^3^2 is 512). A number may carry a unit behind it: "0.5 N/mm", "10 deg"; a unit's '/', '*'
/// and '^' follow without a blank. Functions: min max abs sqrt exp log sin cos tan asin acos atan atan2 hypot floor ceil
/// sign clip(x, low, high) if(condition, then, else); pi is known. What is added or compared must be of one kind; the
/// exponent of a quantity with a unit must be a constant; angles are in rad. Throws Error with the column.
Formula compile_formula(std::string_view text, std::span<const Variable> variables,
                        std::span<const Constant> constants);

/// "depth m, v m/s, n": names with their units; "depth m from 0 mm to 5 mm" gives one a range. Throws Error.
std::vector<Variable> parse_variables(std::string_view text);
/// "k = 0.8 N/mm, c = 2 N s/m". Throws Error.
std::vector<Constant> parse_constants(std::string_view text);

}  // namespace tactus::formula
