// SPDX-License-Identifier: Apache-2.0
// Logs in the manner of data loggers, oscilloscopes, telephones and microcontrollers.
#include "assets/table/sample_log.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

table::SampleLog read_logger(std::string_view text, table::LogSelection selection = {}) {
    return table::read_sample_log(text, "l.csv", selection);
}

std::string unit_of(const table::SampleLog& log, std::size_t column) {
    return log.units[column] ? log.units[column]->text : "none";
}

std::vector<std::string> sensitivities_of(const table::SampleLog& log) {
    std::vector<std::string> texts;
    for (const table::StatedSensitivity& one : log.sensitivities.of_columns) texts.push_back(one.text);
    return texts;
}

}  // namespace

TEST_CASE("lines above the header are skipped, a row of units below it is read") {
    const table::SampleLog log = read_logger(
        "Data logger 7,serial 0815\nStart time,2024-05-17\nSample rate,1000,Hz\n\n"
        "Time,ax,ay\ns,g,g\n0,0.5,1\n0.001,0.25,2\n0.002,0.125,3\n0.003,0,4\n");
    CHECK(log.form.header_line == 5);
    CHECK(log.form.units_line == 6);
    CHECK(log.form.first_row == 7);
    CHECK(log.form.skipped == 3);
    CHECK(log.names == std::vector<std::string>{"ax", "ay"});
    CHECK(unit_of(log, 1) == "g");
    CHECK(log.units[0]->si == Approx(9.80665));
    CHECK(log.columns[0] == std::vector{0.5, 0.25, 0.125, 0.0});
    CHECK(log.form.is_time_unit_stated);
}

TEST_CASE("rows to skip can be stated, where the guess would be wrong") {
    const std::string_view text = "1,2,3\n4,5,6\nt_ms,a,b\n0,7,70\n1,8,80\n";
    table::LogSelection selection;
    selection.columns = {"a"};
    selection.skip_rows = 2;
    const table::SampleLog log = read_logger(text, selection);
    CHECK(log.columns[0] == std::vector{7.0, 8.0});
    CHECK(log.times == std::vector{0.0, 0.001});
    CHECK(log.form.skipped == 2);
    selection.columns = {"c"};
    CHECK_THROWS_WITH(read_logger(text, selection),
                      ContainsSubstring("l.csv:3:1") && ContainsSubstring("there are t_ms, a, b"));
}

TEST_CASE("tabs with decimal commas, a mark at the start, CR LF and quotes are read") {
    const table::SampleLog log =
        read_logger("\xef\xbb\xbf\"Zeit [s]\"\t\"a_x [m/s\xc2\xb2]\"\r\n0,000\t1,5\r\n0,001\t-2,25\r\n");
    CHECK(log.names == std::vector<std::string>{"a_x"});
    CHECK(unit_of(log, 0) == "m/s²");
    CHECK(log.columns[0] == std::vector{1.5, -2.25});
    CHECK(log.form.decimal == ',');
    CHECK(log.form.separator == '\t');
    CHECK_THAT(table::describe(log.form), ContainsSubstring("tab-separated, decimal comma, names in line 1"));
    // Latin-1, as older Windows programs write it.
    CHECK(unit_of(read_logger("t;a [m/s\xb2]\n0;1,5\n1;2,5\n"), 0) == "m/s²");
    // UTF-16, as spreadsheets export it.
    std::string wide = "\xff\xfe";
    for (const char c : std::string_view("t\ta\n0\t1.5\n1\t2.5\n")) wide += {c, '\0'};
    CHECK(read_logger(wide).columns[0] == std::vector{1.5, 2.5});
    // Lines that end with CR alone; a file that states its separator.
    CHECK(read_logger("t,a\r0,1\r1,2\r").columns[0] == std::vector{1.0, 2.0});
    CHECK(read_logger("sep=;\nt;a\n0;1,5\n1;2,5\n").columns[0] == std::vector{1.5, 2.5});
}

