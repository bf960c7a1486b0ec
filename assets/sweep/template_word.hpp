// SPDX-License-Identifier: Apache-2.0
// Words of a command template: "{stiffness}" is replaced by the level of an axis, "{{" and "}}" are braces.
#pragma once

#include "assets/sweep/sweep_file.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sweep {

struct TemplatePart {
    bool is_placeholder = false;
    std::string text;  ///< of a placeholder: without braces
};

/// Throws Error for a brace without partner.
std::vector<TemplatePart> template_parts(std::string_view word);

/// Why `name` is no placeholder of this sweep; empty: it is one.
std::string placeholder_problem(const Sweep& sweep, const std::string& name);

/// The word with all placeholders replaced.
std::string fill_word(std::string_view word, const std::function<std::string(const std::string& name)>& value);

}  // namespace tactus::sweep
