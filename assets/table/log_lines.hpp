// SPDX-License-Identifier: Apache-2.0
// Lines and fields of the text that data loggers write.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

/// Without blanks and quotes at the ends.
std::string_view trimmed(std::string_view text);

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

/// The same for text that is read in blocks, so that a long log is never in memory. A byte-order mark is left out, UTF-16
/// with a mark is converted.
class LogBlocks {
public:
    /// Fills the span and returns how many bytes; fewer than asked for only at the end.
    using Source = std::function<std::size_t(std::span<char>)>;
    explicit LogBlocks(Source source);

    /// The first `size` bytes, or all; only before the first line.
    std::string_view head(std::size_t size);
    /// The next line without its end and without blanks there, valid until the next call; false at the end of the text. Of a line
    /// that is longer than `max_line` only a part that is longer, too.
    bool next(std::string_view& line);
    int number() const { return number_; }  ///< of the last line, from 1
    /// No line follows. Leaves the last line valid.
    bool at_end() const { return at_ == text_.size() && has_ended_; }

    static constexpr std::size_t max_line = 65536;

private:
    bool fill();

    Source source_;
    std::string text_, raw_;
    std::size_t at_ = 0;
    std::size_t newline_ = 0;  // the first LF not before at_, or the end of text_
    enum class Coding { unknown, bytes, little, big } coding_ = Coding::unknown;
    bool has_ended_ = false;
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