TEST_CASE("times are read as ISO 8601, with fraction and zone") {
    const table::SampleLog log = read_logger(
        "timestamp,a\n2024-05-17T23:59:59.998Z,1\n2024-05-17T23:59:59.999Z,2\n2024-05-18T00:00:00.000Z,3\n");
    CHECK(log.times[1] - log.times[0] == Approx(0.001).epsilon(1e-6));
    CHECK(log.times[2] - log.times[0] == Approx(0.002).epsilon(1e-6));
    CHECK_THAT(log.form.time, ContainsSubstring("dates and times"));
    // Summer time ends: the zone makes the step.
    const table::SampleLog zones = read_logger("when,a\n2024-10-27 02:59:59.9+02:00,1\n2024-10-27 02:00:00.0+01:00,2\n",
                                               {.time_column = {}, .columns = {"a"}, .time_unit = {}});
    CHECK(zones.times.size() == 2);
}

TEST_CASE("times of day are read and go on at midnight") {
    const table::SampleLog log = read_logger("time;ax\n23:59:59,998;1\n23:59:59,999;2\n00:00:00,000;3\n");
    CHECK(log.times[2] - log.times[0] == Approx(0.002).epsilon(1e-6));
    CHECK(read_logger("time,a\n14:03:07:250,1\n14:03:07:255,2\n").times[1] - 50587.25 == Approx(0.005).epsilon(1e-6));
    CHECK(read_logger("time,a\n59:59.9,1\n00:00.1,2\n").times[1] == Approx(3600.1));
    CHECK(read_logger("Date,Time,a\n5/17/2024,11:59:59.5 PM,1\n5/18/2024,12:00:00.5 AM,2\n").times[1] ==
          Approx(86400.5));
    CHECK_THROWS_WITH(read_logger("time,a\n10:00:02,1\n10:00:01,2\n"),
                      ContainsSubstring("l.csv:3:1") && ContainsSubstring("backwards"));
    CHECK_THROWS_WITH(read_logger("time,a\n10:00:02,1\nsoon,2\n10:00:03,3\n"),
                      ContainsSubstring("l.csv:3") && ContainsSubstring("is not a time"));
    CHECK_THROWS_WITH(read_logger("date,a\n5/4/2024 10:00:00,1\n5/5/2024 10:00:01,2\n"),
                      ContainsSubstring("days or months"));
}

TEST_CASE("a clock that is set in the middle of a log is one clear error") {
    CHECK_THROWS_WITH(read_logger("t_s,a\n0,1\n0.01,2\n1700000000,3\n1700000000.01,4\n"),
                      ContainsSubstring("l.csv:4:1") && ContainsSubstring("more than a day"));
}

TEST_CASE("a stated rate takes the place of times, lost rows keep their place") {
    table::LogSelection selection;
    selection.rate = 3200.0;
    const table::SampleLog log = read_logger("a\n1\n2\nnan\n4\n", selection);
    CHECK(log.times == std::vector{0.0, 1.0 / 3200.0, 3.0 / 3200.0});
    CHECK(log.lost_rows == 1);
    CHECK(log.form.separator == '\0');
    CHECK(read_logger("0.5\n-1.5\n", selection).columns[0] == std::vector{0.5, -1.5});
    CHECK(read_logger("sample,ax,ay\n0,5,6\n1,7,8\n", selection).names == std::vector<std::string>{"ax", "ay"});
    selection.time_column = std::string("t");
    CHECK_THROWS_WITH(read_logger("t,a\n0,1\n1,2\n", selection), ContainsSubstring("state one of them"));
    selection = {};
    selection.rate = 0.0;
    CHECK_THROWS_WITH(read_logger("a\n1\n2\n", selection), ContainsSubstring("above 0"));
}

TEST_CASE("one column with decimal commas is not taken for two columns") {
    table::LogSelection selection;
    selection.rate = 1000.0;
    const table::SampleLog log = read_logger("accel [g]\n0,5\n-0,25\n1,5\n", selection);
    REQUIRE(log.columns.size() == 1);
    CHECK(log.columns[0] == std::vector{0.5, -0.25, 1.5});
    CHECK(unit_of(log, 0) == "g");
    // Two names fewer than fields: nobody knows which comma is decimal.
    CHECK_THROWS_WITH(read_logger("t,a\n0,5,1,25\n0,6,1,5\n"),
                      ContainsSubstring("l.csv:1") && ContainsSubstring("decimal commas"));
}

TEST_CASE("blanks separate fields, also of aligned columns") {
    const table::SampleLog log =
        read_logger("# made by a script\nTime (s)   Acc (g)\n  0.000    1.5e-1\n  0.001   -2.5e-1\n");
    CHECK(log.names == std::vector<std::string>{"Acc"});
    CHECK(unit_of(log, 0) == "g");
    CHECK(log.columns[0] == std::vector{0.15, -0.25});
    // numpy.savetxt writes the names as a comment.
    CHECK(read_logger("# t_s a\n0 5\n0.5 6\n").times == std::vector{0.0, 0.5});
}

