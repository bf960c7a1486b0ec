// SPDX-License-Identifier: Apache-2.0
#include "assets/table/sample_log.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/clock_time.hpp"
#include "assets/table/decimal_sign.hpp"
#include "assets/table/log_columns.hpp"
#include "assets/table/log_lines.hpp"
#include "assets/table/log_shape.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

namespace tactus::table {

namespace {

constexpr double longest_pause = 86400.0;  // s; a longer one is a clock that was set

class Reader {
public:
    Reader(std::string_view text, const std::string& file, const LogSelection& selection)
        : text_(without_mark(text, converted_)),
          file_(file),
          selection_(selection),
          shape_(find_log_shape(text_, file, selection.skip_rows)),
          sign_(shape_.separator) {}

    SampleLog read() {
        LogLines lines(text_);
        std::string_view line;
        while (lines.number() + 1 < shape_.first_row) lines.next(line);
        bool is_first = true;
        while (lines.next(line)) {
            if (line.size() > 65536)
                fail_at(lines.number(), 1, "the line is longer than 64 KiB; this is not a CSV log");
            if (trimmed(line).empty() || is_comment(line, shape_.separator)) continue;
            line_ = lines.number();
            split_fields(line, shape_.separator, fields_);
            if (is_first) choose();
            is_first = false;
            row(line, lines.at_end());
        }
        if (const auto doubt = sign_.doubt()) fail_at(doubt->line, 1, doubt->why);
        if (log_.times.empty()) fail_at(0, 0, "there is no row with a number in every chosen column");
        note_form();
        return std::move(log_);
    }

private:
    [[noreturn]] void fail_at(int line, int column, const std::string& message) const {
        throw Error(SourceLocation{file_, line, line == 0 ? 0 : column}, message);
    }
    [[noreturn]] void fail(std::size_t field, const std::string& message) const {
        fail_at(line_, static_cast<int>(field) + 1, message);
    }

    void choose() {
        columns_ = choose_log_columns(shape_, fields_, file_, selection_);
        for (const std::size_t column : columns_.values) {
            log_.names.push_back(columns_.named[column].name);
            log_.units.push_back(columns_.named[column].unit);
            needed_ = std::max(needed_, column);
        }
        if (columns_.time) {
            log_.time_name = shape_.names[*columns_.time];
            needed_ = std::max(needed_, *columns_.time);
        }
        log_.columns.resize(columns_.values.size());
    }

    void row(std::string_view line, bool is_last) {
        const auto index = static_cast<double>(rows_++);
        if (fields_.size() <= needed_) {
            // A logger that lost power may leave an incomplete last line.
            if (!is_last)
                fail_at(line_, 1,
                        fmt::format("the row has {} fields; column {} is needed", fields_.size(), needed_ + 1));
            ++log_.lost_rows;
            return;
        }
        std::optional<double> time;
        if (columns_.time) time = time_in(*columns_.time);
        else time = index / *selection_.rate;
        bool is_lost = !time;
        values_.assign(columns_.values.size(), 0.0);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const std::optional<double> value = number_in(columns_.values[i]);
            is_lost = is_lost || !value;
            values_[i] = value.value_or(0.0);
        }
        if (is_lost) {
            ++log_.lost_rows;
            return;
        }
        if (!log_.times.empty()) check_advance(*time, line);
        log_.times.push_back(*time);
        for (std::size_t i = 0; i < values_.size(); ++i) log_.columns[i].push_back(values_[i]);
    }

    void check_advance(double time, std::string_view line) const {
        const double last = log_.times.back();
        const int column = columns_.time ? static_cast<int>(fields_[*columns_.time].data() - line.data()) + 1 : 1;
        if (time < last)
            fail_at(line_, column,
                    fmt::format("time runs backwards, from {:.9g} s to {:.9g} s; cut the file there{}", last, time,
                                shape_.header_line == 0
                                    ? ", or state what the times are with --time-column or --sample-rate, for the "
                                      "columns have no names"
                                    : ""));
        if (time - last > longest_pause)
            fail_at(line_, column,
                    fmt::format("time jumps by more than a day, from {:.9g} s to {:.9g} s; cut the file there", last,
                                time));
    }

    /// None: the field has no value.
    std::optional<double> number_in(std::size_t column) {
        const std::string_view field = fields_[column];
        if (field.empty()) return std::nullopt;
        if (const auto refused = sign_.note(field, line_)) fail_at(line_, 1, *refused);
        const std::optional<double> number = sign_.parse(field);
        if (number) return std::isfinite(*number) ? number : std::nullopt;
        if (kind_of(field) == CellKind::lost) return std::nullopt;
        const bool is_header = column < shape_.names.size() && as_utf8(field) == shape_.names[column];
        fail(column, is_header
                         ? fmt::format("the names of the columns come again, as if the logger was started anew; "
                                       "cut the file there")
                         : fmt::format("'{}' in field {} is not a number", as_utf8(field.substr(0, 40)), column + 1));
    }

