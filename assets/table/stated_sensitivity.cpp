// SPDX-License-Identifier: Apache-2.0
#include "assets/table/stated_sensitivity.hpp"

#include "assets/table/log_lines.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

namespace tactus::table {

namespace {

constexpr std::string_view sensitivity_word = "sensitivity", ten_digits = "0123456789";

bool has_digit(std::string_view text) { return text.find_first_of(ten_digits) != std::string_view::npos; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Letters and numbers of a text, in lower case.
std::vector<std::string> channel_words(std::string_view text) {
    std::vector<std::string> words;
    for (const char c : lower(text)) {
        const bool is_number = is_digit(c), is_letter = (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
        if (!is_number && !is_letter) {
            words.emplace_back();
            continue;
        }
        if (words.empty()) words.emplace_back();
        if (!words.back().empty() && is_digit(words.back().back()) != is_number) words.emplace_back();
        words.back() += c;
    }
    std::erase(words, std::string());
    return words;
}

/// Without the words that every such line may have.
std::vector<std::string> telling_words(std::string_view text) {
    std::vector<std::string> words = channel_words(text);
    std::erase_if(words, [](const std::string& word) {
        constexpr std::array<std::string_view, 16> filling{
            "sensor", "the",     "of", "for",    "nominal", "axis", "accelerometer", "in", "and",
            "is",     "channel", "ch", "column", "input",   "ai",   "direction"};
        return std::ranges::find(filling, word) != filling.end();
    });
    return words;
}

/// Places at which a list is separated: semicolons, tabs, and commas that are not decimal.
std::vector<std::string_view> list_entries(std::string_view text, char separator) {
    std::vector<std::string_view> entries;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        const bool is_decimal = i > 0 && i + 1 < text.size() && text[i] == ',' && separator != ',' &&
                                is_digit(text[i - 1]) && is_digit(text[i + 1]);
        const bool is_end = i == text.size() || text[i] == ';' || text[i] == '\t' || (text[i] == ',' && !is_decimal);
        // "100 mV/g 10 mV/g"
        const bool is_next = i < text.size() && text[i] == ' ' && i + 1 < text.size() && is_digit(text[i + 1]) &&
                             text.substr(begin, i - begin).find('/') != std::string_view::npos;
        if (!is_end && !is_next) continue;
        entries.push_back(trimmed(text.substr(begin, i - begin)));
        begin = i + 1;
    }
    while (!entries.empty() && entries.back().empty()) entries.pop_back();
    return entries;
}

bool is_bare_number(std::string_view text) {
    return has_digit(text) && text.find_first_not_of("0123456789.,eE+-") == std::string_view::npos;
}

/// "100 mV/g": a number, then volts per something.
bool is_ratio(std::string_view text) {
    const std::size_t unit = text.find_first_not_of("0123456789.,eE+- ");
    if (unit == std::string_view::npos || !has_digit(text.substr(0, unit))) return false;
    const std::size_t slash = text.find('/', unit);
    if (slash == std::string_view::npos) return false;
    const std::optional<ColumnUnit> volts = parse_column_unit(trimmed(text.substr(unit, slash - unit)));
    return volts && volts->is_voltage();
}

/// "[mV/g]" or "(mV/(m/s²))" at the start of a text, and what follows.
std::optional<std::pair<std::string_view, std::string_view>> leading_bracket(std::string_view text) {
    if (text.empty() || (text.front() != '(' && text.front() != '[')) return std::nullopt;
    const char open = text.front(), close = open == '(' ? ')' : ']';
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        depth += text[i] == open ? 1 : text[i] == close ? -1 : 0;
        if (depth == 0) return std::pair(trimmed(text.substr(1, i - 1)), trimmed(text.substr(i + 1)));
    }
    return std::nullopt;
}

/// How a channel is named that a column may be.
bool is_column(const std::vector<std::string>& channel, const NamedColumn& column) {
    const std::vector<std::string> all = channel_words(column.name), name = telling_words(column.name);
    if (channel == name || channel == all) return true;
    if (channel.size() != 1) return false;
    const std::string& word = channel.front();
    if (word.size() == 1 && word[0] >= 'x' && word[0] <= 'z') {
        const std::optional<std::string> family = axis_family(column.name);
        if (!family) return false;
        // The unit may follow the axis: accel_x_mV.
        for (std::size_t i = all.size(); i-- > 0;)
            if (all[i].back() >= 'x' && all[i].back() <= 'z') return all[i].back() == word[0];
        return false;
    }
    return has_digit(word) && !name.empty() && name.back() == word;
}

class SensitivityAssigner {
public:
    SensitivityAssigner(std::span<const StatedSensitivity> stated, const std::vector<NamedColumn>& columns,
                        const std::vector<std::size_t>& values, const std::vector<std::size_t>& chosen)
        : stated_(stated.begin(), stated.end()), columns_(columns), values_(values), chosen_(chosen) {}

