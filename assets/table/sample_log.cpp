// SPDX-License-Identifier: Apache-2.0
#include "assets/table/sample_log.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/clock_time.hpp"
#include "assets/table/decimal_sign.hpp"
#include "assets/table/label_track.hpp"
#include "assets/table/log_columns.hpp"
#include "assets/table/log_lines.hpp"
#include "assets/table/log_shape.hpp"
#include "assets/table/recording.hpp"
#include "assets/table/repeated_rows.hpp"
#include "assets/table/time_unit.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace tactus::table {

namespace {

constexpr double longest_pause = 86400.0;  // s; a longer one is a clock that was set
constexpr int max_trailer_lines = 100, max_lines = 2'000'000'000;
constexpr std::size_t rows_between_checks = std::size_t{1} << 16;
constexpr std::size_t max_steps = 1'000'000;  // of which the mean is taken to find a unit

class Reader {
public:
    Reader(LogBlocks::Source source, const std::string& file, const LogSelection& selection)
        : lines_(std::move(source)),
          file_(file),
          selection_(selection),
          shape_(shape_of(lines_.head(std::size_t{4} << 20), file, selection)),
          sign_(shape_.separator) {}

    SampleLog read() {
        std::string_view line;
        while (lines_.number() + 1 < shape_.first_row) lines_.next(line);
        bool is_first = true;
        while (lines_.next(line)) {
            if (line.size() > LogBlocks::max_line)
                fail_at(lines_.number(), 1, "the line is longer than 64 KiB; this is not a CSV log");
            if (trimmed(line).empty() || is_comment(line, shape_.separator)) continue;
            line_ = lines_.number();
            if (line_ == max_lines) fail_at(line_, 1, "the log has more than 2e9 lines; cut it");
            split_fields(line, shape_.separator, fields_);
            if (is_first) choose();
            is_first = false;
            if (log_.form.trailer > 0 || is_statistic(fields_.front())) {
                if (++log_.form.trailer > max_trailer_lines)
                    fail_at(line_, 1, "rows follow below a row of statistics; cut the file there");
                continue;
            }
            if (is_selected()) row(line, lines_.at_end());
        }
        check_sources();
        check_clocks();
        if (const auto doubt = sign_.doubt()) fail_at(doubt->line, 1, doubt->why);
        if (log_.times.empty()) fail_at(0, 0, "there is no row with a number in every chosen column");
        if (!columns_.time && !selection_.rate && sign_.sign() == ',' && !shape_.rate->point.empty())
            fail_at(shape_.rate->line, 1,
                    fmt::format("'{}' may have a thousands separator, for the numbers of the file have decimal commas; "
                                "state the rate with --sample-rate",
                                shape_.rate->point));
        if (columns_.time) log_.form.repeated = leave_out_repeated_rows(log_);
        settle_time_unit();
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

    static LogShape shape_of(std::string_view head, const std::string& file, const LogSelection& selection) {
        if (selection.columns.empty() && selection.time_column.empty() && is_label_track(head))
            throw Error(
                fmt::format("{}: these are labels of a sound (start, end, text), as Audacity exports them, and no "
                            "samples; give the sound itself, and the stretch of a label with --from and --to",
                            file));
        return find_log_shape(head, file, selection.skip_rows);
    }

    void choose() {
        columns_ = choose_log_columns(shape_, fields_, file_, selection_);
        for (const std::size_t column : columns_.values) {
            std::string name = columns_.named[column].name;
            // Columns of equal names get numbers.
            if (std::ranges::count(columns_.named, name, &NamedColumn::name) > 1)
                name += fmt::format(" (column {})", column + 1);
            log_.names.push_back(std::move(name));
            log_.units.push_back(columns_.named[column].unit);
            needed_ = std::max(needed_, column);
        }
        if (columns_.time) {
            log_.time_name = shape_.names[*columns_.time];
            needed_ = std::max(needed_, *columns_.time);
        }
        log_.columns.resize(columns_.values.size());
        std::vector<std::size_t> values;
        for (std::size_t i = 0; i < shape_.names.size(); ++i)
            if (shape_.kinds[i] == CellKind::number && i != columns_.time && !is_time_name(columns_.named[i].name))
                values.push_back(i);
        log_.sensitivities = assign_sensitivities(shape_.sensitivities, columns_.named, values, columns_.values);
        for (const std::size_t column : columns_.sources) sources_.push_back({column, {}, {}, 0});
        clock_times_.resize(columns_.clocks.size());
    }

    /// "Mean", "Max:", "Std. dev."
    bool is_statistic(std::string_view field) const {
        if (field.empty() || (field.front() >= '0' && field.front() <= '9') || field.front() == '-' || rows_ == 0)
            return false;
        const std::string word = lower(field.substr(0, field.find_first_of(" :._(")));
        constexpr std::array<std::string_view, 16> words{
            "mean",   "average", "avg", "min",   "max",    "minimum",    "maximum",    "std",
            "stddev", "rms",     "sum", "total", "median", "statistics", "mittelwert", "summary"};
        return std::ranges::find(words, word) != words.end();
    }

    bool is_selected() {
        if (!columns_.where) return true;
        if (*columns_.where >= fields_.size()) return false;
        const std::string_view field = fields_[*columns_.where];
        if (field == columns_.wanted) return true;
        const std::optional<double> number = sign_.parse(field), wanted = sign_.parse(columns_.wanted);
        return number && wanted && *number == *wanted;
    }

    /// Rows from several sensors in turn have a column that says which.
    struct Source {
        std::size_t column;
        std::map<std::string, std::size_t, std::less<>> rows;  // of each value
        std::string last;
        std::size_t changes;
    };
    static constexpr std::size_t max_sources = 64;

    void note_sources() {
        for (Source& source : sources_) {
            if (source.rows.size() > max_sources || source.column >= fields_.size()) continue;
            const std::string_view field = fields_[source.column];
            if (field.empty()) continue;
            const auto found = source.rows.find(field);
            if (found != source.rows.end()) ++found->second;
            else source.rows.emplace(std::string(field), 1);
            if (field == source.last) continue;
            if (!source.last.empty()) ++source.changes;
            source.last = field;
        }
    }

    [[noreturn]] void refuse_sources(const Source& source) const {
        std::vector<std::string> values;
        for (const auto& [value, rows] : source.rows)
            if (values.size() < 8) values.push_back(fmt::format("{} ({} rows)", as_utf8(value), rows));
        const std::string& name = shape_.names[source.column];
        fail_at(
            shape_.header_line, static_cast<int>(source.column) + 1,
            fmt::format("the rows are from {} sensors, by column '{}': {}; choose one, as --where \"{}={}\"",
                        source.rows.size(), name, fmt::join(values, ", "), name, as_utf8(source.rows.begin()->first)));
    }

    void check_sources() const {
        for (const Source& source : sources_) {
            const std::size_t values = source.rows.size();
            if (values < 2 || values > max_sources || 2 * values > rows_) continue;
            const bool is_named = is_source_name(shape_.names[source.column]);
            // Words that change all the time, in a column of any name.
            if (is_named || (values <= 8 && 5 * source.changes > rows_)) refuse_sources(source);
        }
    }

    void check_clocks() const {
        std::vector<double> steps;
        for (const std::vector<double>& times : clock_times_) steps.push_back(mean_step(times));
        for (std::size_t i = 1; i < steps.size(); ++i) {
            if (clock_times_[i].size() < 3 || steps[0] <= 0.0) continue;
            // The units may differ.
            double ratio = steps[i] / steps[0];
            while (ratio > 31.6) ratio *= 1e-3;
            while (ratio > 0.0 && ratio < 0.0316) ratio *= 1e3;
            if (std::abs(ratio - 1.0) < 0.02) continue;
            std::vector<std::string> names;
            for (const std::size_t column : columns_.clocks) names.push_back(shape_.names[column]);
            fail_at(shape_.header_line, static_cast<int>(columns_.clocks[i]) + 1,
                    fmt::format(
                        "the columns follow clocks of different rates: {}; choose one with --time-column, or columns "
                        "that follow one clock with --column; there are {}",
                        fmt::join(names, ", "), fmt::join(shape_.names, ", ")));
        }
    }

    void note_clocks() {
        for (std::size_t i = 0; i < clock_times_.size(); ++i)
            if (columns_.clocks[i] < fields_.size() && clock_times_[i].size() < 100'000)
                if (const std::optional<double> time = sign_.parse(fields_[columns_.clocks[i]]))
                    clock_times_[i].push_back(*time);
    }

    void row(std::string_view line, bool is_last) {
        const auto index = static_cast<double>(rows_++);
        note_sources();
        note_clocks();
        if (fields_.size() <= needed_) {
            // A logger that lost power may leave an incomplete last line.
            if (!is_last)
                fail_at(line_, 1,
                        fmt::format("the row has {} fields; column {} is needed", fields_.size(), needed_ + 1));
            ++log_.lost_rows;
            return;
        }
        // "0.5,1,25": half of a number with a decimal comma would be lost.
        for (std::size_t extra = shape_.names.size(); extra < fields_.size(); ++extra)
            if (kind_of(fields_[extra]) == CellKind::number)
                fail_at(line_, 1,
                        fmt::format("the row has {} fields, and there are {} columns; are commas decimal here?",
                                    fields_.size(), shape_.names.size()));
        std::optional<double> time;
        if (columns_.time) time = time_in(*columns_.time);
        else time = index / columns_.rate;
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
        if (!log_.times.empty()) note_advance(*time, line);
        last_time_ = *time;
        // Times that follow from a rate are kept as the numbers of their rows, which take no memory.
        log_.times.push_back(columns_.time ? *time : index);
        for (std::size_t i = 0; i < values_.size(); ++i) log_.columns[i].push_back(values_[i]);
        if (rows_ % rows_between_checks == 0) require_room();
    }

    void require_room() const {
        std::size_t bytes = log_.times.bytes();
        for (const PackedColumn& column : log_.columns) bytes += column.bytes();
        file::require_room(static_cast<double>(bytes), file_, "its rows");
        leave_if_stopped();
    }

    void note_advance(double time, std::string_view line) {
        const double last = last_time_;
        const int column = columns_.time ? static_cast<int>(fields_[*columns_.time].data() - line.data()) + 1 : 1;
        if (time < last)
            for (const Source& source : sources_)
                if (source.changes > 0 && source.rows.size() <= max_sources &&
                    (is_source_name(shape_.names[source.column]) || source.rows.size() <= 8))
                    refuse_sources(source);
        if (time < last)
            fail_at(line_, column,
                    fmt::format("time runs backwards, from {} to {}; cut the file there{}", time_text(last),
                                time_text(time),
                                shape_.header_line == 0
                                    ? ", or state what the times are with --time-column or --sample-rate, for the "
                                      "columns have no names"
                                    : ""));
        if (time - last > longest_step_.length) longest_step_ = {time - last, last, line_, column};
    }

    std::string time_text(double time) const {
        const std::string unit = has_clock_ || !columns_.time ? "s" : columns_.unit ? columns_.unit->symbol : "";
        return fmt::format("{:.9g}{}{}", static_cast<double>(origin_) + time, unit.empty() ? "" : " ", unit);
    }

    /// Without a stated or named unit the rate of the samples decides, if only one unit makes it plausible.
    void settle_time_unit() {
        double seconds = 1.0;
        if (!columns_.time) log_.times.scale(1.0, columns_.rate);
        if (columns_.time && !has_clock_) {
            if (!columns_.unit) columns_.unit = guessed_unit();
            seconds = columns_.unit->seconds;
            log_.times.scale(seconds);
        }
        if (longest_step_.length * seconds > longest_pause)
            fail_at(longest_step_.line, longest_step_.column,
                    fmt::format("time jumps by more than a day, from {} to {}; cut the file there",
                                time_text(longest_step_.from), time_text(longest_step_.from + longest_step_.length)));
    }

    TimeUnit guessed_unit() {
        std::vector<double> first(std::min(log_.times.size(), max_steps));
        log_.times.read(0, first);
        const auto fail = [&](const std::string& message) {
            fail_at(shape_.header_line > 0 ? shape_.header_line : shape_.first_row,
                    static_cast<int>(*columns_.time) + 1, message);
        };
        SettledTimeUnit settled =
            table::settle_time_unit(first, static_cast<double>(origin_), shape_.rate ? shape_.rate->value : 0.0,
                                    shape_.rate ? fmt::format("line {}", shape_.rate->line) : "", log_.time_name, fail);
        unit_reason_ = std::move(settled.reason);
        return std::move(settled.unit);
    }

    /// None: the field has no value.
    std::optional<double> number_in(std::size_t column) {
        std::string_view field = fields_[column];
        if (field.empty()) return std::nullopt;
        // Nearly all fields: a number whose way of writing is known.
        if (const std::optional<double> plain = sign_.parse_known(field)) return plain;
        double factor = 1.0;
        if (const std::optional<Measure> measure = with_unit(field)) {
            field = measure->number;
            factor = factor_of(column, measure->unit);
        }
        if (const auto refused = sign_.note(field, line_)) fail_at(line_, 1, *refused);
        const std::optional<double> number = sign_.parse(field);
        if (number) return std::isfinite(*number) ? std::optional(factor * *number) : std::nullopt;
        if (kind_of(field) == CellKind::lost) return std::nullopt;
        const bool is_header = column < shape_.names.size() && as_utf8(field) == shape_.names[column];
        fail(column, is_header
                         ? fmt::format("the names of the columns come again, as if the logger was restarted; "
                                       "cut the file there")
                         : fmt::format("'{}' in field {} is not a number", as_utf8(field.substr(0, 40)), column + 1));
    }

    static std::optional<Measure> with_unit(std::string_view field) {
        const char last = field.back();
        if ((last >= '0' && last <= '9') || last == '.') return std::nullopt;
        return split_measure(field);
    }

    /// Of a value with that unit behind it, in the unit of its column; the first such value sets it.
    double factor_of(std::size_t column, std::string_view text) {
        if (column == cell_column_ && text == cell_text_) return cell_factor_;
        const std::optional<ColumnUnit> unit = parse_column_unit(as_utf8(text));
        double factor = 1.0;
        if (column == columns_.time && unit->is_time()) {
            if (!columns_.unit) {
                columns_.unit = TimeUnit{unit->text, unit->si};
                if (const std::optional<TimeUnit> known = time_unit_of_word(unit->text)) columns_.unit = known;
            }
            factor = unit->si / columns_.unit->seconds;
        } else if (const auto chosen = std::ranges::find(columns_.values, column); chosen != columns_.values.end()) {
            std::optional<ColumnUnit>& known = log_.units[static_cast<std::size_t>(chosen - columns_.values.begin())];
            if (!known && log_.times.empty()) known = unit;
            if (!known || known->dimension != unit->dimension)
                fail(column, fmt::format("the value has the unit '{}', and the column {}", as_utf8(text),
                                         known ? fmt::format("'{}'", known->text) : std::string("none")));
            factor = unit->si / known->si;
        }
        cell_column_ = column, cell_text_ = text, cell_factor_ = factor;
        return factor;
    }

    /// "1.7000000000001953e+18" as "1700000000000195300": its digits with the point moved. Empty for other text.
    static std::string without_exponent(std::string_view field) {
        const std::size_t mark = std::min(field.find_first_of("eE"), field.size());
        std::string_view power = field.substr(std::min(mark + 1, field.size()));
        if (power.starts_with('+')) power.remove_prefix(1);
        int shift = 0;
        const auto [end, failure] = std::from_chars(power.data(), power.data() + power.size(), shift);
        if (failure != std::errc{} || end != power.data() + power.size() || shift < 0 || shift > 18) return {};
        std::string out(field.substr(0, mark));
        if (out.find_first_not_of("+-0123456789.,") != std::string::npos) return {};
        std::size_t point = std::min(out.find_first_of(".,"), out.size());
        if (point == out.size()) out += '.';
        for (; shift > 0; --shift, ++point) {
            if (point + 1 == out.size()) out += '0';
            std::swap(out[point], out[point + 1]);
        }
        if (out.back() == '.' || out.back() == ',') out.pop_back();
        return out;
    }

    /// Epochs have more digits than a double: from 1e9 on, whole units are counted from those of the first time.
    double since_origin(std::string_view field, double number) {
        std::string plain;
        if (field.find_first_of("eE") != std::string_view::npos) field = plain = without_exponent(field);
        if (!has_numbers_ && std::abs(number) >= 1e9 && std::abs(number) < 9e18)
            origin_ = static_cast<std::int64_t>(number);
        has_numbers_ = true;
        if (origin_ == 0) return number;
        std::int64_t whole = 0;
        const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), whole);
        const std::string_view rest(end, field.size() - static_cast<std::size_t>(end - field.data()));
        if (failure != std::errc{} || (!rest.empty() && rest.front() != '.' && rest.front() != ',') ||
            rest.find_first_not_of("0123456789", 1) != std::string_view::npos)
            return number - static_cast<double>(origin_);
        double fraction = 0.0;
        if (!rest.empty()) {
            const std::optional<double> parsed = rest.size() > 1 ? sign_.parse(rest) : 0.0;
            if (!parsed) return number - static_cast<double>(origin_);
            fraction = field.front() == '-' ? -*parsed : *parsed;
        }
        return static_cast<double>(whole - origin_) + fraction;
    }

