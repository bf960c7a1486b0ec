// SPDX-License-Identifier: Apache-2.0
#include "assets/table/sample_log.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

namespace tactus::table {

namespace {

std::string_view trimmed(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

enum class Cell { number, lost, garbage };

class Reader {
public:
    Reader(std::string_view text, const std::string& file, const LogSelection& selection)
        : rest_(text), file_(file), selection_(selection) {}

    SampleLog read() {
        if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
        std::string_view line;
        if (!next(line)) fail(0, "the file is empty; a CSV log with a time column is needed");
        if (rest_.data() != nullptr && line.find('\0') != std::string_view::npos) fail(1, "this is not a text file");
        choose_separator(line);
        split(line);
        std::vector<std::string> names;
        double number = 0.0;
        const bool has_header = std::any_of(fields_.begin(), fields_.end(), [&](std::string_view field) {
            return parse(field, number) == Cell::garbage;
        });
        for (std::size_t i = 0; i < fields_.size(); ++i)
            names.push_back(has_header ? std::string(fields_[i]) : std::to_string(i + 1));
        if (names.size() < 2)
            fail(1, "there is only one column; a time column and a value column are needed, separated by , ; or tab");
        choose_columns(names);
        if (!has_header) row(line, rest_.empty());
        while (next(line)) row(line, rest_.empty());
        refuse_ambiguous();
        if (log_.times.empty()) fail(0, "there is no row with a number in every chosen column");
        return std::move(log_);
    }

private:
    [[noreturn]] void fail(int column, const std::string& message) const {
        throw Error(SourceLocation{file_, column == 0 ? 0 : line_, column}, message);
    }

    bool next(std::string_view& line) {
        while (!rest_.empty()) {
            const std::size_t end = std::min(rest_.find('\n'), rest_.size());
            line = trimmed_end(rest_.substr(0, end));
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
            ++line_;
            if (line.size() > 65536) fail(1, "the line is longer than 64 KiB; this is not a CSV log");
            if (!line.empty() && line.front() != '#') return true;
        }
        return false;
    }

    static std::string_view trimmed_end(std::string_view line) {
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
        return line;
    }

    void choose_separator(std::string_view line) {
        std::ptrdiff_t most = 0;
        // With decimal commas a line may have more commas than semicolons, so semicolons take precedence.
        for (const char candidate : {';', '\t', ','}) {
            const std::ptrdiff_t count = std::count(line.begin(), line.end(), candidate);
            if (count > 0 && most == 0) separator_ = candidate, most = count;
        }
    }

    void split(std::string_view line) {
        fields_.clear();
        for (;;) {
            std::size_t end = std::min(line.find(separator_), line.size());
            // A quoted field may hold the separator, as "1,234".
            if (!line.empty() && line.front() == '"')
                if (const std::size_t quote = line.find('"', 1); quote != std::string_view::npos && quote > end)
                    end = std::min(line.find(separator_, quote), line.size());
            fields_.push_back(trimmed(line.substr(0, end)));
            if (end == line.size()) return;
            line.remove_prefix(end + 1);
        }
    }

    /// Whether a number like 1,234 is 1234 or 1.234 is known only from the others.
    void note_style(std::string_view field) {
        if (field.find_first_not_of("+-0123456789.,eE") != std::string_view::npos) return;
        const std::size_t comma = field.find(','), point = field.find('.');
        if (comma == std::string_view::npos && point == std::string_view::npos) return;
        const std::size_t first = std::min(comma, point), sign = field.front() == '+' || field.front() == '-' ? 1 : 0;
        bool grouped = first > sign && first <= sign + 3 && field[sign] != '0';
        for (std::size_t at = first; grouped && at < field.size(); at += 4)
            grouped = (field[at] == ',' || field[at] == '.') && field.size() >= at + 4 &&
                      field.substr(at + 1, 3).find_first_not_of("0123456789") == std::string_view::npos &&
                      (field.size() == at + 4 || field[at + 4] == ',' || field[at + 4] == '.');
        const bool twice = field.find_first_of(",.", first + 1) != std::string_view::npos;
        if (twice) throw_ambiguous(field, "has thousands separators");
        if (comma != std::string_view::npos && separator_ == ',')
            throw_ambiguous(field, "has a comma, which also separates the fields");
        if (grouped && comma != std::string_view::npos && grouped_.empty()) grouped_ = field, grouped_line_ = line_;
        else if (comma != std::string_view::npos && !grouped) commas_ = true;
        else if (point != std::string_view::npos && separator_ != ',') (grouped ? maybe_points_ : points_) = true;
    }

    [[noreturn]] void throw_ambiguous(std::string_view field, const char* why) const {
        fail(1, fmt::format("'{}' {}; write numbers without them", field.substr(0, 40), why));
    }

    /// At the end of the file. 1.234 alone is a decimal point, 1,234 alone could be either.
    void refuse_ambiguous() {
        if (commas_ && (points_ || maybe_points_))
            fail(0, "some numbers have a decimal comma and some a point; write all alike");
        if (!grouped_.empty() && !commas_) {
            line_ = grouped_line_;
            fail(1, fmt::format("'{}' may be {} or {}: no other number of the file shows whether the comma is decimal; "
                                "write numbers with a point",
                                grouped_, without_commas(grouped_), with_point(grouped_)));
        }
    }

    static std::string without_commas(std::string text) {
        std::erase(text, ',');
        return text;
    }
    static std::string with_point(std::string text) {
        std::replace(text.begin(), text.end(), ',', '.');
        return text;
    }

    Cell parse(std::string_view field, double& number) {
        if (field.empty()) return Cell::lost;
        note_style(field);
        std::array<char, 64> buffer;
        if (separator_ != ',' && field.size() < buffer.size() && field.find(',') != std::string_view::npos) {
            std::replace_copy(field.begin(), field.end(), buffer.begin(), ',', '.');
            field = {buffer.data(), field.size()};
        }
        if (field.front() == '+') field.remove_prefix(1);
        const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), number);
        if (failure != std::errc{} || end != field.data() + field.size()) {
            const std::string word = lower(field);
            return word == "na" || word == "null" || word == "none" ? Cell::lost : Cell::garbage;
        }
        return std::isfinite(number) ? Cell::number : Cell::lost;
    }

