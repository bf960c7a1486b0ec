// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tactus::table {

/// A field of a CSV file (RFC 4180), quoted if it contains a comma, a quote or a line end.
inline std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

}  // namespace tactus::table