TEST_CASE("units and names are told apart") {
    const auto name = [](const char* header) {
        const table::NamedColumn named = table::parse_column_name(header);
        return named.name + "|" + (named.unit ? named.unit->text : "none");
    };
    CHECK(name("ax [g]") == "ax|g");
    CHECK(name("Acceleration (m/s²)") == "Acceleration|m/s²");
    CHECK(name("Linear Acceleration x (m/s^2)") == "Linear Acceleration x|m/s^2");
    CHECK(name("accel_x_mV") == "accel_x_mV|mV");
    CHECK(name("timestamp_ms") == "timestamp_ms|ms");
    CHECK(name("Time / s") == "Time|s");
    CHECK(name("a in m/s2") == "a|m/s2");
    CHECK(name("t/s") == "t|s");
    CHECK(name("a/(m/s²)") == "a|m/s²");
    CHECK(name("Velocity m/s") == "Velocity|m/s");
    CHECK(name("Acceleration m/s^2") == "Acceleration|m/s^2");
    CHECK(name("Gyro deg/s").find("|s") == std::string::npos);
    CHECK(name("Force N/mm").find("|mm") == std::string::npos);
    CHECK(name("m/s^2") == "m/s^2|none");
    CHECK(name("left/right") == "left/right|none");
    CHECK(name("AI 1 (Channel 3)") == "AI 1 (Channel 3)|none");
    CHECK(name("flag") == "flag|none");
    CHECK(table::parse_column_unit("mg")->si == Approx(9.80665e-3));
    CHECK(table::parse_column_unit("Volts")->is_voltage());
    CHECK(table::parse_column_unit("m/s2")->is_acceleration());
    CHECK_FALSE(table::parse_column_unit("kg"));
    for (const char* const text : {"m·s⁻²", "m s⁻²", "m.s-2", "m*s^-2"}) {
        CAPTURE(text);
        CHECK(table::parse_column_unit(text)->si == Approx(1.0));
    }
    CHECK(table::parse_column_unit("Gal")->si == Approx(0.01));
    CHECK(table::parse_column_unit("in/s²")->si == Approx(0.0254));
    CHECK(table::parse_column_unit("ft/s2")->si == Approx(0.3048));
    CHECK(table::parse_column_unit("milli-g")->si == Approx(9.80665e-3));
    CHECK(table::axis_family("gFz") == "gf");
    CHECK(table::axis_family("Linear Acceleration y") == "linear acceleration");
    CHECK_FALSE(table::axis_family("index"));
}

TEST_CASE("of several sensors the accelerometer is chosen") {
    const table::SampleLog log = read_logger("time,gx,gy,gz,ax,ay,az\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n");
    CHECK(log.names == std::vector<std::string>{"ax", "ay", "az"});
    const table::SampleLog volts =
        read_logger("Time,Channel A,Channel B\n(ms),(mV),(mV)\n\n0,1.5,2\n1,1.25,3\n2,1,4\n");
    CHECK(volts.names == std::vector<std::string>{"Channel A", "Channel B"});
    CHECK(unit_of(volts, 0) == "mV");
    CHECK(volts.times[1] == Approx(1e-3));
}

TEST_CASE("all of numbered channels are read, row numbers are none, and a question names the columns to choose from") {
    const auto names = [](const char* text) { return read_logger(text).names; };
    CHECK(names("Time [s],Channel 0,Channel 1\n0,1,2\n0.1,2,3\n") ==
          std::vector<std::string>{"Channel 0", "Channel 1"});
    CHECK(names("Sample Number,t_s,Analog 0 (V),Analog 1 (V)\n7,0,1,2\n8,0.1,2,3\n") ==
          std::vector<std::string>{"Analog 0", "Analog 1"});
    CHECK(names("Name,Time,Acc X\nUnit,s,m/s²\n,0,1\n,0.1,2\n") == std::vector<std::string>{"Acc X"});
    CHECK_THROWS_WITH(read_logger("t_s,one,two\n0,1,2\n0.1,2,3\n"),
                      ContainsSubstring("as --column 2,3; there are t_s"));
    CHECK_THROWS_WITH(read_logger("0,1,2,3\n0.1,2,3,4\n"), ContainsSubstring("as --column 2,3,4; there are 1"));
}