    std::size_t find(const std::vector<std::string>& names, const std::string& wanted, const char* what) const {
        const auto found = std::find(names.begin(), names.end(), wanted);
        if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
        std::size_t number = 0;
        const auto [end, failure] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
        if (failure == std::errc{} && end == wanted.data() + wanted.size() && number >= 1 && number <= names.size())
            return number - 1;
        fail(1, fmt::format("there is no {} '{}'{}; there are {}", what, wanted, did_you_mean(wanted, names),
                            fmt::join(names, ", ")));
    }

    void choose_columns(const std::vector<std::string>& names) {
        if (!selection_.time_column.empty()) {
            time_ = find(names, selection_.time_column, "time column");
        } else {
            const auto speaks_of_time = [](const std::string& name) {
                const std::string word = lower(name);
                return word == "t" || word.starts_with("t_") || word.starts_with("time") || word == "seconds" ||
                       word == "1";
            };
            const auto found = std::find_if(names.begin(), names.end(), speaks_of_time);
            if (found == names.end())
                fail(1, fmt::format("no column name contains a time; name the column with --time-column; there are {}",
                                    fmt::join(names, ", ")));
            time_ = static_cast<std::size_t>(found - names.begin());
        }
        log_.time_name = names[time_];
        choose_time_unit(lower(names[time_]));
        for (const std::string& wanted : selection_.columns) columns_.push_back(find(names, wanted, "column"));
        if (columns_.empty() && names.size() == 2) columns_.push_back(1 - time_);
        if (columns_.empty())
            for (std::size_t i = 0; i < names.size(); ++i) {
                const std::string word = lower(names[i]);
                const bool axis = word.ends_with("_x") || word.ends_with("_y") || word.ends_with("_z") || word == "x" ||
                                  word == "y" || word == "z";
                if (i != time_ && axis) columns_.push_back(i);
            }
        if (columns_.empty())
            fail(1, fmt::format("choose columns with --column; there are {}", fmt::join(names, ", ")));
        for (const std::size_t column : columns_) log_.names.push_back(names[column]);
        log_.columns.resize(columns_.size());
    }

    void choose_time_unit(const std::string& name) {
        constexpr std::array<std::pair<std::string_view, double>, 4> units{
            {{"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"s", 1.0}}};
        for (const auto& [unit, seconds] : units) {
            if (selection_.time_unit.empty() ? name.ends_with(fmt::format("_{}", unit)) ||
                                                   name.find(fmt::format("({})", unit)) != std::string::npos ||
                                                   name.find(fmt::format("[{}]", unit)) != std::string::npos
                                             : selection_.time_unit == unit) {
                seconds_ = seconds;
                return;
            }
        }
        if (!selection_.time_unit.empty())
            fail(0, fmt::format("the unit of time must be s, ms, us or ns, not '{}'", selection_.time_unit));
    }

    void row(std::string_view line, bool is_last) {
        split(line);
        const std::size_t most = std::max(time_, *std::max_element(columns_.begin(), columns_.end()));
        if (fields_.size() <= most) {
            // A logger that lost power may leave an incomplete last line.
            if (is_last) {
                ++log_.lost_rows;
                return;
            }
            fail(1, fmt::format("the row has {} fields; column {} is needed", fields_.size(), most + 1));
        }
        double time = 0.0;
        values_.assign(columns_.size(), 0.0);
        bool lost = take(time_, time);
        for (std::size_t i = 0; i < columns_.size(); ++i) lost = take(columns_[i], values_[i]) || lost;
        if (lost) {
            ++log_.lost_rows;
            return;
        }
        time *= seconds_;
        if (!log_.times.empty() && time < log_.times.back())
            fail(static_cast<int>(fields_[time_].data() - line.data()) + 1,
                 fmt::format("time runs backwards, from {:.9g} s to {:.9g} s; cut the file there", log_.times.back(),
                             time));
        log_.times.push_back(time);
        for (std::size_t i = 0; i < values_.size(); ++i) log_.columns[i].push_back(values_[i]);
    }

    /// True when the field has no value.
    bool take(std::size_t column, double& number) {
        const Cell cell = parse(fields_[column], number);
        if (cell == Cell::garbage)
            fail(static_cast<int>(column) + 1,
                 fmt::format("'{}' in field {} is not a number", fields_[column].substr(0, 40), column + 1));
        return cell == Cell::lost;
    }

    std::string_view rest_;
    std::string file_;
    const LogSelection& selection_;
    SampleLog log_;
    int line_ = 0;
    char separator_ = ',';
    double seconds_ = 1.0;
    std::size_t time_ = 0;
    std::vector<std::size_t> columns_;
    std::vector<std::string_view> fields_;
    std::vector<double> values_;
    // How decimals are written, as far as numbers show it.
    bool commas_ = false, points_ = false, maybe_points_ = false;
    std::string grouped_;
    int grouped_line_ = 0;
};

}  // namespace

SampleLog read_sample_log(std::string_view text, const std::string& file, const LogSelection& selection) {
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
