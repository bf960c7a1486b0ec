// SPDX-License-Identifier: Apache-2.0
#include "assets/table/stated_rate.hpp"

#include "assets/table/column_unit.hpp"
#include "assets/table/decimal_sign.hpp"
#include "assets/table/log_lines.hpp"
#include "assets/table/time_unit.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace tactus::table {

namespace {

constexpr double min_rate_without_unit = 9.0;  // Hz, of an interval; as guess_time_unit
constexpr std::string_view digits = "0123456789";

constexpr std::array<std::string_view, 12> rate_names{
    "sample rate",        "samplerate",       "sample_rate",   "sampling rate",      "sampling_rate", "samplingrate",
    "sampling frequency", "sample frequency", "sampling freq", "samples per second", "abtastrate",    "abtastfrequenz"};
constexpr std::array<std::string_view, 7> interval_names{"sample interval", "sampling interval", "sample period",
                                                         "sampling period", "delta_x",           "time increment",
                                                         "abtastintervall"};

std::optional<double> hertz_of(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 25> words{{{"hz", 1.0},
                                                                         {"hertz", 1.0},
                                                                         {"khz", 1e3},
                                                                         {"kilohertz", 1e3},
                                                                         {"mhz", 1e6},
                                                                         {"megahertz", 1e6},
                                                                         {"s/s", 1.0},
                                                                         {"sa/s", 1.0},
                                                                         {"sps", 1.0},
                                                                         {"/s", 1.0},
                                                                         {"1/s", 1.0},
                                                                         {"samples/s", 1.0},
                                                                         {"samples/sec", 1.0},
                                                                         {"samples/second", 1.0},
                                                                         {"samples per second", 1.0},
                                                                         {"samples per sec", 1.0},
                                                                         {"per second", 1.0},
                                                                         {"ks/s", 1e3},
                                                                         {"ksa/s", 1e3},
                                                                         {"ksps", 1e3},
                                                                         {"ksamples/s", 1e3},
                                                                         {"ms/s", 1e6},
                                                                         {"msa/s", 1e6},
                                                                         {"msps", 1e6},
                                                                         {"msamples/s", 1e6}}};
    if (text == "mHz") return 1e-3;
    const std::string word = lower(text);
    for (const auto& [known, factor] : words)
        if (word == known) return factor;
    return std::nullopt;
}

std::optional<double> seconds_of(std::string_view text) {
    if (const std::optional<TimeUnit> unit = time_unit_of_word(text)) return unit->seconds;
    const std::optional<ColumnUnit> unit = parse_column_unit(text);
    return unit && unit->is_time() ? std::optional(unit->si) : std::nullopt;
}

/// A number with digits, points, commas and an exponent at the start of a text; empty if there is none.
std::string_view number_at(std::string_view text) {
    std::size_t end = text.empty() || (text.front() != '+' && text.front() != '-') ? 0 : 1;
    end = std::min(text.find_first_not_of("0123456789.,", end), text.size());
    // "1600," in a sentence.
    while (end > 0 && (text[end - 1] == ',' || text[end - 1] == '.')) --end;
    if (text.substr(0, end).find_first_of(digits) == std::string_view::npos) return {};
    if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
        std::size_t first = end + 1;
        if (first < text.size() && (text[first] == '+' || text[first] == '-')) ++first;
        const std::size_t last = std::min(text.find_first_not_of(digits, first), text.size());
        if (last > first) end = last;
    }
    return text.substr(0, end);
}

constexpr std::array<std::pair<char, char>, 3> unit_brackets{{{'(', ')'}, {'[', ']'}, {'{', '}'}}};

class RateLine {
public:
    RateLine(std::string_view rest, bool is_interval, char separator)
        : rest_(rest), is_interval_(is_interval), separator_(separator) {}

    std::optional<StatedRate> read() {
        read_unit_before_number();
        if (!find_number()) return std::nullopt;
        const bool has_fields =
            separator_ != no_separator && separator_ != ' ' && between_.find(separator_) != std::string::npos;
        if (has_fields) read_fields();
        else read_text();
        if (!out_.doubt.empty()) return std::move(out_);
        settle();
        return std::move(out_);
    }

private:
    /// A word without the signs of a unit.
    static bool is_remark(std::string_view text) {
        return text.size() > 3 && text.find_first_of("/%") == std::string_view::npos &&
               lower(text).find("hz") == std::string::npos && !hertz_of(text) && !seconds_of(text);
    }
    const char* quantity() const { return is_interval_ ? "interval" : "rate"; }
    void doubt(std::string why) {
        if (out_.doubt.empty()) out_.doubt = std::move(why);
    }
    std::optional<double> factor_of(std::string_view unit) const {
        return is_interval_ ? seconds_of(unit) : hertz_of(unit);
    }