    AssignedSensitivities assign() {
        if (stated_.empty()) return {};
        of_columns_.resize(columns_.size());
        const bool is_list =
            stated_.size() > 1 && stated_[1].line == stated_[0].line &&
            std::ranges::all_of(stated_, [this](const auto& one) { return columns_of(one.channel).empty(); });
        if (is_single()) {
            for (const std::size_t column : values_) of_columns_[column] = first();
        } else if (!(is_list ? assign_list() : assign_by_channel())) {
            return {{}, doubt("they cannot be assigned to columns by name or number")};
        }
        AssignedSensitivities out;
        for (const std::size_t column : chosen_) {
            if (!of_columns_[column])
                return {{}, doubt(fmt::format("none is for the column '{}'", columns_[column].name))};
            out.of_columns.push_back(*of_columns_[column]);
        }
        return out;
    }

private:
    StatedSensitivity first() const {
        return *std::ranges::find_if(stated_, [](const auto& one) { return !one.text.empty(); });
    }

    /// One number, that no line reserves for a channel which is a column.
    bool is_single() const {
        const std::string& text = first().text;
        return std::ranges::all_of(
            stated_, [&](const StatedSensitivity& one) { return one.text == text && columns_of(one.channel).empty(); });
    }

    /// Columns with the name, the axis or the number of a channel.
    std::vector<std::size_t> columns_of(std::string_view channel) const {
        std::vector<std::size_t> found;
        const std::vector<std::string> words = telling_words(channel);
        if (words.empty()) return found;
        for (const std::size_t column : values_)
            if (is_column(words, columns_[column])) found.push_back(column);
        // "channel 2" of columns without numbers is the second of them.
        if (found.empty() && words.size() == 1 && has_digit(words.front()) && words.front().size() < 4 &&
            std::ranges::none_of(values_, [this](std::size_t column) { return has_digit(columns_[column].name); })) {
            const auto number = static_cast<std::size_t>(std::stoul(words.front()));
            if (number >= 1 && number <= values_.size()) found.push_back(values_[number - 1]);
        }
        return found;
    }

    bool set(std::size_t column, const StatedSensitivity& one) {
        std::optional<StatedSensitivity>& known = of_columns_[column];
        if (known && known->text != one.text) return false;
        known = one;
        return true;
    }

    bool assign_by_channel() {
        std::vector<StatedSensitivity> for_all;
        for (const StatedSensitivity& one : stated_) {
            const std::vector<std::size_t> found = columns_of(one.channel);
            if (found.empty()) {
                for_all.push_back(one);
                continue;
            }
            for (const std::size_t column : found)
                if (!set(column, one)) return false;
        }
        if (for_all.empty()) return true;
        // A number without a channel is for the columns that no other is for.
        if (for_all.size() > 1 || !telling_words(for_all.front().channel).empty()) return false;
        for (const std::size_t column : values_)
            if (!of_columns_[column]) of_columns_[column] = for_all.front();
        return true;
    }

