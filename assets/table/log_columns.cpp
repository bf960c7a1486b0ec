// SPDX-License-Identifier: Apache-2.0
#include "assets/table/log_columns.hpp"

#include "assets/table/clock_time.hpp"
#include "assets/table/csv_field.hpp"
#include "assets/table/log_lines.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

namespace tactus::table {

namespace {

/// "t, \"acc, x (g)\"": a name with a comma is quoted, so that the list can be read.
std::string list_of(const std::vector<std::string>& names) {
    std::vector<std::string> quoted;
    for (const std::string& name : names) quoted.push_back(csv_field(name));
    return fmt::format("{}", fmt::join(quoted, ", "));
}

class Chooser {
public:
    Chooser(const LogShape& shape, const std::vector<std::string_view>& first_row, const std::string& file,
            const LogSelection& selection)
        : shape_(shape), first_row_(first_row), file_(file), selection_(selection) {}

    LogColumns choose() {
        for (std::size_t i = 0; i < shape_.names.size(); ++i) {
            NamedColumn named = parse_column_name(shape_.names[i]);
            if (i < shape_.units.size())
                if (auto unit = parse_column_unit(shape_.units[i])) named = {shape_.names[i], std::move(unit)};
            out_.named.push_back(std::move(named));
        }
        choose_time();
        choose_values();
        choose_clock();
        choose_sources();
        return std::move(out_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        if (!shape_.has_lines) throw Error(SourceLocation{file_, 0, 0}, message);
        const int line = shape_.header_line > 0 ? shape_.header_line : shape_.first_row;
        throw Error(SourceLocation{file_, line, 1}, message);
    }

    bool is_name(std::string_view text) const {
        return std::ranges::find(shape_.names, text) != shape_.names.end() ||
               std::ranges::find(out_.named, text, &NamedColumn::name) != out_.named.end();
    }

    /// The names for this file in the text of an option.
    std::vector<std::string> wanted_in(const std::string& text) const {
        std::vector<std::string> names = names_in(text, [this](std::string_view name) { return is_name(name); });
        if (!selection_.list_entry) return names;
        if (names.size() > 2) fail(fmt::format("'{}': at most two columns, as REFERENCE,OUTPUT", text));
        return {names[std::min(*selection_.list_entry, names.size() - 1)]};
    }

    std::size_t find(const std::string& wanted, const char* what) const {
        const std::vector<std::string>& names = shape_.names;
        const auto found = std::find(names.begin(), names.end(), wanted);
        if (std::count(names.begin(), names.end(), wanted) > 1)
            fail(fmt::format("there are several columns '{}'; choose by number, from 1: {}", wanted, list_of(names)));
        if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
        const auto bare = std::ranges::find(out_.named, wanted, &NamedColumn::name);
        if (bare != out_.named.end()) return static_cast<std::size_t>(bare - out_.named.begin());
        std::size_t number = 0;
        const auto [end, failure] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
        if (failure == std::errc{} && end == wanted.data() + wanted.size() && number >= 1 && number <= names.size())
            return number - 1;
        std::vector<std::string> known = names;
        for (const NamedColumn& column : out_.named) known.push_back(column.name);
        fail(fmt::format(
            "there is no {} '{}'{}; there are {}{}", what, wanted, did_you_mean(wanted, known), list_of(names),
            selection_.list_entry ? "; names that differ between the files are stated as REFERENCE,OUTPUT" : ""));
    }

    bool can_be_time(std::size_t i) const {
        if (shape_.kinds[i] == CellKind::time) return i >= first_row_.size() || !is_date(first_row_[i]);
        return shape_.kinds[i] == CellKind::number;
    }

    std::optional<std::size_t> found_time() const {
        for (std::size_t i = 0; i < shape_.names.size(); ++i)
            if (can_be_time(i) && (shape_.header_line > 0 ? is_time_name(out_.named[i].name) : shape_.names.size() > 1))
                return i;
        for (std::size_t i = 0; i < shape_.names.size(); ++i)
            if (can_be_time(i) && shape_.kinds[i] == CellKind::time) return i;
        for (std::size_t i = 0; i < shape_.names.size(); ++i)
            if (can_be_time(i) && out_.named[i].unit && out_.named[i].unit->is_time()) return i;
        return std::nullopt;
    }

    void choose_time() {
        if (selection_.rate) {
            if (!selection_.time_column.empty()) fail("a rate and a time column are stated; state one of them");
            out_.rate = *selection_.rate;
            return;
        }
        if (!selection_.time_column.empty()) out_.time = find(time_column(), "time column");
        else out_.time = found_time();
        if (!out_.time && shape_.rate) {
            out_.rate = shape_.rate->value;
            return;
        }
        if (!out_.time && shape_.rate_doubt)
            throw Error(SourceLocation{file_, shape_.rate_doubt->line, 1},
                        fmt::format("the sample rate in this line is not clear: {}; state it with --sample-rate, as "
                                    "--sample-rate \"3.2 kHz\"",
                                    shape_.rate_doubt->why));
        if (!out_.time && shape_.names.size() == 1)
            fail(
                "there is only one column, and it holds no time; state the rate of the rows, as --sample-rate \"3.2 "
                "kHz\"");
        if (!out_.time)
            fail(
                fmt::format("no column name contains a time; name the column with --time-column, or state the rate of "
                            "the rows, as --sample-rate \"3.2 kHz\"; there are {}",
                            list_of(shape_.names)));
        choose_time_unit();
    }

    std::string time_column() const {
        const std::vector<std::string> names = wanted_in(selection_.time_column);
        if (names.size() > 1) fail(fmt::format("--time-column names {} columns; one is needed", names.size()));
        return names.front();
    }

    void choose_time_unit() {
        if (!selection_.time_unit.empty()) {
            const auto found = std::ranges::find(time_units(), selection_.time_unit, &TimeUnit::symbol);
            if (found == time_units().end())
                throw Error(
                    fmt::format("{}: the unit of time must be s, ms, us or ns, not '{}'", file_, selection_.time_unit));
            out_.unit = *found;
            return;
        }
        const NamedColumn& column = out_.named[*out_.time];
        std::optional<ColumnUnit> unit = column.unit;
        if (!unit) unit = parse_column_unit(column.name);
        if (!unit || !unit->is_time()) {
            if (shape_.header_line > 0) out_.unit = time_unit_in_name(shape_.names[*out_.time]);
            return;
        }
        out_.unit = TimeUnit{unit->text, unit->si};
        for (const TimeUnit& known : time_units())
            if (std::abs(unit->si / known.seconds - 1.0) < 1e-9) out_.unit = known;
    }

    /// The axes of the sensor that most probably measured the vibration.
    std::vector<std::size_t> axes() const {
        std::vector<std::pair<std::string, std::vector<std::size_t>>> families;
        for (std::size_t i = 0; i < shape_.names.size(); ++i) {
            if (i == out_.time || shape_.kinds[i] != CellKind::number) continue;
            const std::optional<std::string> family = axis_family(out_.named[i].name);
            if (!family) continue;
            const auto known = std::ranges::find(families, *family, &decltype(families)::value_type::first);
            if (known == families.end()) families.push_back({*family, {i}});
            else known->second.push_back(i);
        }
        if (families.empty()) return {};
        const auto is_accelerometer = [&](const auto& family) {
            const auto& unit = out_.named[family.second.front()].unit;
            return unit ? unit->is_acceleration()
                        : family.first == "a" || family.first == "gf" || family.first.starts_with("acc") ||
                              family.first.starts_with("lin");
        };
        const auto chosen = std::ranges::find_if(families, is_accelerometer);
        if (chosen != families.end()) return chosen->second;
        return families.front().second;
    }

    /// A column of times is no vibration.
    bool is_clock(std::size_t i) const {
        return shape_.header_line > 0 && shape_.names.size() > 1 && can_be_time(i) &&
               (is_time_name(out_.named[i].name) || (out_.named[i].unit && out_.named[i].unit->is_time()));
    }

    /// In "t1, a1, t2, a2" every channel follows the clock to its left.
    void choose_clock() {
        if (!out_.time || !selection_.time_column.empty()) return;
        for (const std::size_t value : out_.values) {
            std::size_t clock = *out_.time;
            for (std::size_t i = 0; i < value; ++i)
                if (is_clock(i) && i + 1 < shape_.names.size() && !is_clock(i + 1) &&
                    shape_.kinds[i] == CellKind::number)
                    clock = i;
            // Several clocks side by side, before all values: the first counts.
            bool is_between = clock == *out_.time;
            for (std::size_t i = *out_.time + 1; i < clock; ++i) is_between = is_between || !is_clock(i);
            if (!is_between) clock = *out_.time;
            if (std::ranges::find(out_.clocks, clock) == out_.clocks.end()) out_.clocks.push_back(clock);
        }
        if (out_.clocks.size() == 1 && out_.clocks.front() != *out_.time) {
            out_.time = out_.clocks.front();
            choose_time_unit();
        }
        if (out_.clocks.size() < 2) out_.clocks.clear();
    }

public:
    static bool names_source(std::string_view name) {
        const std::string word = lower(name);
        constexpr std::array<std::string_view, 18> sensors{
            "sensor", "device",     "node",     "instance", "imu", "source", "address", "addr", "mac",
            "probe",  "sensortype", "sensorid", "deviceid", "i",   "id",     "channel", "type", "kanal"};
        if (std::ranges::find(sensors, word) != sensors.end()) return true;
        bool is_sensor = false, is_number = false;
        for (std::size_t at = 0; at < word.size();) {
            const std::size_t end = std::min(word.find_first_of(" _-.:/", at), word.size());
            const std::string_view part = std::string_view(word).substr(at, end - at);
            is_sensor = is_sensor || std::ranges::find(sensors, part) != sensors.end();
            is_number = is_number || part == "id" || part == "name" || part == "nr" || part == "no" ||
                        part == "number" || part == "index" || part == "type";
            at = end + 1;
        }
        return is_sensor && is_number;
    }

private:
    /// The '=' behind the name of a column, which may contain others; the first one if there is no such name.
    std::size_t sign_of_where() const {
        const std::string& where = selection_.where;
        for (std::size_t at = where.find('='); at != std::string::npos; at = where.find('=', at + 1))
            if (const std::vector<std::string> names =
                    names_in(where.substr(0, at), [this](std::string_view name) { return is_name(name); });
                names.size() == 1 && is_name(names.front()))
                return at;
        return where.find('=');
    }

    void choose_sources() {
        if (!selection_.where.empty()) {
            const std::size_t sign = sign_of_where();
            if (sign == std::string::npos)
                throw Error(fmt::format("{}: --where needs COLUMN=VALUE, not '{}'", file_, selection_.where));
            const std::string column = selection_.where.substr(0, sign);
            const std::vector<std::string> names =
                names_in(column, [this](std::string_view name) { return is_name(name); });
            out_.where = find(names.size() == 1 ? names.front() : column, "column");
            out_.wanted = selection_.where.substr(sign + 1);
        }
        if (shape_.header_line == 0) return;
        for (std::size_t i = 0; i < shape_.names.size(); ++i) {
            if (i == out_.time || i == out_.where || std::ranges::find(out_.values, i) != out_.values.end()) continue;
            if (shape_.kinds[i] == CellKind::word ||
                (shape_.kinds[i] == CellKind::number && names_source(shape_.names[i])))
                out_.sources.push_back(i);
        }
    }

    /// Row counters are not measurements.
    bool counts_rows(std::size_t i) const {
        constexpr std::array<std::string_view, 18> names{"sample",       "samples",    "sample number",
                                                         "sample no",    "sample no.", "sample index",
                                                         "index",        "row",        "frame",
                                                         "frame number", "packet",     "counter",
                                                         "seq",          "sequence",   "no",
                                                         "no.",          "nr",         "#"};
        return shape_.header_line > 0 && !out_.named[i].unit &&
               std::ranges::find(names, lower(out_.named[i].name)) != names.end();
    }

    /// "channel" of "Channel 3"; empty for names without a number at their end, and for numbers alone.
    static std::string numbered_family(std::string_view name) {
        const std::size_t end = name.find_last_not_of("0123456789");
        if (end == std::string_view::npos || end + 1 == name.size()) return "";
        return lower(trimmed(name.substr(0, end + 1)));
    }

    void choose_values() {
        for (const std::string& text : selection_.columns)
            for (const std::string& wanted : wanted_in(text)) out_.values.push_back(find(wanted, "column"));
        if (!out_.values.empty()) return;
        std::vector<std::size_t> numbers, accelerations, counters;
        for (std::size_t i = 0; i < shape_.names.size(); ++i) {
            if (i == out_.time || shape_.kinds[i] != CellKind::number) continue;
            if (is_clock(i)) continue;
            if (counts_rows(i)) {
                counters.push_back(i);
                continue;
            }
            numbers.push_back(i);
            const auto& unit = out_.named[i].unit;
            if (unit ? unit->is_acceleration() : lower(out_.named[i].name).starts_with("acc"))
                accelerations.push_back(i);
        }
        if (numbers.empty()) numbers = counters;
        out_.values = numbers.size() == 1 ? numbers : axes();
        if (out_.values.empty()) out_.values = accelerations;
        if (out_.values.empty() && !numbers.empty() && std::ranges::all_of(numbers, [&](std::size_t i) {
                return out_.named[i].unit &&
                       out_.named[i].unit->dimension == out_.named[numbers.front()].unit->dimension;
            }))
            out_.values = numbers;
        if (out_.values.empty() && !numbers.empty() && std::ranges::all_of(numbers, [&](std::size_t i) {
                const std::string family = numbered_family(out_.named[i].name);
                return !family.empty() && family == numbered_family(out_.named[numbers.front()].name);
            }))
            out_.values = numbers;
        if (out_.values.empty()) {
            std::vector<std::string> all;
            for (const std::size_t i : numbers) all.push_back(std::to_string(i + 1));
            fail(fmt::format("choose columns with --column{}; there are {}",
                             all.empty() ? "" : fmt::format(", as --column {}", fmt::join(all, ",")),
                             list_of(shape_.names)));
        }
    }

    const LogShape& shape_;
    const std::vector<std::string_view>& first_row_;
    const std::string& file_;
    const LogSelection& selection_;
    LogColumns out_;
};

}  // namespace

std::vector<std::string> names_in(std::string_view text, const std::function<bool(std::string_view)>& is_name) {
    if (is_name(text)) return {std::string(text)};
    std::vector<std::string> names;
    for (std::size_t at = 0;; ++at) {
        std::string name;
        at = std::min(text.find_first_not_of(' ', at), text.size());
        if (at < text.size() && text[at] == '"') {
            for (++at; at < text.size(); ++at) {
                if (text[at] == '"' && text.substr(at + 1, 1) == "\"") ++at;
                else if (text[at] == '"') break;
                name += text[at];
            }
            at = std::min(text.find(',', at), text.size());
        } else {
            const std::size_t end = std::min(text.find(',', at), text.size());
            name = trimmed(text.substr(at, end - at));
            at = end;
        }
        names.push_back(std::move(name));
        if (at == text.size()) return names;
    }
}

bool is_source_name(std::string_view name) { return Chooser::names_source(name); }

LogColumns choose_log_columns(const LogShape& shape, const std::vector<std::string_view>& first_row,
                              const std::string& file, const LogSelection& selection) {
    return Chooser(shape, first_row, file, selection).choose();
}

}  // namespace tactus::table