    /// "Sampling rate (kHz): 25.6", "sample_rate_hz = 1000", "Abtastrate in kHz".
    void read_unit_before_number() {
        std::string_view text = rest_;
        while (!text.empty() && (text.front() == ' ' || text.front() == '_' || text.front() == '/'))
            text.remove_prefix(1);
        for (const auto& [open, close] : unit_brackets)
            if (!text.empty() && text.front() == open)
                if (const std::size_t end = text.find(close); end != std::string_view::npos) {
                    const std::string_view unit = trimmed(text.substr(1, end - 1));
                    if (unit.find_first_of(digits) == std::string_view::npos) {
                        before_ = unit, rest_ = text.substr(end + 1);
                        return;
                    }
                }
        if (lower(text.substr(0, 3)) == "in ") text = trimmed(text.substr(3));
        const std::size_t end = std::min(text.find_first_of(" \t:=,;"), text.size());
        if (factor_of(text.substr(0, end))) before_ = text.substr(0, end), rest_ = text.substr(end);
    }

    /// Behind the ':' or '=' that follows the name, "of channel 2: 1000", else the first.
    bool find_number() {
        std::size_t from = rest_.find_first_of(":=");
        if (from == std::string_view::npos || rest_.substr(0, from).find_first_of(",;\t") != std::string_view::npos)
            from = 0;
        if (const std::size_t first = rest_.find_first_of(digits); from > 0 && first < from) {
            // "1600 Hz, offset: 3" begins with the number.
            const std::string_view behind = trimmed(rest_.substr(first + number_at(rest_.substr(first)).size()));
            if (factor_of(behind.substr(0, behind.find_first_of(" \t:=,;")))) from = 0;
        }
        std::size_t begin = rest_.find_first_of(digits, from);
        if (begin == std::string_view::npos) return false;
        if (begin > from && rest_[begin - 1] == '.') --begin;
        if (begin > from && (rest_[begin - 1] == '-' || rest_[begin - 1] == '+')) --begin;
        between_ = rest_.substr(0, begin);
        rest_ = rest_.substr(begin);
        return true;
    }

    /// "Sample rate,25600,25600" and "Sampling frequency,1000,Hz": one per channel, with a unit in it or behind it.
    void read_fields() {
        std::vector<std::string_view> fields;
        split_fields(rest_, separator_, fields);
        for (const std::string_view field : fields) {
            const std::string_view number = number_at(field);
            if (number.empty()) {
                if (!field.empty()) note_unit(field, true);
                break;
            }
            note_number(number);
            if (const std::string_view unit = trimmed(field.substr(number.size())); !unit.empty())
                note_unit(unit, false);
        }
    }

    void read_text() {
        const std::string_view number = number_at(rest_);
        note_number(number);
        std::string_view text = rest_.substr(number.size());
        const std::size_t begin = std::min(text.find_first_not_of(" \t\",;"), text.size());
        const bool is_apart = text.substr(0, begin).find_first_of(",;") != std::string_view::npos;
        text.remove_prefix(begin);
        for (const auto& [open, close] : unit_brackets)
            if (!text.empty() && text.front() == open) {
                note_unit(trimmed(text.substr(1, std::min(text.find(close), text.size()) - 1)), false);
                return;
            }
        if (const std::string_view next = number_at(text); !next.empty() && text.substr(0, 3) != "1/s") {
            // "16 bit" is another statement.
            const std::string_view behind = trimmed(text.substr(next.size()));
            const std::string_view word = behind.substr(0, behind.find_first_of(" \t,;"));
            if (word.empty() || factor_of(word)) note_number(next), note_unit(word, true);
            else if (!is_apart) doubt(fmt::format("'{}' is followed by '{}'", number, next));
            return;
        }
        // Units of several words, then of one.
        std::string_view unit = trimmed(text.substr(0, text.find_first_of(",;()[]")));
        if (!factor_of(unit)) unit = unit.substr(0, unit.find_first_of(" \t"));
        while (!unit.empty() && (unit.back() == '.' || unit.back() == '\'')) unit.remove_suffix(1);
        note_unit(unit, is_apart);
    }

