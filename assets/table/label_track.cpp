// SPDX-License-Identifier: Apache-2.0
#include "assets/table/label_track.hpp"

#include "assets/table/log_lines.hpp"
#include "assets/table/log_shape.hpp"

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tactus::table {

namespace {

constexpr int max_tried_lines = 1000;
constexpr double same_time = 1.5e-6;  // s: times have six digits

/// With a decimal point, or the decimal comma of some languages.
std::optional<double> time_of(std::string_view field) {
    std::string text(field);
    if (const std::size_t comma = text.find(','); comma != std::string::npos) text[comma] = '.';
    double time = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), time);
    if (failure != std::errc{} || end != text.data() + text.size() || !(time >= 0.0)) return std::nullopt;
    return time;
}

/// A label may hold what separates the fields of logs.
std::vector<std::string_view> fields_between_tabs(std::string_view line) {
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t end = fields.size() < 2 ? line.find('\t') : std::string_view::npos;
        fields.push_back(trimmed(line.substr(0, end)));
        if (end == std::string_view::npos) return fields;
        line.remove_prefix(end + 1);
    }
}

}  // namespace

bool is_label_track(std::string_view text) {
    LogLines lines(text);
    std::size_t labels = 0, apart = 0;
    bool has_words = false, has_frequencies = false;
    double last_end = 0.0;
    for (std::string_view line; lines.number() < max_tried_lines && lines.next(line);) {
        if (line.empty()) continue;
        // The text may end within a line.
        if (lines.at_end() && labels > 1) break;
        const std::vector<std::string_view> fields = fields_between_tabs(line);
        if (fields.size() < 3) return false;
        const std::optional<double> start = time_of(fields[fields[0] == "\\" ? 1 : 0]),
                                    end = time_of(fields[fields[0] == "\\" ? 2 : 1]);
        if (!start || !end || *end < *start) return false;
        if (fields[0] == "\\") {
            if (labels == 0) return false;
            has_frequencies = true;
            continue;
        }
        if (labels > 0) apart += last_end <= *start + same_time;
        ++labels;
        last_end = *end;
        has_words = has_words || (!fields[2].empty() && kind_of(fields[2]) != CellKind::number);
    }
    if (labels == 0 || (labels == 1 && !has_words)) return false;
    return has_frequencies || (has_words ? 2 * apart >= labels - 1 : apart == labels - 1);
}

}  // namespace tactus::table