    std::optional<double> time_in(std::size_t column) {
        const std::string_view field = fields_[column];
        const std::optional<ClockTime> clock = parse_clock_time(field);
        if (!clock) {
            if (has_clock_)
                fail(column, fmt::format("'{}' in field {} is not a time", as_utf8(field.substr(0, 40)), column + 1));
            const std::optional<double> number = number_in(column);
            if (!number) return std::nullopt;
            return since_origin(field, *number);
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
        if (!columns_.time)
            form.time = selection_.rate ? fmt::format("{:.6g} Hz, as stated", columns_.rate)
                                        : fmt::format("{:.6g} Hz, as line {} states", columns_.rate, shape_.rate->line);
        else if (has_clock_)
            form.time = fmt::format("{} in column '{}'", has_day_ ? "dates and times" : "times of day", log_.time_name);
        else {
            form.is_time_unit_stated = unit_reason_.empty();
            form.time = fmt::format("column '{}' in {}{}", log_.time_name, columns_.unit->symbol,
                                    unit_reason_.empty() ? "" : fmt::format(" ({})", unit_reason_));
        }
    }

    LogBlocks lines_;
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
    std::vector<Source> sources_;
    std::vector<std::vector<double>> clock_times_;
    // Times of the clock.
    bool has_clock_ = false, has_numbers_ = false, has_day_ = false, has_zone_ = false;
    std::int64_t first_day_ = 0;
    std::string date_;
    double wraps_ = 0.0, last_clock_ = -1e300, last_time_ = 0.0;
    // Times that are numbers, in the unit of their column.
    std::int64_t origin_ = 0;  // whole units that are subtracted
    std::string unit_reason_;  // why this unit; empty: stated or named
    struct Step {
        double length = 0.0, from = 0.0;
        int line = 0, column = 0;
    } longest_step_;
    // The last unit behind a value.
    std::size_t cell_column_ = 0;
    std::string cell_text_;
    double cell_factor_ = 1.0;
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
    if (!form.format.empty()) return form.format + "; time: " + form.time;
    std::string text = form.separator == '\0'  ? "one column"
                       : form.separator == ' ' ? "separated by blanks"
                                               : form.separator_name() + "-separated";
    text += form.decimal == '\0' ? ", whole numbers" : ", decimal " + form.decimal_name();
    text += form.header_line > 0 ? fmt::format(", names in line {}", form.header_line) : std::string(", no names");
    if (form.units_line > 0) text += fmt::format(", units in line {}", form.units_line);
    text += fmt::format(", first row in line {}", form.first_row);
    if (form.skipped > 0) text += fmt::format(" ({} lines not used)", form.skipped);
    if (form.trailer > 0) text += fmt::format(", {} lines of statistics at the end", form.trailer);
    if (form.repeated > 0) text += fmt::format(", {} rows that repeat the row before left out", form.repeated);
    return text + "; time: " + form.time;
}

namespace {

SampleLog read_blocks(LogBlocks::Source source, const std::string& file, const LogSelection& selection) {
    if (selection.rate && (!(*selection.rate > 0.0) || !std::isfinite(*selection.rate)))
        throw Error(fmt::format("{}: the rate of the rows must be above 0", file));
    return Reader(std::move(source), file, selection).read();
}

}  // namespace

SampleLog read_sample_log(std::string_view text, const std::string& file, const LogSelection& selection) {
    const auto source = [rest = text](std::span<char> out) mutable {
        const std::size_t count = rest.copy(out.data(), out.size());
        rest.remove_prefix(count);
        return count;
    };
    return read_blocks(source, file, selection);
}

SampleLog load_sample_log(const std::filesystem::path& path, const LogSelection& selection) {
    const std::uintmax_t size = file::require_file(path);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(fmt::format("{}: cannot be read", path.string()));
    std::array<char, 200> start{};
    file.read(start.data(), start.size());
    const std::string_view begin(start.data(), static_cast<std::size_t>(file.gcount()));
    if (is_matlab_file(begin) || is_universal_file(begin)) {
        file::require_room(static_cast<double>(size), path, "its channels");
        const std::string bytes = file::read_whole_file(path);
        return log_of_recording(
            is_matlab_file(begin) ? read_matlab_file(bytes, path.string()) : read_universal_file(bytes, path.string()),
            path.string(), selection);
    }
    file.clear();
    file.seekg(0);
    const auto source = [&](std::span<char> out) {
        file.read(out.data(), static_cast<std::streamsize>(out.size()));
        if (file.bad()) throw Error(fmt::format("{}: cannot be read", path.string()));
        return static_cast<std::size_t>(file.gcount());
    };
    return read_blocks(source, path.string(), selection);
}

}  // namespace tactus::table
