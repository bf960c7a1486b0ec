// SPDX-License-Identifier: Apache-2.0
#include "assets/table/log_shape.hpp"

#include "assets/table/clock_time.hpp"
#include "assets/table/column_unit.hpp"
#include "assets/table/log_lines.hpp"
#include "assets/table/stated_rate.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace tactus::table {

namespace {

constexpr std::size_t max_read_lines = 1000, max_text = std::size_t{4} << 20, longest_line = 65536;

/// With decimal commas a line may have more commas than semicolons, so semicolons take precedence.
constexpr std::array separators{';', '\t', ',', ' '};

struct Line {
    std::string_view text;
    int number;
};

using Fields = std::vector<std::string_view>;

Fields fields_of(std::string_view line, char separator) {
    Fields fields;
    split_fields(line, separator, fields);
    return fields;
}

/// Numbers and times outnumber words.
bool holds_numbers(const Fields& fields) {
    std::size_t numbers = 0, words = 0;
    for (const std::string_view field : fields) {
        const CellKind kind = kind_of(field);
        numbers += kind == CellKind::number || kind == CellKind::time;
        words += kind == CellKind::word;
    }
    return numbers > words;
}

struct Table {
    char separator = no_separator;
    std::size_t width = 0;  // fields of most rows
    std::size_t rows = 0;
    std::vector<CellKind> kinds;
};

class Finder {
public:
    Finder(std::string_view text, const std::string& file, std::optional<int> skip_rows)
        : file_(file), skip_rows_(skip_rows) {
        LogLines lines(text.substr(0, max_text));
        for (std::string_view line; lines_.size() < max_read_lines && lines.next(line);) {
            if (line.size() > longest_line)
                fail(lines.number(), "the line is longer than 64 KiB; this is not a CSV log");
            if (line.find('\0') != std::string_view::npos) fail(lines.number(), "this is not a text file");
            if (lines.number() <= skip_rows_.value_or(0) || trimmed(line).empty()) continue;
            if (lines_.empty() && lower(line).starts_with("sep=") && line.size() <= 5)
                forced_ = line.size() == 5 ? line[4] : '\t';
            else lines_.push_back({line, lines.number()});
        }
        if (lines_.empty()) fail(0, "the file is empty; a CSV log is needed");
    }

    LogShape find() {
        choose_separator();
        if (table_.rows == 0) fail(lines_.front().number, "no line holds numbers in columns; a CSV log is needed");
        keep_single_column_with_commas();
        LogShape shape;
        const std::size_t first = first_row();
        shape.first_row = lines_[first].number;
        name_columns(first, shape);
        shape.separator = table_.separator;
        shape.kinds = table_.kinds;
        shape.kinds.resize(shape.names.size(), CellKind::lost);
        read_increment(shape);
        for (std::size_t i = 0; i < first; ++i) read_statement(lines_[i], shape);
        if (!shape.rate) read_rates(first, shape);
        return shape;
    }

private:
    [[noreturn]] void fail(int line, const std::string& message) const {
        throw Error(SourceLocation{file_, line, line == 0 ? 0 : 1}, message);
    }

    /// The most frequent kind of row.
    Table table_with(char separator) const {
        std::map<std::size_t, std::size_t> counts;
        for (const Line& line : lines_)
            if (!is_comment(line.text, separator))
                if (const Fields fields = fields_of(line.text, separator);
                    (fields.size() > fields_of(line.text, no_separator).size()) == (separator != no_separator) &&
                    holds_numbers(fields))
                    ++counts[fields.size()];
        Table table{separator, 0, 0, {}};
        for (const auto& [width, rows] : counts)
            if (rows >= table.rows) table.width = width, table.rows = rows;
        return table;
    }

    void choose_separator() {
        std::vector<Table> tables;
        if (forced_) {
            tables.push_back(table_with(*forced_));
        } else {
            for (const char separator : separators) tables.push_back(table_with(separator));
        }
        std::size_t most = 0;
        for (const Table& table : tables) most = std::max(most, table.rows);
        const auto found =
            std::ranges::find_if(tables, [&](const Table& t) { return t.rows > 0 && 2 * t.rows >= most; });
        if (found != tables.end()) table_ = *found;
        if (const Table single = table_with(no_separator); single.rows > 2 * most && !forced_) table_ = single;
        if (table_.rows == 0 && lines_.size() > 1) table_ = table_of_words();
        find_kinds();
    }