TEST_CASE("a header that does not fit its rows is refused, and a restart of the logger said") {
    CHECK_THROWS_WITH(read_logger("t,a\n0,1,2\n1,2,3\n"), ContainsSubstring("2 names and the rows have 3 fields"));
    CHECK_THROWS_WITH(read_logger("t,a\n0,1\n1,2\n2,3\n3,4\nt,a\n0,1\n"),
                      ContainsSubstring("l.csv:6") && ContainsSubstring("restarted"));
    CHECK(read_logger("t,a,\n0,1,\n1,2,\n").columns[0] == std::vector{1.0, 2.0});
}

TEST_CASE("a bad cell in the middle is an error, not the end of a header") {
    std::string text = "t,a\n";
    for (int i = 0; i < 50; ++i) text += std::to_string(i) + (i == 20 ? ",sensor error\n" : ",5\n");
    CHECK_THROWS_WITH(read_logger(text), ContainsSubstring("l.csv:22:2") && ContainsSubstring("'sensor error'"));
}

TEST_CASE("the files of measurement programs, oscilloscopes and serial monitors are read") {
    table::SampleLog log = read_logger(
        "LabVIEW Measurement\t\nDate\t2024/05/17\nTime\t10:15:57.12\n***End_of_Header***\t\n\t\nChannels\t2\t\t\n"
        "Samples\t3\t3\t\nX0\t0.0E+0\t0.0E+0\t\nDelta_X\t0.0005\t0.0005\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tAcceleration_0\tAcceleration_1\tComment\n0.0000\t1.5\t2\n0.0005\t2.5\t3\n0.0010\t3.5\t4\n"
        "0.0015\t4.5\t5\n0.0020\t5.5\t6\n");
    CHECK(log.names == std::vector<std::string>{"Acceleration_0", "Acceleration_1"});
    CHECK(log.times[1] == Approx(0.0005));
    CHECK(log.times.size() == 5);

    log = read_logger("Record Length,2.5e+03,,-0.0010,0.5,\nSample Interval,1e-05,,-0.0009,0.25,\n" + [] {
        std::string rows;
        for (int i = 0; i < 40; ++i) rows += ",,," + std::to_string(0.0001 * i) + ",0.125,\n";
        return rows;
    }());
    CHECK(log.times.size() == 42);
    CHECK(log.columns[0][1] == 0.25);

    table::LogSelection scope;
    scope.columns.emplace_back("CH1");
    scope.rate = 1e5;
    log = read_logger("X,CH1,Start,Increment,\nSequence,Volt,-6.0e-02,1.0e-05\n0,1.5,,\n1,2.5,,\n2,3.5,,\n", scope);
    CHECK(log.columns[0] == std::vector{1.5, 2.5, 3.5});
    CHECK(log.units[0]->is_voltage());

    scope.columns = {"2"};
    scope.rate.reset();
    log = read_logger(
        "MPU6050 ready\n12:34:00.000 -> 306,-2,16384\n12:34:00.010 -> 307,-3,16384\n12:34:00.020 -> 308,-4,1\n", scope);
    CHECK(log.columns[0] == std::vector{306.0, 307.0, 308.0});
    CHECK(log.times[1] - log.times[0] == Approx(0.01));

    log = read_logger(";SampleRate, 200,Hz\n;Headers, time,Ax,Ay,Az\n0.000,1,2,3\n0.005,4,5,6\n");
    CHECK(log.names == std::vector<std::string>{"Ax", "Ay", "Az"});
    log = read_logger("x-axis,1\nsecond,Volt\n0,0.5\n1e-5,0.25\n");
    CHECK(log.units[0]->is_voltage());
    CHECK(log.times[1] == 1e-5);
}

