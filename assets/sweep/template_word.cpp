// SPDX-License-Identifier: Apache-2.0
#include "assets/sweep/template_word.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tactus::sweep {

std::vector<TemplatePart> template_parts(std::string_view word) {
    std::vector<TemplatePart> parts;
    std::string plain;
    const auto end_plain = [&] {
        if (!plain.empty()) parts.push_back({false, std::move(plain)});
        plain.clear();
    };
    for (std::size_t i = 0; i < word.size(); ++i) {
        const char c = word[i];
        if (c != '{' && c != '}') {
            plain += c;
            continue;
        }
        if (i + 1 < word.size() && word[i + 1] == c) {
            plain += c;
            ++i;
            continue;
        }
        const std::size_t end = c == '{' ? word.find('}', i) : std::string_view::npos;
        if (end == std::string_view::npos)
            throw Error(fmt::format("a '{}' without partner; write '{}{}' for the character itself", c, c, c));
        end_plain();
        parts.push_back({true, std::string(word.substr(i + 1, end - i - 1))});
        i = end;
    }
    end_plain();
    return parts;
}

std::string placeholder_problem(const Sweep& sweep, const std::string& name) {
    std::vector<std::string> known{"seed", "out", "point", "tactus"};
    for (const auto& [input, path] : sweep.inputs) known.push_back("inputs." + input);
    for (const Axis& axis : sweep.axes) {
        known.push_back(axis.name);
        if (axis.has_numbers) known.push_back(axis.name + ".number");
        if (!axis.files.empty()) known.push_back(axis.name + ".stem");
        for (const std::string& column : axis.columns) known.push_back(axis.name + "." + column);
    }
    if (std::ranges::find(known, name) != known.end()) return {};
    return fmt::format(
        "'{{{}}}' is no axis, input or other name of this sweep{}; it has {{{}}}; braces themselves are '{{{{' and "
        "'}}}}'",
        name, did_you_mean(name, known), fmt::join(known, "}, {"));
}

std::string fill_word(std::string_view word, const std::function<std::string(const std::string& name)>& value) {
    std::string filled;
    for (const TemplatePart& part : template_parts(word)) filled += part.is_placeholder ? value(part.text) : part.text;
    return filled;
}

}  // namespace tactus::sweep