    /// Rows of which less than half are numbers.
    Table table_of_words() const {
        Table best;
        for (const char separator : separators) {
            std::map<std::size_t, std::size_t> counts;
            for (const Line& line : lines_) {
                const Fields fields = fields_of(line.text, separator);
                if (fields.size() > 1 && !is_comment(line.text, separator) &&
                    std::ranges::any_of(fields, [](std::string_view f) { return kind_of(f) == CellKind::number; }))
                    ++counts[fields.size()];
            }
            for (const auto& [width, rows] : counts)
                if (rows > best.rows) best = {separator, width, rows, {}};
        }
        return best;
    }

    void find_kinds() {
        std::vector<std::array<std::size_t, 4>> counts(table_.width);
        std::vector<bool> used(table_.width, false);
        for (const Line& line : lines_) {
            if (is_comment(line.text, table_.separator)) continue;
            const Fields fields = fields_of(line.text, table_.separator);
            if (fields.size() != table_.width || std::ranges::none_of(fields, [](std::string_view f) {
                    return kind_of(f) == CellKind::number || kind_of(f) == CellKind::time;
                }))
                continue;
            for (std::size_t i = 0; i < fields.size(); ++i) {
                ++counts[i][static_cast<std::size_t>(kind_of(fields[i]))];
                if (!fields[i].empty()) used[i] = true;
            }
        }
        // A separator at the end of every row makes no column.
        while (table_.width > 1 && !used[table_.width - 1]) --table_.width;
        for (std::size_t i = 0; i < table_.width; ++i) {
            const auto [number, time, lost, word] = counts[i];
            const bool is_rare = 10 * (number + time + word) < number + time + lost + word;
            table_.kinds.push_back(is_rare                                          ? CellKind::lost
                                   : number > 0 && number >= word && number >= time ? CellKind::number
                                   : time > 0 && time >= word                       ? CellKind::time
                                   : word > 0                                       ? CellKind::word
                                                                                    : CellKind::lost);
        }
    }

    bool is_row(const Line& line) const {
        if (is_comment(line.text, table_.separator)) return false;
        const Fields fields = fields_of(line.text, table_.separator);
        if (fields.size() < table_.width) return false;
        bool any = false;
        for (std::size_t i = 0; i < table_.width; ++i) {
            const CellKind kind = kind_of(fields[i]), usual = table_.kinds[i];
            any = any || kind == CellKind::number;
            if ((usual == CellKind::number || usual == CellKind::time) && kind != usual && kind != CellKind::lost)
                return false;
        }
        return any || std::ranges::find(table_.kinds, CellKind::number) == table_.kinds.end();
    }

    std::size_t first_row() const {
        std::optional<std::size_t> alone;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            if (!is_row(lines_[i])) continue;
            if (!alone) alone = i;
            std::size_t next = 0, rows = 0;
            for (std::size_t k = i + 1; k < lines_.size() && next < 3; ++k)
                if (!is_comment(lines_[k].text, table_.separator)) ++next, rows += is_row(lines_[k]);
            if (2 * rows >= next) return i;
        }
        if (!alone) fail(lines_.front().number, "no row has numbers where most rows have them; a CSV log is needed");
        return *alone;
    }

    /// Rows such as 0,5 are one column with decimal commas if the header has one name with a unit, or if the
    /// numbers before the comma are not times.
    void keep_single_column_with_commas() {
        if (table_.separator != ',' || table_.width != 2 || forced_) return;
        const std::size_t first = first_row();
        if (first == 0 || lines_[first - 1].text.find(',') != std::string_view::npos) return;
        bool is_single = parse_column_name(as_utf8(lines_[first - 1].text)).unit.has_value();
        double last = -1e300;
        for (std::size_t i = first; i < lines_.size(); ++i) {
            const Fields fields = fields_of(lines_[i].text, ',');
            constexpr std::string_view digits = "0123456789";
            if (fields.size() != 2 || fields[0].empty() || fields[1].empty() ||
                fields[0].find_first_not_of(digits, fields[0].front() == '-' ? 1 : 0) != std::string_view::npos ||
                fields[1].find_first_not_of(digits) != std::string_view::npos)
                return;
            const double whole = std::strtod(std::string(fields[0]).c_str(), nullptr);
            is_single = is_single || whole < last || fields[0] == "-0";
            last = whole;
        }
        if (is_single) table_ = {no_separator, 1, table_.rows, {CellKind::number}};
    }

    /// Without empty fields at the end.
    static Fields without_end(Fields fields) {
        while (!fields.empty() && fields.back().empty()) fields.pop_back();
        return fields;
    }