TEST_CASE("a rate that stands above the rows is used without times, and decides their unit") {
    using namespace std::string_literals;
    for (const std::string& line :
         {"# sample rate: 1.6 kHz"s, "Sampling frequency [Hz]: 1600"s, "% fs ; samplerate = 1600"s,
          "# Sample Interval: 0.625 ms"s, "# Abtastrate 1600 Hz"s}) {
        CAPTURE(line);
        const table::SampleLog log = read_logger(line + "\nax\n1.5\n2.5\n3.5\n");
        CHECK(log.times[1] == Approx(1.0 / 1600.0));
        CHECK_THAT(table::describe(log.form), ContainsSubstring("1600 Hz, as line 1 states"));
    }
    CHECK(read_logger("# sample rate: 50000 Hz\nt,ax\n0.02,1\n0.04,2\n0.06,3\n").times[0] == Approx(2e-5));
    CHECK(read_logger("# sample rate: 50 Hz\nt,ax\n0.02,1\n0.04,2\n0.06,3\n").times[0] == Approx(0.02));
}

TEST_CASE("a table of several sensors is refused with their names, or read for one of them") {
    std::string text = "time_ms,SENSOR,ax\n", blocks = text, words = "time_ms,kind of,ax\n";
    for (int i = 0; i < 40; ++i) text += std::to_string(i) + (i % 2 == 0 ? ",1," : ",2,") + std::to_string(i) + "\n";
    for (int i = 0; i < 40; ++i)
        blocks += std::to_string(i % 20) + (i < 20 ? ",left," : ",right,") + std::to_string(i) + "\n";
    for (int i = 0; i < 40; ++i)
        words += std::to_string(i) + (i % 2 == 0 ? ",acc," : ",gyr,") + std::to_string(i) + "\n";
    CHECK_THROWS_WITH(read_logger(text), ContainsSubstring("l.csv:1:2") && ContainsSubstring("2 sensors") &&
                                             ContainsSubstring("1 (20 rows), 2 (20 rows)") &&
                                             ContainsSubstring("--where \"SENSOR=1\""));
    CHECK_THROWS_WITH(read_logger(blocks), ContainsSubstring("left") && ContainsSubstring("--where"));
    CHECK_THROWS_WITH(read_logger(words), ContainsSubstring("--where \"kind of=acc\""));
    table::LogSelection selection;
    selection.where = "SENSOR=2";
    const table::SampleLog log = read_logger(text, selection);
    CHECK(log.times.size() == 20);
    CHECK(log.columns[0][1] == 3.0);
    CHECK(log.times[1] - log.times[0] == Approx(2e-3));
    selection.where = "SENSOR=right";
    CHECK(read_logger(blocks, selection).columns[0].front() == 20.0);
    selection.where = "SENSOR";
    CHECK_THROWS_WITH(read_logger(text, selection), ContainsSubstring("COLUMN=VALUE"));
    selection.where = "SENSR=2";
    CHECK_THROWS_WITH(read_logger(text, selection), ContainsSubstring("did you mean 'SENSOR'"));
    // A status that changes now and then is no sensor.
    std::string status = "t_ms,status,ax\n";
    for (int i = 0; i < 40; ++i) status += std::to_string(i) + (i < 30 ? ",ok," : ",warm,") + std::to_string(i) + "\n";
    CHECK(read_logger(status).times.size() == 40);
}

TEST_CASE("columns follow the clock to their left, clocks of different rates are refused together") {
    std::string text = "t1_ms,acc [g],t2_ms,vel [mm/s]\n", same = text;
    for (int i = 0; i < 40; ++i) {
        text += fmt::format("{},{},{},{}\n", i, i, 2.5 * i, 2 * i);
        same += fmt::format("{},{},{},{}\n", i, i, i + 0.25, 2 * i);
    }
    table::LogSelection selection;
    selection.columns = {"acc", "vel"};
    CHECK_THROWS_WITH(read_logger(text, selection),
                      ContainsSubstring("different rates: t1_ms, t2_ms") && ContainsSubstring("--time-column"));
    CHECK(read_logger(same, selection).times[1] == Approx(1e-3));
    selection.columns = {"vel"};
    CHECK(read_logger(text, selection).times[1] == Approx(2.5e-3));
    selection.columns = {"acc"};
    CHECK(read_logger(text, selection).times[1] == Approx(1e-3));
    CHECK(read_logger(text).names == std::vector<std::string>{"acc"});
    selection.time_column = "t1_ms";
    selection.columns = {"acc", "vel"};
    CHECK(read_logger(text, selection).times[1] == Approx(1e-3));
}

