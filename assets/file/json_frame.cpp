// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json_frame.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

namespace tactus::file {

namespace {

std::string where_of(const std::string& file, const Json& value) {
    return value.line() > 0 ? fmt::format("{}:{}", file, value.line()) : file;
}

std::string text_of_value(const Json& value) {
    return value.is_string() ? value.as_text().substr(0, 80) : value.dump().substr(0, 80);
}

}  // namespace

void require_lps_mm(const Json& json, std::string_view unit_key, const std::string& file) {
    if (const Json* frame = json.find("frame")) {
        const std::string text = frame->is_string() ? frame->as_text() : "";
        // "LPS; the jaw and the leg have frames of their own" is LPS, "LPSX" is not.
        const bool is_lps = text.starts_with("LPS") &&
                            (text.size() == 3 || std::string_view(" ,;:(/+").find(text[3]) != std::string_view::npos);
        if (!is_lps)
            throw Error(fmt::format(
                "{}: 'frame' must be \"LPS\", not \"{}\"{}", where_of(file, *frame), text_of_value(*frame),
                text.starts_with("RAS") ? "; change the sign of x and y of all positions and directions" : ""));
    }
    if (const Json* unit = json.find(unit_key))
        if (!unit->is_string() || unit->as_text() != "mm")
            throw Error(fmt::format("{}: '{}' must be \"mm\", not \"{}\"", where_of(file, *unit), unit_key,
                                    text_of_value(*unit)));
}

}  // namespace tactus::file