    bool is_units_row(const Fields& fields) const {
        std::size_t units = 0;
        for (const std::string_view field : fields) {
            // An oscilloscope's row of units also holds the start and the step of its times.
            if (field.empty() || field == "-" || kind_of(field) == CellKind::number) continue;
            const bool bracket =
                (field.front() == '[' && field.back() == ']') || (field.front() == '(' && field.back() == ')');
            const bool unit = parse_column_unit(as_utf8(field)).has_value();
            // The last four label a row of units.
            constexpr std::array<std::string_view, 14> words{"counts", "count", "raw",     "lsb",      "%",
                                                             "1",      "degc",  "°c",      "c",        "sequence",
                                                             "unit",   "units", "einheit", "einheiten"};
            if (!bracket && !unit && std::ranges::find(words, lower(field)) == words.end()) return false;
            units += unit || bracket;
        }
        return units > 0;
    }

    /// Of blanks between words, "Time (s)" is one name.
    Fields names_in(std::string_view line) {
        Fields fields = fields_of(line, table_.separator);
        if (table_.separator != ' ' || fields.size() == table_.width) return fields;
        Fields joined;
        for (const std::string_view field : fields) {
            if (!joined.empty() && (field.front() == '(' || field.front() == '['))
                joined.back() = {joined.back().data(),
                                 static_cast<std::size_t>(field.data() + field.size() - joined.back().data())};
            else joined.push_back(field);
        }
        if (joined.size() == table_.width) return joined;
        for (const char other : {'\t', ',', ';'})
            if (Fields by_other = fields_of(line, other); by_other.size() == table_.width) return by_other;
        return {};
    }

    void name_columns(std::size_t first, LogShape& shape) {
        std::vector<std::size_t> above;  // lines of text
        std::optional<std::size_t> comment;
        for (std::size_t i = 0; i < first; ++i)
            if (!is_comment(lines_[i].text, table_.separator)) above.push_back(i);
            else comment = i;
        Fields names, units;
        if (!above.empty() && skip_rows_) {
            names = names_in(lines_[above.front()].text);
            shape.header_line = lines_[above.front()].number;
            if (above.size() > 1) {
                units = fields_of(lines_[above[1]].text, table_.separator);
                if (is_units_row(units)) shape.units_line = lines_[above[1]].number;
            }
        } else if (!above.empty()) {
            std::size_t at = above.size() - 1;
            names = names_in(lines_[above[at]].text);
            if (at > 0 && is_units_row(names))
                if (Fields higher = names_in(lines_[above[at - 1]].text);
                    without_end(higher).size() == without_end(names).size() || higher.size() == table_.width) {
                    shape.units_line = lines_[above[at]].number;
                    units = std::exchange(names, std::move(higher));
                    --at;
                }
            shape.header_line = lines_[above[at]].number;
        }
        if (shape.units_line == 0) units.clear();
        // A title above rows without names.
        if (names.size() < 2 && table_.width > 1 && !skip_rows_) names.clear();
        if (names.empty()) shape.header_line = shape.units_line = 0, units.clear();
        if (names.empty() && above.empty() && comment) names = names_in_comment(*comment, shape);
        while (names.size() > table_.width && names.back().empty()) names.pop_back();
        if (!names.empty() && names.size() < table_.width)
            fail(shape.header_line,
                 fmt::format("there are {} and the rows have {} fields{}; name every column, or "
                             "state with --skip-rows how many lines stand before the names",
                             names.size() == 1 ? std::string("1 name") : fmt::format("{} names", names.size()),
                             table_.width,
                             table_.separator == ',' && table_.width == 2 * names.size()
                                 ? " (are these decimal commas? Then separate the fields by semicolons or tabs)"
                                 : ""));
        for (const std::string_view name : names) shape.names.push_back(as_utf8(name));
        while (shape.names.size() < table_.width) shape.names.push_back(std::to_string(shape.names.size() + 1));
        if (!units.empty()) {
            for (const std::string_view unit : units) shape.units.push_back(as_utf8(unit));
            shape.units.resize(shape.names.size());
        }
        shape.skipped = static_cast<int>(above.size()) - (shape.header_line > 0 && !above.empty() ? 1 : 0) -
                        (shape.units_line > 0 ? 1 : 0);
    }

    /// An oscilloscope's row of units holds the start and the step of its times: "X,CH1,Start,Increment" above
    /// "Sequence,Volt,-6.0e-02,1.0e-05".
    static void read_increment(LogShape& shape) {
        for (std::size_t i = 0; i < shape.units.size() && i < shape.names.size(); ++i) {
            if (lower(shape.names[i]) != "increment") continue;
            const double step = header_number(shape.units[i]).value_or(0.0);
            if (!(step > 0.0) || !std::isfinite(step)) return;
            shape.rate = {1.0 / step, shape.units_line, {}};
            for (std::size_t n = 0; n < shape.units.size() && n < shape.kinds.size(); ++n)
                if (lower(shape.units[n]) == "sequence" || lower(shape.names[n]) == "start" || n == i)
                    shape.kinds[n] = CellKind::lost;
        }
    }