TEST_CASE(
    "units, rates and sensitivities in the headers of scopes and programs, and statistics below rows, are understood") {
    table::SampleLog log =
        read_logger("X,CH1,Start,Increment,\nSequence,Volt,-6.0e-02,1.0e-05\n0,1.5,,\n1,2.5,,\n2,3.5,,\n");
    CHECK(log.names == std::vector<std::string>{"CH1"});
    CHECK(log.times[1] == Approx(1e-5));
    CHECK_THAT(log.form.time, ContainsSubstring("100000 Hz, as line 2 states"));
    log = read_logger("# sensitivity: 100 mV/g\nt_s,a [mV]\n0,1\n0.001,2\n0.002,3\n");
    CHECK(sensitivities_of(log) == std::vector<std::string>{"100 mV/g"});
    log = read_logger(
        "LabVIEW Measurement\t\nY_Unit_Label\tg\tV\t\nDelta_X\t0.0005\t0.0005\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tAcceleration\tVoltage\tComment\n0.0000\t1.5\t2\n0.0005\t2.5\t3\n0.0010\t3.5\t4\n0.0015\t4.5\t5\n",
        {.time_column = {}, .columns = {"Acceleration"}, .time_unit = {}});
    CHECK(unit_of(log, 0) == "g");
    std::string text = "t_s,a\n";
    for (int i = 0; i < 50; ++i) text += fmt::format("{},{}\n", 0.001 * i, i);
    log = read_logger(text + "\nMean,24.5\nMax:,49\nStd. dev.,14.4\n");
    CHECK(log.times.size() == 50);
    CHECK(log.form.trailer == 3);
    CHECK_THAT(table::describe(log.form), ContainsSubstring("3 lines of statistics"));
}

TEST_CASE("labels of a sound are refused as such, and tables of their form are read") {
    const std::string_view labels[] = {
        "0.000000\t1.250000\tcutting\n1.250000\t3.400000\tfree air\n4.000000\t5.250000\ta -> b\n",
        "0.000000\t1.250000\tcutting\r\n\\\t100.0\t2000.0\r\n1.000000\t3.400000\tall\r\n\\\t1.0\t2000.0\r\n",
        "0,000000\t1,250000\tcutting\n1,250000\t3,400000\t1\n",
        "0.500000\t1.000000\t1\n1.500000\t2.000000\t2\n2.500000\t3.000000\t3\n3.500000\t4.000000\t4\n",
        "0.500000\t0.500000\t\n1.500000\t1.500000\t\n2.500000\t2.500000\t\n",
        "0.500000\t9.500000\tcut\n",
    };
    for (const std::string_view text : labels) {
        CAPTURE(text);
        CHECK_THROWS_WITH(read_logger(text), ContainsSubstring("labels of a sound") && ContainsSubstring("--from"));
    }
    // Whoever names columns means them.
    CHECK(read_logger(labels[3], {.time_column = "1", .columns = {"2"}, .time_unit = "s"}).times.size() == 4);
    std::string resting, moving;
    for (int i = 0; i < 40; ++i) {
        resting += fmt::format("{:.6f}\t9.810000\tok\n", 0.01 * i);
        moving += fmt::format("{:.6f}\t{:.6f}\t{}\n", 0.01 * i, 0.01 * i + 0.02 * (i % 3), i % 7);
    }
    CHECK(read_logger(resting, {.time_column = {}, .columns = {}, .time_unit = "s"}).times.size() == 40);
    CHECK_THROWS_WITH(read_logger(moving), ContainsSubstring("--column"));
}

TEST_CASE("capitals in headers, odd words for no number and columns of one name are understood") {
    const table::SampleLog capitals = read_logger("TIME (MS),ACC X (M/S^2),ACC Y (MM/S^2)\n0,1,2\n1,3,4\n2,5,6\n");
    CHECK(capitals.times[1] == Approx(1e-3));
    CHECK(capitals.units[0]->si == 1.0);
    CHECK(capitals.units[1]->si == Approx(1e-3));
    CHECK(read_logger("tImE_mS;aCcEl_X [G]\n0;1\n1;2\n2;3\n").times[1] == Approx(1e-3));
    std::string text = "time_s,ax\n";
    for (const char* word : {"1.5", "1.#QNAN", "-1.#IND", "1.#INF", "-nan(ind)", "#DIV/0!", "#N/A", "inf", "2.5"})
        text += fmt::format("{},{}\n", 0.001 * static_cast<double>(text.size()), word);
    const table::SampleLog lost = read_logger(text);
    CHECK(lost.columns[0] == std::vector{1.5, 2.5});
    CHECK(lost.lost_rows == 7);
    const std::string_view twice = "time_s,ax,ax\n0,1,2\n0.001,3,4\n0.002,5,6\n";
    CHECK(read_logger(twice).names == std::vector<std::string>{"ax (column 2)", "ax (column 3)"});
    CHECK_THROWS_WITH(read_logger(twice, {.time_column = {}, .columns = {"ax"}, .time_unit = {}}),
                      ContainsSubstring("several columns 'ax'"));
    CHECK(read_logger(twice, {.time_column = {}, .columns = {"3"}, .time_unit = {}}).columns[0] ==
          std::vector{2.0, 4.0, 6.0});
}