    void note_number(std::string_view text) {
        DecimalSign sign(no_separator);
        if (const auto refused = sign.note(text, 0)) return doubt(*refused);
        if (const auto unclear = sign.doubt())
            return doubt(fmt::format("'{}' may have a decimal comma or a thousands separator", text));
        const std::optional<double> number = sign.parse(text);
        if (!number || !(*number > 0.0) || !std::isfinite(*number))
            return doubt(fmt::format("'{}' is no number above 0", text));
        if (number_ && *number_ != *number)
            return doubt(fmt::format("it states the {}s {:.6g} and {:.6g}", quantity(), *number_, *number));
        number_ = number;
        // "25.600" beside numbers with decimal commas.
        const std::size_t point = text.find('.');
        if (point != std::string_view::npos && point > 0 && point <= 3 && text.front() != '0' &&
            text.size() == point + 4 && text.find_first_not_of(digits, point + 1) == std::string_view::npos)
            out_.point = text;
    }

    /// A word that is apart from the number may be no unit: "1600, range 2 g".
    void note_unit(std::string_view text, bool is_apart) {
        if (text.empty()) return;
        for (const auto& [open, close] : unit_brackets)
            if (text.front() == open && text.back() == close) text = trimmed(text.substr(1, text.size() - 2));
        // "1600 S/s/ch" is the rate of each channel.
        for (const std::string_view each : {"/channel", "/chan", "/ch", "/axis"})
            if (text.size() > each.size() && lower(text).ends_with(each)) text.remove_suffix(each.size());
        const std::optional<double> factor = factor_of(text);
        // "1600 (nominal)": a word that is no unit of anything.
        if (!factor && (is_apart || is_remark(text))) return;
        if (!factor) return doubt(fmt::format("'{}' is not a known unit of a {}", text, quantity()));
        if (factor_ && *factor_ != *factor) return doubt("it states two units");
        factor_ = factor;
    }

    void settle() {
        if (!before_.empty()) note_unit(before_, false);
        if (!out_.doubt.empty()) return;
        const double value = *number_ * factor_.value_or(1.0);
        out_.rate = is_interval_ ? 1.0 / value : value;
        if (!std::isfinite(out_.rate)) return doubt(fmt::format("{:.6g} is not possible", *number_));
        if (is_interval_ && !factor_ && out_.rate < min_rate_without_unit)
            doubt(fmt::format("the interval {:.6g} has no unit", *number_));
    }

    std::string_view rest_, before_;
    std::string between_;
    bool is_interval_;
    char separator_;
    std::optional<double> number_, factor_;
    StatedRate out_;
};

std::optional<std::string_view> behind(std::string_view line, std::span<const std::string_view> names) {
    const std::string small = lower(line);
    for (const std::string_view name : names)
        if (const std::size_t at = small.find(name); at != std::string::npos) {
            // "sample period jitter", "sampling rate divider" state something else.
            const std::string_view rest = line.substr(at + name.size());
            const std::size_t begin = rest.find_first_not_of(" _");
            const std::string word = begin == std::string_view::npos
                                         ? std::string()
                                         : lower(rest.substr(begin, rest.find_first_of(" _:=\t,;", begin) - begin));
            constexpr std::array<std::string_view, 9> others{"jitter",    "divider", "error",  "tolerance", "accuracy",
                                                             "deviation", "drift",   "factor", "ratio"};
            if (std::ranges::find(others, word) == others.end()) return rest;
            return std::nullopt;
        }
    return std::nullopt;
}

}  // namespace

std::optional<StatedRate> stated_rate(std::string_view line, char separator) {
    const std::string text = as_utf8(line);
    if (const auto rest = behind(text, rate_names)) return RateLine(*rest, false, separator).read();
    if (const auto rest = behind(text, interval_names)) return RateLine(*rest, true, separator).read();
    return std::nullopt;
}

std::optional<double> header_number(std::string_view text) {
    DecimalSign sign(no_separator);
    if (sign.note(text, 0) || sign.doubt()) return std::nullopt;
    return sign.parse(text);
}

}  // namespace tactus::table
