// SPDX-License-Identifier: Apache-2.0
#include "assets/table/time_unit.hpp"

#include "dsp/core/lower.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace tactus::table {

namespace {

constexpr double min_rate = 9.0, max_rate = 220e3;  // Hz: 10 Hz to 200 kHz with a margin
constexpr double first_date = 1e9, last_date = 4e9;  // s since 1970: from 2001 to 2096

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_letter(char c) { return is_upper(c) || is_lower(c) || static_cast<unsigned char>(c) >= 0x80; }

/// Words of a name, in lower case: "TimeUS" and "time_us" are "time", "us".
std::vector<std::string> words_of(std::string_view name) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < name.size();) {
        if (!is_letter(name[i])) {
            ++i;
            continue;
        }
        std::size_t end = i + 1;
        while (end < name.size() && is_letter(name[end]) && !(is_lower(name[end - 1]) && is_upper(name[end]))) ++end;
        words.push_back(lower(name.substr(i, end - i)));
        i = end;
    }
    return words;
}

const TimeUnit& unit_named(std::string_view symbol) {
    return *std::ranges::find(time_units(), symbol, &TimeUnit::symbol);
}

}  // namespace

std::span<const TimeUnit> time_units() {
    static const std::array<TimeUnit, 4> units{{{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
    return units;
}

std::optional<TimeUnit> time_unit_of_word(std::string_view word) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 35> words{
        {{"s", "s"},          {"sec", "s"},          {"secs", "s"},          {"second", "s"},
         {"seconds", "s"},    {"sek", "s"},          {"sekunden", "s"},      {"ms", "ms"},
         {"msec", "ms"},      {"msecs", "ms"},       {"milli", "ms"},        {"millis", "ms"},
         {"millisec", "ms"},  {"millisecs", "ms"},   {"millisecond", "ms"},  {"milliseconds", "ms"},
         {"us", "us"},        {"µs", "us"},          {"μs", "us"},           {"usec", "us"},
         {"usecs", "us"},     {"micro", "us"},       {"micros", "us"},       {"microsec", "us"},
         {"microsecs", "us"}, {"microsecond", "us"}, {"microseconds", "us"}, {"ns", "ns"},
         {"nsec", "ns"},      {"nano", "ns"},        {"nanos", "ns"},        {"nanosec", "ns"},
         {"nanosecs", "ns"},  {"nanosecond", "ns"},  {"nanoseconds", "ns"}}};
    const std::string small = lower(word);
    for (const auto& [known, symbol] : words)
        if (small == known) return unit_named(symbol);
    return std::nullopt;
}

std::optional<TimeUnit> time_unit_in_name(std::string_view name) {
    std::vector<std::string> words = words_of(name);
    const std::vector<std::string> small = words_of(lower(name));
    // Capitals do not always begin words ("tImE_mS"): parts between other characters are tried first.
    words.insert(words.end(), small.begin(), small.end());
    for (std::size_t i = words.size(); i-- > 0;) {
        // "milli seconds"
        if (i > 0 && (words[i].starts_with("sec")) &&
            (words[i - 1] == "milli" || words[i - 1] == "micro" || words[i - 1] == "nano"))
            return time_unit_of_word(words[i - 1]);
        if (std::optional<TimeUnit> unit = time_unit_of_word(words[i])) return unit;
        // "timems"; "times" is a plural.
        for (const std::string_view before : {"timestamp", "time"})
            if (words[i].starts_with(before) && words[i].size() > before.size() + 1)
                if (std::optional<TimeUnit> unit = time_unit_of_word(words[i].substr(before.size()))) return unit;
    }
    return std::nullopt;
}

bool is_time_name(std::string_view name) {
    const std::string whole = lower(name);
    std::vector<std::string> words = words_of(name);
    // Capitals may also begin no words: "tImE_mS".
    if (words.size() > 1) std::ranges::copy(words_of(whole), std::back_inserter(words));
    if (whole == "x_value" || whole == "date/time" || whole == "date time") return true;
    if (words.size() == 1 && (words[0] == "t" || time_unit_of_word(words[0]))) return true;
    if (whole.starts_with("t_")) return true;
    return std::ranges::any_of(words, [](const std::string& word) {
        if (word.starts_with("time") || word.ends_with("time")) return word != "timer" && !word.starts_with("timeout");
        for (const std::string_view known : {"timestamp", "elapsed", "millis", "micros", "nanos", "zeit", "zeitstempel",
                                             "temps", "tid", "tiempo", "tempo", "tempi", "epoch"})
            if (word == known) return true;
        return false;
    });
}

double mean_step(std::span<const double> times) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
    if (steps.empty()) return 0.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const double gap = 5.0 * *middle;
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (const double step = times[i] - times[i - 1]; step <= gap) sum += step, ++count;
    return sum / count;
}

TimeUnitGuess guess_time_unit(double first_time, double step) {
    TimeUnitGuess guess;
    if (!(step > 0.0)) return guess;
    for (const TimeUnit& unit : time_units()) {
        const double rate = 1.0 / (step * unit.seconds), date = first_time * unit.seconds;
        if (rate < min_rate || rate > max_rate) continue;
        if (date >= first_date && date <= last_date) return {{unit}, true};
        guess.fitting.push_back(unit);
    }
    return guess;
}

SettledTimeUnit settle_time_unit(std::span<const double> times, double origin, double rate,
                                 const std::string& rate_place, const std::string& column,
                                 const std::function<void(const std::string&)>& fail) {
    const double step = mean_step(times);
    if (step == 0.0) return {time_units().front(), ""};
    const TimeUnitGuess guess = guess_time_unit(origin + times.front(), step);
    const auto at_rate = [&](const TimeUnit& unit) {
        return fmt::format("{} ({:.4g} Hz)", unit.symbol, 1.0 / (step * unit.seconds));
    };
    for (const TimeUnit& unit : time_units())
        if (rate > 0.0 && std::abs(step * unit.seconds * rate - 1.0) < 0.05)
            return {unit, fmt::format("no unit is stated; {} agrees with the rate in {}", at_rate(unit), rate_place)};
    if (guess.fitting.size() == 1)
        return {guess.fitting.front(),
                guess.is_epoch ? fmt::format("no unit is stated; the times are dates in {}", guess.fitting[0].symbol)
                               : fmt::format("no unit is stated; only {} is plausible", at_rate(guess.fitting[0]))};
    std::vector<std::string> rates;
    for (const TimeUnit& unit : guess.fitting) rates.push_back(at_rate(unit));
    fail(fmt::format(
        "the times in column '{}' have no unit, and {}; state it with --time-unit{}", column,
        rates.empty() ? fmt::format("in none is their mean step of {:.4g} a rate of 10 Hz to 200 kHz", step)
                      : fmt::format("their mean step of {:.4g} may be in {}", step, fmt::join(rates, " or in ")),
        rates.empty()
            ? ": s, ms, us or ns"
            : fmt::format(" {} or --time-unit {}", guess.fitting.front().symbol, guess.fitting.back().symbol)));
    return {};
}

}  // namespace tactus::table
