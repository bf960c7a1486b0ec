// SPDX-License-Identifier: Apache-2.0
// Lines and fields of the text that data loggers write.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

/// Without blanks and quotes at the ends.
std::string_view trimmed(std::string_view text);

/// Text without a byte-order mark. UTF-16 with a mark is converted into `converted`, which then holds the result.
std::string_view without_mark(std::string_view text, std::string& converted);
/// Valid UTF-8 as it is, other text as Latin-1, so that "m/s²" is read from either.
std::string as_utf8(std::string_view text);

/// Lines that end with LF, CR LF or CR.
class LogLines {
public:
    explicit LogLines(std::string_view text) : rest_(text) {}
    /// The next line without its end and without blanks there; false at the end of the text.
    bool next(std::string_view& line);
    int number() const { return number_; }  ///< of the last line, from 1
    bool at_end() const { return rest_.empty(); }

private:
    std::string_view rest_;
    int number_ = 0;
};

/// Comments begin with '#', '%' or "//", and with ';' where that does not separate fields.
bool is_comment(std::string_view line, char separator);

/// Separator of files with one column.
inline constexpr char no_separator = '\0';

/// Fields between separators, trimmed; a quoted field may hold the separator. Between blanks (' ') a run of blanks
/// counts once. A time and " -> " before the first field, as serial monitors write them, is a field of its own.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

}  // namespace tactus::table