TEST_CASE("a number beyond the columns is refused, a word or a separator there is not") {
    const std::string rows = "time_s,ax\n0.000,1.5\n0.001,2.5\n0.002,3.5\n0.003,4.5\n";
    CHECK_THROWS_WITH(read_logger(rows + "0.004,5,5\n0.005,6.5\n"),
                      ContainsSubstring("l.csv:6:1") && ContainsSubstring("are commas decimal"));
    CHECK(read_logger(rows + "0.004,5.5,\n0.005,6.5,hit\n").columns[0].size() == 6);
}

TEST_CASE("each column has the sensitivity that the header states for it") {
    const auto stated = [](const std::string& header, std::string_view names, table::LogSelection selection = {}) {
        const std::string row = names.ends_with("z (mV)") ? ",1,2,3\n" : ",1,2\n";
        return read_logger(header + "\n" + std::string(names) + "\n0" + row + "0.001" + row + "0.002" + row, selection);
    };
    constexpr std::string_view axes = "t (s),ax (mV),ay (mV),az (mV)", two = "t (s),a1 (mV),a2 (mV)";
    const std::vector<std::string> of_two{"100 mV/g", "10 mV/g"}, of_axes{"100 mV/g", "10 mV/g", "10 mV/g"};
    for (const char* const header :
         {"# x sensitivity: 100 mV/g\n# y sensitivity: 10 mV/g\n# z sensitivity: 10 mV/g",
          "# Sensitivity ax = 100 mV/g\n# Sensitivity ay = 10 mV/g\n# Sensitivity az = 10 mV/g",
          "# sensitivity: x = 100 mV/g, y = 10 mV/g, z = 10 mV/g", "# sensitivity: 100 mV/g; 10 mV/g; 10 mV/g",
          "# sensitivity: 10 mV/g\n# sensitivity of the x axis: 100 mV/g",
          "# channel 1 sensitivity: 100 mV/g\n# channel 2 sensitivity: 10 mV/g\n# channel 3 sensitivity: 10 mV/g"}) {
        CAPTURE(header);
        CHECK(sensitivities_of(stated(header, axes)) == of_axes);
    }
    for (const char* const header :
         {"Sensitivity,100 mV/g,10 mV/g", "Sensitivity,,100 mV/g,10 mV/g", "Sensitivity (mV/g),100,10",
          "Sensitivity,100,mV/g,10,mV/g", "# channel 1 sensitivity: 100 mV/g\n# channel 2 sensitivity: 10 mV/g",
          "# a2 sensitivity: 10 mV/g\n# a1 sensitivity: 100 mV/g", "# sensitivity: 100 mV/g 10 mV/g",
          "Sensitivity CH1,100 mV/g\nSensitivity CH2,10 mV/g"}) {
        CAPTURE(header);
        CHECK(sensitivities_of(stated(header, two)) == of_two);
    }
    CHECK(sensitivities_of(
              stated("Sensitivity,100 mV/g,10 mV/g", two, {.time_column = {}, .columns = {"a2"}, .time_unit = {}})) ==
          std::vector<std::string>{"10 mV/g"});
    for (const char* const header :
         {"# sensitivity (nominal): 100 mV/g, 5 %", "# Sensor: PCB 352C33, sensitivity 100 mV/g, S/N 12345",
          "# Sensitivity: 100 mV/g, calibrated 2026-03-12", "# Sensitivity: 100 mV/g; serial 12345",
          "# Sensitivity: 100 mV/g; 12345", "# Sensitivity: 100 mV/g, 2026-03-12"}) {
        CAPTURE(header);
        CHECK(sensitivities_of(stated(header, two)) == std::vector<std::string>{"100 mV/g", "100 mV/g"});
    }
    for (const char* const header :
         {"# sensitivity: 100 mV/g\n# sensitivity: 10 mV/g",
          "# left sensitivity: 100 mV/g\n# right sensitivity: 10 mV/g", "# sensitivity: 100 mV/g, 10 mV/g, 20 mV/g"}) {
        CAPTURE(header);
        const table::SampleLog log = stated(header, two);
        CHECK(log.sensitivities.of_columns.empty());
        CHECK_THAT(log.sensitivities.doubt, ContainsSubstring("line") && ContainsSubstring("100 mV/g, 10 mV/g") &&
                                                ContainsSubstring("--sensitivity"));
    }
    CHECK_THAT(stated("# x sensitivity: 100 mV/g\n# y sensitivity: 10 mV/g", axes).sensitivities.doubt,
               ContainsSubstring("lines 1, 2") && ContainsSubstring("'az'"));
}

