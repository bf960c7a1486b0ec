// SPDX-License-Identifier: Apache-2.0
// Labels of a sound, as Audacity exports them: start, end and a text per line, in s, separated by tabs. They have the form of a log
// without names, but hold no samples.
#pragma once

#include <string_view>

namespace tactus::table {

/// True when every line has a start, an end that is not before it, and a text, and a label ends before the next begins: all labels if
/// their texts are numbers or empty, since a table of three columns has that form too; else half of them, as labels may overlap. Lines
/// that begin with a backslash hold the frequencies of the label above. `text`: the first lines of a file.
bool is_label_track(std::string_view text);

}  // namespace tactus::table
