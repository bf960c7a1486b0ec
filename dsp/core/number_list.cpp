// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/number_list.hpp"

#include <charconv>
#include <cmath>

namespace tactus {

std::vector<std::vector<double>> rows_of_numbers(const std::string& text, const SourceLocation& where) {
    std::vector<std::vector<double>> rows(1);
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == ' ' || text[at] == '\t' || text[at] == '\n') {
            ++at;
            continue;
        }
        if (text[at] == ',') {
            if (rows.back().empty()) throw Error(where, "there are no numbers before a comma in '" + text + "'");
            rows.emplace_back();
            ++at;
            continue;
        }
        const std::size_t end = std::min(text.find_first_of(" \t\n,", at), text.size());
        double number = 0.0;
        const auto [stop, failure] = std::from_chars(text.data() + at, text.data() + end, number);
        if (failure != std::errc{} || stop != text.data() + end || !std::isfinite(number))
            throw Error(where, "'" + text.substr(at, end - at) + "' is no number");
        rows.back().push_back(number);
        at = end;
    }
    if (rows.back().empty()) rows.pop_back();
    return rows;
}

}  // namespace tactus