    std::optional<double> time_in(std::size_t column) {
        const std::string_view field = fields_[column];
        const std::optional<ClockTime> clock = parse_clock_time(field);
        if (!clock) {
            if (has_clock_)
                fail(column, fmt::format("'{}' in field {} is not a time", as_utf8(field.substr(0, 40)), column + 1));
            const std::optional<double> number = number_in(column);
            if (!number) return std::nullopt;
            has_numbers_ = true;
            return *number * columns_.seconds;
        }
        if (has_numbers_)
            fail(column, fmt::format("'{}' in field {} is not a number", as_utf8(field.substr(0, 40)), column + 1));
        const bool has_day = clock->day.has_value();
        if (!has_clock_) {
            first_day_ = clock->day.value_or(0);
            has_day_ = has_day, has_zone_ = clock->has_zone;
            date_ = clock->date;
        }
        has_clock_ = true;
        if (has_day != has_day_ || clock->has_zone != has_zone_)
            fail(column,
                 fmt::format("the time '{}' is written otherwise than the first", as_utf8(field.substr(0, 40))));
        if (has_day) return 86400.0 * static_cast<double>(*clock->day - first_day_) + clock->seconds;
        // A time of day starts again at midnight.
        const bool wrapped = clock->seconds + wraps_ < last_clock_ - 0.5 * clock->period;
        if (wrapped) wraps_ += clock->period;
        else if (clock->date != date_)
            fail(column,
                 "the date changes and the time of day goes on; whether days or months come first is not known: "
                 "write dates as 2024-05-17");
        date_ = clock->date;
        last_clock_ = clock->seconds + wraps_;
        return last_clock_;
    }

    void note_form() {
        LogForm& form = log_.form;
        form.separator = shape_.separator;
        form.decimal = sign_.sign();
        form.header_line = shape_.header_line;
        form.units_line = shape_.units_line;
        form.first_row = shape_.first_row;
        form.skipped = shape_.skipped + std::max(0, selection_.skip_rows.value_or(0));
        if (!columns_.time) form.time = fmt::format("{:.6g} Hz, as stated", *selection_.rate);
        else if (has_clock_)
            form.time = fmt::format("{} in column '{}'", has_day_ ? "dates and times" : "times of day", log_.time_name);
        else {
            form.is_time_unit_stated = columns_.is_unit_stated;
            form.time = fmt::format("column '{}' in {}{}", log_.time_name, columns_.unit,
                                    columns_.is_unit_stated ? "" : " (assumed: no unit is stated)");
        }
    }

    std::string converted_;
    std::string_view text_;
    std::string file_;
    const LogSelection& selection_;
    LogShape shape_;
    DecimalSign sign_;
    SampleLog log_;
    LogColumns columns_;
    std::size_t needed_ = 0, rows_ = 0;
    int line_ = 0;
    std::vector<std::string_view> fields_;
    std::vector<double> values_;
    // Times of the clock.
    bool has_clock_ = false, has_numbers_ = false, has_day_ = false, has_zone_ = false;
    std::int64_t first_day_ = 0;
    std::string_view date_;
    double wraps_ = 0.0, last_clock_ = -1e300;
};

}  // namespace

std::string LogForm::separator_name() const {
    return separator == ','    ? "comma"
           : separator == ';'  ? "semicolon"
           : separator == '\t' ? "tab"
           : separator == ' '  ? "blanks"
           : separator == '\0' ? "none"
                               : std::string(1, separator);
}

std::string LogForm::decimal_name() const { return decimal == '.' ? "point" : decimal == ',' ? "comma" : "none seen"; }

std::string describe(const LogForm& form) {
    std::string text = form.separator == '\0'  ? "one column"
                       : form.separator == ' ' ? "separated by blanks"
                                               : form.separator_name() + "-separated";
    text += form.decimal == '\0' ? ", whole numbers" : ", decimal " + form.decimal_name();
    text += form.header_line > 0 ? fmt::format(", names in line {}", form.header_line) : std::string(", no names");
    if (form.units_line > 0) text += fmt::format(", units in line {}", form.units_line);
    text += fmt::format(", first row in line {}", form.first_row);
    if (form.skipped > 0) text += fmt::format(" ({} lines not used)", form.skipped);
    return text + "; time: " + form.time;
}

SampleLog read_sample_log(std::string_view text, const std::string& file, const LogSelection& selection) {
    if (selection.rate && (!(*selection.rate > 0.0) || !std::isfinite(*selection.rate)))
        throw Error(fmt::format("{}: the rate of the rows must be above 0", file));
    return Reader(text, file, selection).read();
}

SampleLog load_sample_log(const std::filesystem::path& path, const LogSelection& selection) {
    const std::uintmax_t size = file::require_file(path);
    if (size > std::uintmax_t{1} << 32)
        throw Error(fmt::format("{}: a log of more than 4 GiB; cut it first", path.string()));
    file::require_room(static_cast<double>(size), path, "its rows");
    std::ifstream file(path, std::ios::binary);
    std::string text(static_cast<std::size_t>(size), '\0');
    if (!file.read(text.data(), static_cast<std::streamsize>(size)))
        throw Error(fmt::format("{}: cannot be read", path.string()));
    return read_sample_log(text, path.string(), selection);
}

}  // namespace tactus::table