    /// The rate that the lines above the rows state: of several that differ none.
    void read_rates(std::size_t first, LogShape& shape) const {
        for (std::size_t i = 0; i < first; ++i) {
            const std::optional<StatedRate> found = stated_rate(lines_[i].text, table_.separator);
            if (!found) continue;
            const int number = lines_[i].number;
            if (!found->doubt.empty()) {
                if (!shape.rate_doubt) shape.rate_doubt = {found->doubt, number};
            } else if (!shape.rate) {
                shape.rate = {found->rate, number, found->point};
            } else if (std::abs(found->rate / shape.rate->value - 1.0) > 0.01) {
                shape.rate_doubt = {fmt::format("it states {:.6g} Hz, and line {} states {:.6g} Hz", found->rate,
                                                shape.rate->line, shape.rate->value),
                                    number};
                shape.rate.reset();
                return;
            }
        }
        if (shape.rate) shape.rate_doubt.reset();
    }

    /// "# sensitivity: 100 mV/g", and the units of the channels of a LabVIEW file.
    static void read_statement(const Line& read, LogShape& shape) {
        const std::string_view line = read.text;
        const std::string text = lower(line);
        for (StatedSensitivity& one : sensitivities_in(line, read.number, shape.separator))
            shape.sensitivities.push_back(std::move(one));
        if (!text.starts_with("y_unit_label") || !shape.units.empty()) return;
        const Fields labels = fields_of(line, shape.separator);
        shape.units.resize(shape.names.size());
        for (std::size_t i = 1; i < labels.size() && i < shape.units.size(); ++i) shape.units[i] = as_utf8(labels[i]);
    }

    /// "# t, ax, ay" and ";Headers, time,Ax" just above the rows.
    Fields names_in_comment(std::size_t at, LogShape& shape) {
        std::string_view text = lines_[at].text;
        text.remove_prefix(std::min(text.find_first_not_of(" \t#%;/"), text.size()));
        Fields names = names_in(text);
        if (!names.empty() && lower(names.front()) == "headers") names.erase(names.begin());
        if (names.size() != table_.width || table_.width < 2 ||
            std::ranges::any_of(names, [](std::string_view name) { return kind_of(name) != CellKind::word; }))
            return {};
        shape.header_line = lines_[at].number;
        return names;
    }

    std::string file_;
    std::optional<int> skip_rows_;
    std::vector<Line> lines_;
    std::optional<char> forced_;
    Table table_;
};

}  // namespace

CellKind kind_of(std::string_view field) {
    if (field.empty()) return CellKind::lost;
    if (parse_clock_time(field) || is_date(field)) return CellKind::time;
    if (field.find_first_not_of("+-0123456789.,eE") == std::string_view::npos &&
        field.find_first_of("0123456789") != std::string_view::npos && field.front() != 'e' && field.front() != 'E')
        return CellKind::number;
    const std::string word = lower(field);
    for (const std::string_view lost :
         {"nan",       "na",      "n/a",      "#n/a",     "null",      "none",   "inf",     "-inf",
          "+inf",      "-",       "--",       "infinity", "-infinity", "-nan",   "+nan",    "nan(ind)",
          "-nan(ind)", "1.#qnan", "-1.#qnan", "1.#ind",   "-1.#ind",   "1.#inf", "-1.#inf", "#value!",
          "#div/0!",   "#num!",   "#ref!",    "#nv",      "#wert!"})
        if (word == lost) return CellKind::lost;
    return split_measure(field) ? CellKind::number : CellKind::word;
}

std::optional<Measure> split_measure(std::string_view field) {
    const std::size_t end = field.find_first_not_of("+-0123456789.,");
    if (end == 0 || end == std::string_view::npos || field.substr(0, end).find_first_of("0123456789") > end)
        return std::nullopt;
    std::size_t begin = end;
    // "1.5e-3 V": the exponent belongs to the number.
    if (field[end] == 'e' || field[end] == 'E') {
        std::size_t digit = end + 1;
        if (digit < field.size() && (field[digit] == '+' || field[digit] == '-')) ++digit;
        const std::size_t behind = std::min(field.find_first_not_of("0123456789", digit), field.size());
        if (behind > digit) begin = behind;
    }
    const Measure parts{field.substr(0, begin), trimmed(field.substr(begin))};
    if (parts.unit.empty() || !parse_column_unit(as_utf8(parts.unit))) return std::nullopt;
    return parts;
}

LogShape find_log_shape(std::string_view text, const std::string& file, std::optional<int> skip_rows) {
    return Finder(text, file, skip_rows).find();
}

}  // namespace tactus::table
