// SPDX-License-Identifier: Apache-2.0
// The text of a PDF file, as another program extracts it.
#pragma once

#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <optional>

namespace tactus::test {

/// Whether this program is installed; if not, the running test case is skipped.
inline bool has_program(const std::string& name) {
    if (std::system(("command -v " + name + " >/dev/null").c_str()) == 0) return true;
    skip(name + " is not installed");
    return false;
}

/// None, and the running case skipped, where pdftotext is missing. Throws nothing for a damaged file: its text is empty.
inline std::optional<std::string> pdf_text(const Folder& folder, const fs::path& pdf) {
    if (!has_program("pdftotext")) return std::nullopt;
    const fs::path text = folder.path / "pdf.txt";
    const std::string command = "pdftotext -layout '" + pdf.string() + "' " + text.string();
    return std::system(command.c_str()) == 0 ? slurp(text) : std::string();
}

}  // namespace tactus::test