TEST_CASE("a stated rate is read with its unit wherever that stands, or refused with its line") {
    const auto rate = [](const std::string& header, char separator = ',') {
        const std::string rows = separator == ',' ? "\n1.5,1\n2.5,2\n3.5,3\n" : "\n1,5;1\n2,5;2\n3,5;3\n";
        const table::SampleLog log = read_logger(header + "\nax (g)" + separator + "ay (g)" + rows);
        return 1.0 / log.times[1];
    };
    for (const char* const header : {"Sampling rate (kHz): 25.6",
                                     "# Sample interval: 39.0625 \xc2\xb5s",
                                     "# Sample interval: 39.0625 \xb5s",
                                     "# Sample interval (ms): 0.0390625",
                                     "# Sample interval: 39062.5 ns",
                                     "Sample rate,25600,25600",
                                     "Sample rate,25600,Hz,Channels,2",
                                     "Sample rate [kHz],25.6,25.6",
                                     "# sampling rate of channel 2: 25.6 kHz",
                                     "# sample_rate_hz = 25600",
                                     "# sample rate: 25600 samples per second",
                                     "# sample rate 25.6 kS/s, 16 bit",
                                     "# sampling frequency: 25600 (Hz)",
                                     "# sample rate: 25600 Hz\n# sample interval: 39.06 us",
                                     "# sample rate: 25,600 Hz\n# sample interval: 39.0625 us",
                                     "# Sample rate: 25600 S/s/ch",
                                     "# Sample rate: 25600 (nominal)",
                                     "# Sample rate: 25600 samples per sec",
                                     "# Sample rate: 25600 Hz/channel",
                                     "# Sample rate: 25600 nominal",
                                     "# Sample rate: 25600 Hz\n# Sample period jitter: 5 us",
                                     "# Sample rate: 25600 Hz\n# Sampling rate divider: 2"}) {
        CAPTURE(header);
        CHECK(rate(header) == Approx(25600.0).margin(0.01));
    }
    CHECK(rate("Abtastrate: 25600,5 Hz", ';') == Approx(25600.5));
    CHECK(rate("Abtastrate;25,6;kHz", ';') == Approx(25600.0));
    CHECK(rate("Delta_X\t0,000500\t0,000500", ';') == Approx(2000.0));
    for (const char* const header :
         {"# Sample rate: 25,600 Hz", "# sample rate: 1,025,600 Hz", "# sample rate: 25600 rpm",
          "Sample rate,25600,12800", "# sample interval: 39.0625", "# sample rate: 25600 Hz\n# sample rate: 800 Hz"}) {
        CAPTURE(header);
        CHECK_THROWS_WITH(rate(header), ContainsSubstring("l.csv:") && ContainsSubstring("sample rate in this line") &&
                                            ContainsSubstring("--sample-rate"));
    }
    CHECK_THROWS_WITH(rate("Abtastrate: 25.600 Hz", ';'),
                      ContainsSubstring("l.csv:1") && ContainsSubstring("'25.600'"));
    // A line that is not clear does not matter to a file with times.
    CHECK(read_logger("# sample rate: 25,600 Hz\nt_s,ax\n0,1\n0.5,2\n").times[1] == 0.5);
    // The step in a scope's row of units may have a decimal comma.
    CHECK(read_logger("X;CH1;Start;Increment\nSequence;Volt;-6,0e-02;1,0e-05\n0;1,5;;\n1;2,5;;\n2;3,5;;\n").times[1] ==
          Approx(1e-5));
}
