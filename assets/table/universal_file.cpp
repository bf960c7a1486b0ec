// SPDX-License-Identifier: Apache-2.0
// Universal files (SDRC, 1967; kept by the University of Cincinnati): blocks of lines between lines with -1, each with the
// number of its dataset. Dataset 58 is a function at nodal degrees of freedom, 58b the same with binary values.
#include "assets/file/room.hpp"
#include "assets/table/recording.hpp"
#include "assets/table/time_unit.hpp"
#include "dsp/core/blanks.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

namespace tactus::table {

namespace {

bool is_delimiter(std::string_view line) { return line.starts_with("    -1") && without_blanks(line) == "-1"; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A sign in "1.23457-101": Fortran leaves the letter of an exponent of three digits out. `at`: place of the sign in `text`,
/// which begins with the number.
bool is_bare_exponent(std::string_view text, std::size_t at) {
    const std::string_view before = text.substr(0, at), digits = text.substr(at + 1, 3);
    return before.find('.') != std::string_view::npos && before.find_first_of("EeDd") == std::string_view::npos &&
           digits.size() == 3 && std::ranges::all_of(digits, is_digit) &&
           (at + 4 >= text.size() || (!is_digit(text[at + 4]) && text[at + 4] != '.'));
}

/// The next number in the text of a dataset. Numbers in columns of fixed width may touch: a sign that follows no exponent
/// begins the next.
std::string_view take_number(std::string_view& rest) {
    const std::size_t first = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
    rest.remove_prefix(first);
    std::size_t end = 0;
    const auto is_exponent = [](char c) { return c == 'E' || c == 'e' || c == 'D' || c == 'd'; };
    while (end < rest.size() && blanks.find(rest[end]) == std::string_view::npos && rest[end] != '\n' &&
           (end == 0 || (rest[end] != '-' && rest[end] != '+') || is_exponent(rest[end - 1]) ||
            is_bare_exponent(rest, end)))
        ++end;
    const std::string_view word = rest.substr(0, end);
    rest.remove_prefix(end);
    return word;
}

/// None for text that is no number. Numbers beyond the range of a double are 0 or infinite.
std::optional<double> number_of(std::string_view word) {
    if (word.empty() || word.size() > 40) return std::nullopt;
    if (word.front() == '+') word.remove_prefix(1);
    std::string text;
    for (const char c : word) {
        if ((c == '-' || c == '+') && !text.empty() && is_digit(text.back())) text += 'E';
        text += c == 'D' || c == 'd' || c == 'e' ? 'E' : c;
    }
    double number = 0.0;
    const char* const last = text.data() + text.size();
    const auto [end, failure] = std::from_chars(text.data(), last, number);
    if (failure == std::errc::invalid_argument || end != last) return std::nullopt;
    if (failure == std::errc::result_out_of_range)
        return text.find("E-") == std::string::npos ? std::numeric_limits<double>::infinity() : 0.0;
    return number;
}

class UniversalFile {
public:
    UniversalFile(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    Recording read() {
        std::string_view line;
        while (next(line)) {
            leave_if_stopped();
            // Editors and DOS leave lines behind the last dataset.
            if (const std::string_view words = without_blanks(line); words.empty() || words == "\x1a") continue;
            if (!is_delimiter(line))
                fail(fmt::format("a delimiter, '    -1', was expected, not '{}'", line.substr(0, 40)));
            if (!next(line)) break;
            read_dataset(line);
        }
        if (recording_.channels.empty())
            throw Error(
                fmt::format("{}: of its {} datasets none is a function of time (58){}", file_, datasets_, left_out()));
        recording_.format = fmt::format("universal file, {} of {} datasets{}", functions_, datasets_, left_out());
        recording_.rate_place = "the abscissa";
        return std::move(recording_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const { throw Error(SourceLocation{file_, line_, 1}, message); }

    std::string left_out() const {
        std::string text;
        if (others_ > 0) text += fmt::format("; {} of other kinds left out", others_);
        if (not_in_time_ > 0)
            text += fmt::format("; {} functions of another abscissa than time left out", not_in_time_);
        if (complex_ > 0) text += fmt::format("; {} complex functions left out", complex_);
        return text;
    }

    bool next(std::string_view& line) {
        if (at_ >= bytes_.size()) return false;
        const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
        line = bytes_.substr(at_, end - at_);
        if (line.ends_with('\r')) line.remove_suffix(1);
        at_ = std::min(end + 1, bytes_.size());
        ++line_;
        return true;
    }

    std::string_view needed() {
        std::string_view line;
        if (!next(line) || is_delimiter(line)) fail("cut short: the header of a function has 11 lines");
        return line;
    }

    /// The text up to the delimiter, which is passed.
    std::string_view rest_of_dataset() {
        const std::size_t begin = at_;
        std::size_t end = at_;
        for (std::string_view line; next(line); end = at_)
            if (is_delimiter(line)) return bytes_.substr(begin, end - begin);
        // The last delimiter may lack after a crash: the count of the values decides.
        return bytes_.substr(begin);
    }

    void read_dataset(std::string_view line) {
        ++datasets_;
        std::string_view words = line;
        const std::string_view number = take_number(words);
        if (number != "58" && number != "58b") {
            if (number == "164") read_units();
            else ++others_;
            rest_of_dataset();
            return;
        }
        Binary binary;
        if (number == "58b") binary = binary_of(words);
        read_function(binary);
    }

    /// SI values have units, whichever labels they have.
    void read_units() {
        std::string_view line;
        if (!next(line) || is_delimiter(line)) fail("cut short: a dataset of units has a code");
        is_si_ = number_of(without_blanks(line.substr(0, 10))) == 1.0;
        --datasets_;
    }

    struct Binary {
        bool is_binary = false, is_swapped = false;
        std::size_t bytes = 0;
    };

    Binary binary_of(std::string_view words) const {
        std::array<double, 4> fields{};
        for (double& field : fields) field = number_of(take_number(words)).value_or(-1.0);
        const auto [order, form, lines, bytes] = fields;
        if ((order != 1.0 && order != 2.0) || lines != 11.0 || !(bytes >= 0.0 && bytes <= 1e15))
            fail("the header of a binary dataset is damaged");
        if (form != 2.0) fail("binary values are not in the IEEE 754 form; save them as text (58)");
        return {true, (order == 1.0) != (std::endian::native == std::endian::little), static_cast<std::size_t>(bytes)};
    }

    struct Function {
        std::string name, unit, abscissa_unit;
        bool is_of_time = false, is_complex = false, is_double = false, is_even = false;
        std::size_t count = 0;
        double start = 0.0, step = 0.0;
    };

    Function header_of_function() {
        Function f;
        std::string title;
        for (int n = 0; n < 5; ++n) {
            const std::string_view line = without_blanks(needed());
            if (n == 0 && line != "NONE") title = line;
        }
        const std::string_view dof = needed();
        const double kind = number_of(without_blanks(dof.substr(0, 5))).value_or(-1.0);
        f.name = name_of(dof, title);
        std::string_view words = needed();
        std::array<double, 5> fields{};
        for (double& field : fields) field = number_of(take_number(words)).value_or(-1.0);
        const auto [type, count, spacing, start, step] = fields;
        if (type != 2.0 && type != 4.0 && type != 5.0 && type != 6.0)
            fail(fmt::format("the ordinate type {:g} is unknown; it is 2, 4, 5 or 6", type));
        if (!(count >= 0.0 && count <= 1e12)) fail("the number of values is damaged");
        f.is_complex = type >= 5.0;
        f.is_double = type == 4.0 || type == 6.0;
        f.is_even = spacing == 1.0;
        f.count = static_cast<std::size_t>(count);
        f.start = start, f.step = step;
        const auto [abscissa, abscissa_label] = axis_of(needed());
        const auto [ordinate, ordinate_label] = axis_of(needed());
        needed(), needed();
        // 17: time. General functions and time responses may leave it open.
        f.is_of_time = abscissa == 17.0 || (abscissa == 0.0 && kind == 1.0);
        f.abscissa_unit = abscissa_label.empty() ? "s" : abscissa_label;
        f.unit = ordinate_label;
        if (f.unit.empty() && is_si_)
            f.unit = ordinate == 12.0   ? "m/s^2"
                     : ordinate == 11.0 ? "m/s"
                     : ordinate == 8.0  ? "m"
                     : ordinate == 13.0 ? "N"
                                        : "";
        if (f.is_of_time && f.is_even) {
            const std::optional<TimeUnit> unit = time_unit_of_word(f.abscissa_unit);
            if (!unit) fail(fmt::format("the unit '{}' of the abscissa is no unit of time", f.abscissa_unit));
            f.start *= unit->seconds, f.step *= unit->seconds;
            if (!(f.step > 0.0)) fail("the increment of the abscissa is not above 0");
        }
        return f;
    }

    /// "12Z+", node and direction of the response; else the first line of the function.
    static std::string name_of(std::string_view dof, const std::string& title) {
        const auto field = [&](std::size_t from, std::size_t size) {
            return from < dof.size() ? without_blanks(dof.substr(from, size)) : std::string_view{};
        };
        const double node = number_of(field(41, 10)).value_or(0.0), direction = number_of(field(51, 4)).value_or(0.0);
        constexpr std::array<std::string_view, 7> axes{"", "X", "Y", "Z", "RX", "RY", "RZ"};
        const double axis = std::abs(direction);
        if ((node == 0.0 && direction == 0.0) || axis > 6.0 || axis != std::floor(axis)) return title;
        return fmt::format("{:.0f}{}{}", node, axes[static_cast<std::size_t>(axis)],
                           direction < 0.0   ? "-"
                           : direction > 0.0 ? "+"
                                             : "");
    }

    /// The kind of data of an axis and its unit label.
    static std::pair<double, std::string> axis_of(std::string_view line) {
        const double kind = number_of(without_blanks(line.substr(0, 10))).value_or(-1.0);
        const std::string_view label = line.size() > 47 ? without_blanks(line.substr(47)) : std::string_view{};
        return {kind, label == "NONE" || label == "NONE, NONE" ? "" : std::string(label)};
    }

    void read_function(const Binary& binary) {
        const Function f = header_of_function();
        const int line = line_;
        std::string_view data;
        if (binary.is_binary) {
            if (binary.bytes > bytes_.size() - at_) fail("cut short: the binary values are incomplete");
            data = bytes_.substr(at_, binary.bytes);
            at_ += binary.bytes;
            rest_of_dataset();
        } else {
            data = rest_of_dataset();
        }
        if (!f.is_of_time || f.is_complex) {
            ++(f.is_complex ? complex_ : not_in_time_);
            return;
        }
        std::vector<double> times, values;
        if (binary.is_binary) read_binary(f, data, binary.is_swapped, line, times, values);
        else read_text(f, data, line, times, values);
        add(f, std::move(times), std::move(values));
    }

    [[noreturn]] void fail_in(int line, const std::string& message) const {
        throw Error(SourceLocation{file_, line, 1}, message);
    }

    /// Each number is held twice: in its channel and in the chosen columns.
    void require_room(std::size_t numbers) const {
        file::require_room(static_cast<double>(bytes_.size()) + 16.0 * static_cast<double>(held_ + numbers), file_,
                           "its functions");
    }

    void read_text(const Function& f, std::string_view data, int line, std::vector<double>& times,
                   std::vector<double>& values) const {
        const std::size_t numbers = f.is_even ? f.count : 2 * f.count;
        // A number and a blank or sign.
        if (numbers > data.size())
            fail_in(line, fmt::format("cut short: {} values are stated, more than the dataset holds", f.count));
        require_room(numbers);
        values.reserve(f.count);
        if (!f.is_even) times.reserve(f.count);
        for (std::size_t n = 0; n < numbers; ++n) {
            const std::string_view word = take_number(data);
            const std::optional<double> number = number_of(word);
            if (word.empty())
                fail_in(line, fmt::format("cut short: {} values are stated, and {} are there", f.count, n));
            if (!number) fail_in(line, fmt::format("'{}' is not a number", word.substr(0, 40)));
            (!f.is_even && n % 2 == 0 ? times : values).push_back(*number);
        }
        if (!take_number(data).empty()) fail_in(line, fmt::format("{} values are stated, and more are there", f.count));
    }

    void read_binary(const Function& f, std::string_view data, bool swapped, int line, std::vector<double>& times,
                     std::vector<double>& values) const {
        const std::size_t size = f.is_double ? 8 : 4;
        // The definition has abscissae of 4 bytes, some programs write them like the values.
        const std::size_t before = f.is_even ? 0 : data.size() >= f.count * (size + size) ? size : 4;
        if (f.count > data.size() / (size + before))
            fail_in(line, fmt::format("cut short: {} values are stated, more than the dataset holds", f.count));
        require_room(before > 0 ? 2 * f.count : f.count);
        values.reserve(f.count);
        if (before > 0) times.reserve(f.count);
        const auto number_at = [&](std::size_t at, std::size_t width) -> double {
            std::array<char, 8> raw{};
            std::memcpy(raw.data(), data.data() + at, width);
            if (swapped) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(width));
            if (width == 8) return std::bit_cast<double>(raw);
            float number;
            std::memcpy(&number, raw.data(), sizeof number);
            return number;
        };
        for (std::size_t n = 0; n < f.count; ++n) {
            const std::size_t at = n * (size + before);
            if (before > 0) times.push_back(number_at(at, before));
            values.push_back(number_at(at + before, size));
        }
    }

    /// Functions with the same abscissa follow one clock.
    void add(const Function& f, std::vector<double> times, std::vector<double> values) {
        ++functions_;
        std::string name = own_name(f.name.empty() ? fmt::format("dataset {}", datasets_) : f.name);
        std::size_t group = clocks_.size();
        for (std::size_t n = 0; n < clocks_.size(); ++n) {
            const Clock& known = clocks_[n];
            if (known.is_even == f.is_even && known.count == f.count &&
                (f.is_even ? known.step == f.step && known.start == f.start : known.times == times))
                group = n;
        }
        held_ += values.size();
        if (group == clocks_.size()) {
            held_ += 2 * times.size();  // the clock has its own
            clocks_.push_back({f.is_even, f.count, f.start, f.step, times});
            if (!f.is_even)
                recording_.channels.push_back(
                    {own_name(group == 0 ? std::string("time") : fmt::format("time {}", group + 1)), f.abscissa_unit,
                     std::move(times), 0.0, group});
        }
        recording_.channels.push_back(
            {std::move(name), f.unit, std::move(values), f.is_even ? 1.0 / f.step : 0.0, group});
    }

    /// "12Z+ (2)" for the second channel of a name.
    std::string own_name(const std::string& wanted) {
        std::string name = wanted;
        while (!names_.try_emplace(name, 1).second) name = fmt::format("{} ({})", wanted, ++names_[wanted]);
        return name;
    }

    struct Clock {
        bool is_even;
        std::size_t count;
        double start, step;
        std::vector<double> times;
    };

    std::string_view bytes_;
    const std::string& file_;
    std::size_t at_ = 0, held_ = 0;  // numbers of all functions so far
    int line_ = 0, datasets_ = 0, functions_ = 0, others_ = 0, not_in_time_ = 0, complex_ = 0;
    bool is_si_ = false;
    std::vector<Clock> clocks_;
    std::unordered_map<std::string, int> names_;  // taken, with how many of each
    Recording recording_;
};

}  // namespace

bool is_universal_file(std::string_view start) {
    const std::size_t end = start.find('\n');
    if (end == std::string_view::npos || !is_delimiter(start.substr(0, end))) return false;
    std::string_view second = start.substr(end + 1);
    second = without_blanks(second.substr(0, second.find('\n')));
    return !second.empty() && second.front() >= '0' && second.front() <= '9';
}

Recording read_universal_file(std::string_view bytes, const std::string& file) {
    return UniversalFile(bytes, file).read();
}

}  // namespace tactus::table