    /// One entry per column of values, or per column of the table, of which the first may hold the name of the line.
    bool assign_list() {
        if (std::ranges::any_of(stated_, [this](const auto& one) { return one.line != stated_.front().line; }))
            return false;
        const std::size_t count = stated_.size();
        const bool is_full = std::ranges::none_of(stated_, [](const auto& one) { return one.text.empty(); });
        std::vector<std::size_t> volts;
        for (const std::size_t column : values_)
            if (columns_[column].unit && columns_[column].unit->is_voltage()) volts.push_back(column);
        const auto assign_to = [&](const std::vector<std::size_t>& columns) {
            for (std::size_t i = 0; i < count; ++i)
                if (!stated_[i].text.empty() &&
                    (std::ranges::find(values_, columns[i]) == values_.end() || !set(columns[i], stated_[i])))
                    return false;
            return true;
        };
        if (is_full && count == volts.size()) return assign_to(volts);
        if (is_full && count == values_.size()) return assign_to(values_);
        std::vector<std::size_t> all(columns_.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
        if (count == all.size()) return assign_to(all);
        if (count + 1 == all.size() && std::ranges::find(values_, 0) == values_.end()) {
            all.erase(all.begin());
            return assign_to(all);
        }
        return false;
    }

    std::string doubt(const std::string& why) const {
        std::set<int> lines;
        std::vector<std::string> texts;
        for (const StatedSensitivity& one : stated_) {
            lines.insert(one.line);
            if (!one.text.empty() && texts.size() < 8) texts.push_back(one.text);
        }
        return fmt::format(
            "{} {} the sensitivit{} {}, and {}; choose columns with --column and state the sensitivity "
            "with --sensitivity",
            lines.size() == 1 ? fmt::format("line {}", *lines.begin())
                              : fmt::format("lines {}", fmt::join(lines, ", ")),
            lines.size() == 1 ? "states" : "state", texts.size() == 1 ? "y" : "ies", fmt::join(texts, ", "), why);
    }

    std::vector<StatedSensitivity> stated_;
    const std::vector<NamedColumn>& columns_;
    const std::vector<std::size_t>&values_, &chosen_;
    std::vector<std::optional<StatedSensitivity>> of_columns_;  // of all columns
};

}  // namespace

std::vector<StatedSensitivity> sensitivities_in(std::string_view line, int number, char separator) {
    const std::string text = as_utf8(line);
    const std::size_t at = lower(text).find(sensitivity_word);
    if (at == std::string::npos) return {};
    const std::string_view all = text;
    std::string_view rest = all.substr(at + sensitivity_word.size());
    std::string channel(trimmed(all.substr(0, at)));
    std::string unit;
    rest = trimmed(rest);
    if (const auto bracket = leading_bracket(rest); bracket && !has_digit(bracket->first))
        unit = bracket->first, rest = bracket->second;
    // "Sensitivity of ax: 100 mV/g", "Sensitivity CH1 = 100 mV/g", "Sensitivity channel 2,10 mV/g"
    const std::size_t first_end = std::min(rest.find_first_of(",;\t"), rest.size());
    if (const std::size_t sign = rest.find_first_of(":="); sign < first_end) {
        channel += ' ' + std::string(rest.substr(0, sign));
        rest = rest.substr(sign + 1);
    } else if (first_end < rest.size() && first_end > 0 && !is_digit(rest.front()) &&
               rest.substr(0, first_end).find('/') == std::string_view::npos) {
        channel += ' ' + std::string(rest.substr(0, first_end));
        rest = rest.substr(first_end + 1);
    } else if (first_end == 0 && !rest.empty()) {
        rest.remove_prefix(1);
    }
    if (unit.empty())
        if (const auto bracket = leading_bracket(trimmed(rest)); bracket && !has_digit(bracket->first))
            unit = bracket->first, rest = bracket->second;
    std::vector<StatedSensitivity> found;
    bool is_any = false;
    const std::vector<std::string_view> entries = list_entries(rest, separator);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        std::string_view entry = entries[i];
        const bool has_unit_behind =
            i + 1 < entries.size() && !has_digit(entries[i + 1]) && entries[i + 1].find('/') != std::string_view::npos;
        StatedSensitivity one{{}, channel, number};
        // "x = 100 mV/g", "x: 100 mV/g", "x 100 mV/g"
        if (!entry.empty() && !is_digit(entry.front()))
            if (const std::size_t begin = std::min(entry.find_first_of(":="), entry.find(' ')); begin < entry.size()) {
                const std::size_t sign = entry.find_first_of(":=");
                const std::size_t end = sign < entry.size() ? sign : begin;
                if (entry.substr(0, end).find('/') == std::string_view::npos && has_digit(entry.substr(end)))
                    one.channel += ' ' + std::string(entry.substr(0, end)), entry = trimmed(entry.substr(end + 1));
            }
        if (!entry.empty() && !unit.empty() && is_bare_number(entry)) one.text = fmt::format("{} {}", entry, unit);
        else if (!has_digit(entry) && entry.find('/') != std::string_view::npos && !found.empty() &&
                 is_bare_number(found.back().text)) {
            // "Sensitivity,100,mV/g"
            found.back().text += ' ' + std::string(entry);
            is_any = true;
            continue;
        } else if (!entry.empty() && !is_bare_number(entry) && !is_ratio(entry)) {
            // "5 %", "range 50 g" and "S/N 12345" state something else.
            continue;
        } else if (!found.empty() && unit.empty() && !has_unit_behind && is_bare_number(entry) &&
                   is_ratio(found.back().text)) {
            // "100 mV/g; 12345": a serial number or a date, unless the list goes on with units.
            continue;
        } else {
            one.text = entry;
        }
        is_any = is_any || (has_digit(one.text) && one.text.find('/') != std::string::npos);
        found.push_back(std::move(one));
    }
    if (!is_any) return {};
    return found;
}

AssignedSensitivities assign_sensitivities(std::span<const StatedSensitivity> stated,
                                           const std::vector<NamedColumn>& columns,
                                           const std::vector<std::size_t>& values,
                                           const std::vector<std::size_t>& chosen) {
    return SensitivityAssigner(stated, columns, values, chosen).assign();
}

}  // namespace tactus::table
