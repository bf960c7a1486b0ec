// SPDX-License-Identifier: Apache-2.0
// Logs as loggers, oscilloscopes, telephones and spreadsheets write them.
#include "tests/conformance/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus::conformance {

namespace {

using Text = std::string;

constexpr double turn = 6.283185307179586, rate = 1600.0, tone = 120.0, level = 5.0;
constexpr int row_count = 800;

/// m/s².
double value_at(double seconds) { return level * std::sin(turn * tone * seconds); }
double value(int n) { return value_at(n / rate); }

using Row = std::function<Text(int)>;

Text rows(const Row& row, int count = row_count) {
    Text out;
    for (int n = 0; n < count; ++n) out += row(n);
    return out;
}

/// "t,a" in the given scale and precision.
Row numbers(double per_second, const char* format = "{:.9g},{:.9g}\n") {
    return [=](int n) { return fmt::format(fmt::runtime(format), per_second * n / rate, value(n)); };
}

Text with_commas(Text text) {
    std::ranges::replace(text, ',', ';');
    std::ranges::replace(text, '.', ',');
    return text;
}

Text in_utf16(const Text& text) {
    Text out = "\xff\xfe";
    for (const char c : text) out += Text{c, '\0'};
    return out;
}

/// A time of day with milliseconds or microseconds.
Text time_of_day(double seconds, const char* format) {
    const auto whole = int(seconds);
    return fmt::format(fmt::runtime(format), 10 + whole / 3600, whole / 60 % 60, whole % 60,
                       std::int64_t(std::llround((seconds - whole) * 1e6)));
}

Check is_tone(double rms = level / std::sqrt(2.0), double of_rate = rate, double relative = 2e-3) {
    return [=](const Json& found) -> Text {
        const Json& row = found["rows"][0];
        if (auto fault = differs("the rate", row["sample_rate_hz"], of_rate, 1e-4); !fault.empty()) return fault;
        const Json& channel = row["channels"][0];
        if (auto fault = differs("the rms", channel["rms"], rms, relative); !fault.empty()) return fault;
        double nearest = 1e9;
        for (const Json& peak : channel["peaks"])
            nearest = std::min(nearest, std::abs(peak["hz"].get<double>() - tone));
        return nearest < 0.05 ? "" : "there is no line at 120 Hz: " + channel["peaks"].dump();
    };
}

/// A tone whose channel has a unit.
Check is_tone_in(const Text& unit, double rms = level / std::sqrt(2.0)) {
    return [=, right = is_tone(rms)](const Json& found) -> Text {
        const Json& seen = found["rows"][0]["channels"][0]["unit"];
        return seen == unit ? right(found) : "the unit is " + seen.dump();
    };
}

constexpr double gravity = 9.80665;

std::vector<Text> log_notes(const Json& found) {
    std::vector<Text> notes;
    const Json &row = found["rows"][0], none;
    const auto member = [&none](const Json& of, const char* key) -> const Json& {
        return of.contains(key) ? of[key] : none;
    };
    const Json &log = member(row, "log"), &form = member(log, "form"), &calibration = member(row, "calibration");
    const auto text = [&](const Json& value, const char* before = "") {
        if (value.is_string()) notes.push_back(before + value.get<Text>());
    };
    const auto count = [&](const Json& value, const char* what) {
        if (value.is_number() && value.get<double>() > 0.0) notes.push_back(fmt::format("{} {}", value.dump(), what));
    };
    text(member(form, "format"));
    // What a name or an option states is no note: a reason for a unit is, and a rate from another line.
    if (const Json& time = member(form, "time"); time.is_string())
        if (const Text stated = time.get<Text>(); stated.ends_with(")") || stated.find(", as line ") != Text::npos)
            notes.push_back("time: " + stated);
    count(member(log, "lost_rows"), "rows left out");
    count(member(log, "repeated_rows"), "rows repeated");
    count(member(log, "gaps"), "gaps");
    count(member(form, "statistics_lines"), "lines of statistics");
    if (const Json& step = member(log, "clock_step_s"); step.is_number())
        notes.push_back(fmt::format("clock of {:g} s", step.get<double>()));
    if (const Json& from = member(calibration, "from"); from.is_string() && from.get<Text>() != "the header")
        text(from, "scale: ");
    text(member(calibration, "remark"));
    return notes;
}

Case log_case(const Text& feature, const Text& content, Result result = Result::read, const Text& words = {},
              const std::vector<Text>& options = {}, const Check& check = {}) {
    return {feature, "a.csv", bytes(content), result, words, options, check};
}

std::vector<Case> shapes() {
    const Text plain = "time_s,ax (m/s²)\n" + rows(numbers(1.0));
    const auto spaced = [](int n) { return fmt::format("{:12.6f}   {:12.8f}\n", n / rate, value(n)); };
    const auto quoted = [](int n) {
        Text out = fmt::format("\"{:.6f}\",\"{:.8f}\"\n", n / rate, value(n));
        for (char& c : out) c = c == '.' ? ',' : c;
        return out;
    };
    Text late = plain;
    late.insert(0, "Data logger 7\nSerial,0815\n\n");
    return {
        log_case("commas", plain),
        log_case("semicolons and decimal commas", with_commas(plain)),
        log_case("tabs",
                 [&] {
                     Text out = plain;
                     std::ranges::replace(out, ',', '\t');
                     return out;
                 }()),
        log_case("blanks, aligned", "time_s  ax\n" + rows(spaced)),
        log_case("quoted numbers with decimal commas", "time_s,ax\n" + rows(quoted)),
        log_case("UTF-16, with a byte-order mark", in_utf16("time_s,ax (m/s2)\n" + rows(numbers(1.0)))),
        log_case("Latin-1", "time_s,ax (m/s\xb2)\n" + rows(numbers(1.0))),
        log_case("lines above the names", late),
        log_case("a row of units", "time,ax\ns,g\n" + rows(numbers(1.0)), Result::read, "", {}, is_tone_in("g")),
        log_case("comments", "# a logger\n" + plain),
        log_case("names in capitals", "TIME (MS),AX (M/S^2)\n" + rows(numbers(1e3))),
        log_case("a separator at the end of each row",
                 "time_s,ax,\n" + rows([](int n) { return fmt::format("{},{},\n", n / rate, value(n)); })),
        log_case("an empty column",
                 "time_s,,ax\n" + rows([](int n) { return fmt::format("{},,{}\n", n / rate, value(n)); })),
        log_case("cells with units",
                 "Time,Acc\n" + rows([](int n) { return fmt::format("{:.7f} sec,{:.8f} g\n", n / rate, value(n)); })),
        log_case("no names, with `--sample-rate`", rows([](int n) { return fmt::format("{:.9g}\n", value(n)); }),
                 Result::read, "", {"--sample-rate", "1600"}),
        log_case(
            "rows without a number (`nan`, `#DIV/0!`, an empty cell)",
            "time_s,ax\n" + rows([](int n) {
                const Text cell = n == 100 ? "nan" : n == 300 ? "#DIV/0!" : n == 500 ? "" : fmt::format("{}", value(n));
                return fmt::format("{},{}\n", n / rate, cell);
            }),
            Result::note, "3 rows left out", {}, is_tone(level / std::sqrt(2.0), rate * 796.0 / 799.0, 0.02)),
        log_case("rows that repeat the row before", "time_s,ax\n" + rows([](int n) {
                                                        const Text row = fmt::format("{},{}\n", n / rate, value(n));
                                                        return n % 100 == 50 ? row + row : row;
                                                    }),
                 Result::note, "8 rows repeated"),
        log_case("rows of statistics below the samples", plain + "\nMean,0.0\nMax,5.0\nMin,-5.0\n", Result::note,
                 "lines of statistics"),
        log_case("a number that may have a thousands separator", "time_s;ax\n0;1,234\n1;2,345\n2;1,111\n",
                 Result::refused, "1234 or 1.234"),
        log_case("a number beyond the columns", "time_s,ax\n0,1\n0.1,2,3\n0.2,3\n", Result::refused, "a.csv:3"),
        log_case("fewer names than columns", "time_s,ax\n0,1,2\n1,2,3\n", Result::refused, "2 names"),
        log_case("a word among the numbers", plain + "0.6,sensor error\n" + "0.7,1\n0.8,2\n", Result::refused,
                 "sensor error"),
        log_case("two columns of one name", "time_s,ax,ax\n" + rows([](int n) {
                                                return fmt::format("{},{},{}\n", n / rate, value(n), 2.0 * value(n));
                                            }),
                 Result::read, "", {"--column", "2"}),
        {"a name in capitals (`A.CSV`)", "A.CSV", bytes(plain)},
        log_case("channels with numbers (`Channel 0`, `Channel 1`)",
                 "Time [s],Channel 0,Channel 1\n" +
                     rows([](int n) { return fmt::format("{},{},{}\n", n / rate, value(n), 2.0 * value(n)); })),
        log_case("a column of row numbers (`Sample Number`)",
                 "Sample Number,Time (s),Analog 0 (V),Analog 1 (V)\n" +
                     rows([](int n) { return fmt::format("{},{},{},{}\n", n, n / rate, value(n), 2.0 * value(n)); })),
        log_case("columns of which none is known", "time_s,one,two\n0,1,2\n0.1,2,3\n0.2,3,2\n", Result::refused,
                 "--column 2,3"),
        log_case("names that come again below", plain + plain, Result::refused, "a.csv:802"),
        log_case("labels of a sound, as Audacity exports them", "0.000000\t1.500000\tcut\n1.500000\t3.000000\tfree\n",
                 Result::refused, "labels"),
        log_case("words only", "just words\nno numbers\n", Result::refused, "no line holds numbers"),
        log_case("an empty file", "", Result::refused, "empty"),
    };
}

std::vector<Case> clocks() {
    const auto epoch = [](double per_second, double start) {
        return
            [=](int n) { return fmt::format("{:.0f},{:.9g}\n", start * per_second + per_second * n / rate, value(n)); };
    };
    const auto slow = [](int n) { return fmt::format("{:.2f},{}\n", 0.02 * n, n % 7); };
    const auto two_sensors = [](int n) {
        return fmt::format("{},{},{}\n", n / (2.0 * rate), n % 2 + 1, n % 2 == 0 ? value(n / 2) : 0.1 * (n % 5));
    };
    const auto two_clocks = [](int n) {
        return fmt::format("{},{},{},{}\n", n / rate, value(n), n / 500.0, value_at(n / 500.0));
    };
    const Text head = "time,ax (m/s^2)\n";
    return {
        log_case("a named unit (`timestamp_ms`)", "timestamp_ms,ax\n" + rows(numbers(1e3))),
        log_case("a named unit (`TimeUS`)", "TimeUS,ax\n" + rows(numbers(1e6))),
        log_case("a named unit (`time [ns]`)", "time [ns],ax\n" + rows(numbers(1e9, "{:.0f},{:.9g}\n"))),
        log_case("no unit, plausible in one: milliseconds", head + rows(numbers(1e3)), Result::note, "in ms"),
        log_case("no unit, plausible in one: seconds", head + rows(numbers(1.0)), Result::note, "in s"),
        log_case("no unit, whole microseconds", head + rows(numbers(1e6, "{:.0f},{:.9g}\n")), Result::note, "us"),
        log_case("no unit, plausible in two", head + rows(slow), Result::refused, "--time-unit"),
        log_case("the same", head + rows(slow), Result::read, "", {"--time-unit", "ms"},
                 [](const Json& found) { return differs("the rate", found["rows"][0]["sample_rate_hz"], 5e4); }),
        log_case("no unit, plausible in none", "t,ax\n0,1\n1e9,2\n2e9,3\n", Result::refused, "--time-unit"),
        log_case("no unit, and a rate above the rows", "# sample rate: 1600 Hz\n" + head + rows(numbers(1e3)),
                 Result::note, "ms"),
        log_case("no times, and a rate above the rows",
                 "# sample rate: 1.6 kHz\nax\n" + rows([](int n) { return fmt::format("{:.9g}\n", value(n)); }),
                 Result::note, "1600 Hz"),
        log_case("no times and no rate", "ax\n" + rows([](int n) { return fmt::format("{:.9g}\n", value(n)); }),
                 Result::refused, "--sample-rate"),
        log_case("seconds since 1970",
                 head + rows([](int n) { return fmt::format("{:.6f},{:.9g}\n", 1.7e9 + n / rate, value(n)); }),
                 Result::note, "dates in s"),
        log_case("milliseconds since 1970",
                 head + rows([](int n) { return fmt::format("{:.3f},{:.9g}\n", 1.7e12 + 1e3 * n / rate, value(n)); }),
                 Result::note, "dates in ms"),
        log_case("microseconds since 1970", head + rows(epoch(1e6, 1.7e9)), Result::note, "dates in us"),
        log_case("nanoseconds since 1970",
                 head + rows([](int n) {
                     return fmt::format("{},{:.9g}\n",
                                        std::int64_t{1'700'000'000'000'000'000} + n * std::int64_t{625'000}, value(n));
                 }),
                 Result::note, "dates in ns"),
        log_case("dates and times (ISO 8601)", head + rows([](int n) {
                                                   return fmt::format("2024-05-17T{}Z,{:.9g}\n",
                                                                      time_of_day(n / rate, "{:02}:{:02}:{:02}.{:06}"),
                                                                      value(n));
                                               })),
        log_case("times of day", head + rows([](int n) {
                                     return fmt::format("{},{:.9g}\n", time_of_day(n / rate, "{:02}:{:02}:{:02}.{:06}"),
                                                        value(n));
                                 })),
        log_case("a clock of whole milliseconds",
                 "time_ms,ax\n" +
                     rows([](int n) { return fmt::format("{},{:.9g}\n", std::int64_t(n * 1000 / rate), value(n)); }),
                 Result::note, "clock of 0.001"),
        log_case("a clock of fewer than 32 steps",
                 "time,ax\n" + rows([](int n) { return fmt::format("10:00:{:02},{:.9g}\n", n / 80, value(n)); }),
                 Result::refused, "--sample-rate"),
        log_case("times that run backwards", "time_s,ax\n5,1\n4,2\n", Result::refused, "backwards"),
        log_case("a clock that is set while the logger runs", "time_s,ax\n0,1\n0.01,2\n1700000000,3\n1700000000.01,4\n",
                 Result::refused, "more than a day"),
        log_case("rows of two sensors in turn", "time_s,SENSOR,ax\n" + rows(two_sensors, 2 * row_count),
                 Result::refused, "--where \"SENSOR=1\""),
        log_case("the same", "time_s,SENSOR,ax\n" + rows(two_sensors, 2 * row_count), Result::read, "",
                 {"--where", "SENSOR=1"}),
        log_case("columns with clocks of different rates", "t1_s,ax,t2_s,ay\n" + rows(two_clocks), Result::refused,
                 "--time-column", {"--column", "ax,ay"}),
        log_case("the same", "t1_s,ax,t2_s,ay\n" + rows(two_clocks), Result::read, "", {"--column", "ay"},
                 is_tone(level / std::sqrt(2.0), 500.0, 2e-3)),
    };
}

std::vector<Case> programs() {
    const auto millivolts = [](int n) { return fmt::format("{},{:.8f}\n", n / rate, value(n) / gravity * 100.0); };
    const Text scope_rows = rows([](int n) { return fmt::format("{},{:.8f},,\n", n, value(n)); });
    return {
        log_case("a column in mV below `# sensitivity: 100 mV/g`",
                 "# sensitivity: 100 mV/g\ntime_s,ax (mV)\n" + rows(millivolts), Result::note, "scale", {},
                 is_tone(level / std::sqrt(2.0) / gravity)),
        log_case("columns in mV below a sensitivity for each axis",
                 "# y sensitivity: 100 mV/g\n# x sensitivity: 50 mV/g\ntime_s,ax (mV),ay (mV)\n" +
                     rows([](int n) { return fmt::format("{},{:.8f},0\n", n / rate, value(n) / gravity * 50.0); }),
                 Result::note, "scale", {}, is_tone(level / std::sqrt(2.0) / gravity)),
        log_case("the same without the channels",
                 "# sensitivity: 100 mV/g\n# sensitivity: 50 mV/g\ntime_s,ax (mV),ay (mV)\n" +
                     rows([](int n) { return fmt::format("{},{:.8f},0\n", n / rate, value(n)); }),
                 Result::refused, "--sensitivity"),
        log_case("a rate in kHz before its number (`Sampling rate (kHz): 1.6`)",
                 "Sampling rate (kHz): 1.6\nax\n" + rows([](int n) { return fmt::format("{:.9f}\n", value(n)); }),
                 Result::note, "1600 Hz"),
        log_case("an interval in µs",
                 "# Sample interval: 625 µs\nax\n" + rows([](int n) { return fmt::format("{:.9f}\n", value(n)); }),
                 Result::note, "1600 Hz"),
        log_case("a rate with a thousands separator (`1,600 Hz`)",
                 "# Sample rate: 1,600 Hz\nax\n" + rows([](int n) { return fmt::format("{:.9f}\n", value(n)); }),
                 Result::refused, "--sample-rate"),
        log_case("LabVIEW (`.lvm`)",
                 "LabVIEW Measurement\t\nSeparator\tTab\nDate\t2024/05/17\n***End_of_Header***\t\n\t\nChannels\t1\t\n"
                 "Samples\t800\t\nY_Unit_Label\tm/s^2\t\nX0\t0.0E+0\t\nDelta_X\t0.000625\t\n"
                 "***End_of_Header***\t\t\nX_Value\tAcceleration\tComment\n" +
                     rows([](int n) { return fmt::format("{:.6f}\t{:.8f}\n", n / rate, value(n)); }),
                 Result::note, "agrees with the rate in line 10", {}, is_tone_in("m/s^2")),
        log_case("an oscilloscope of Rigol, with start and increment",
                 "X,CH1,Start,Increment,\nSequence,Volt,-2.500000e-01,6.250000e-04,\n" + scope_rows, Result::note,
                 "1600 Hz"),
        log_case("a serial monitor with times of day", rows([](int n) {
                     return fmt::format("{} -> {:.6f},1\n", time_of_day(n / rate, "{:02}:{:02}:{:02}.{:06}"), value(n));
                 }),
                 Result::read, "", {"--column", "2"}),
        log_case("a separator that the file states (`sep=;`)",
                 "sep=;\n" + with_commas("time_s,ax\n" + rows(numbers(1.0)))),
        log_case("quantity over unit (`t/s`, `a/(m/s²)`)", "t/s;a/(m/s²)\n" + with_commas(rows(numbers(1.0))),
                 Result::read, "", {}, is_tone_in("m/s²")),
        log_case("units behind the word `Unit`", "Name,Time,Acc X\nUnit,s,m/s²\n" + rows([](int n) {
                                                     return fmt::format(",{},{}\n", n / rate, value(n));
                                                 }),
                 Result::read, "", {}, is_tone_in("m/s²")),
        log_case("accelerations in g", "time_s,ax (g)\n" + rows([](int n) {
                                           return fmt::format("{},{:.9f}\n", n / rate, value(n) / gravity);
                                       }),
                 Result::read, "", {}, is_tone_in("g", level / std::sqrt(2.0) / gravity)),
        log_case("accelerations in Gal", "time_s,ax [Gal]\n" + rows([](int n) {
                                             return fmt::format("{},{:.7f}\n", n / rate, 100.0 * value(n));
                                         }),
                 Result::read, "", {}, is_tone_in("Gal", 100.0 * level / std::sqrt(2.0))),
        log_case("a unit that is not known", "time_s,ax [furlong]\n" + rows(numbers(1.0)), Result::note,
                 "'furlong' in the name 'ax [furlong]' is no known unit"),
    };
}

}  // namespace

Table log_table() {
    Table table{"logs",
                {{"form", {}, {}, {}, shapes()}, {"time", {}, {}, {}, clocks()}, {"programs", {}, {}, {}, programs()}}};
    for (Format& format : table.formats) {
        format.verb = {"spectrum", "FILE", "--json"};
        format.notes = log_notes;
        format.check = is_tone();
    }
    return table;
}

}  // namespace tactus::conformance
