// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/record_options.hpp"

namespace tactus::command {

analysis::RecordSettings RecordChoice::settings() const {
    analysis::RecordSettings all = record;
    all.stretch = stretch_of(stretch);
    return all;
}

void add_record_options(VerbOptions& verb, RecordChoice& choice, const char* files, const char* rate) {
    verb.add("files", choice.files, files).required();
    verb.add("--calibration,--full-scale", choice.record.calibration,
             "quantity of a value of 1 (sound: full scale), such as \"49 m/s^2\"");
    verb.add(
        "--sensitivity", choice.record.sensitivity,
        "of the sensor whose volts were recorded, such as \"100 mV/g\"; the volts are in the header or --calibration");
    verb.add("--channel", choice.record.channels, "channels to analyse, from 1").separated_by(',').one_each();
    verb.add("--time-column", choice.record.log.time_column, "time column of a CSV log: name or number");
    verb.add("--column", choice.record.log.columns,
             "columns of a CSV log to analyse: names or numbers, separated by commas; a name that contains a comma is "
             "stated alone or in double quotes")
        .one_each();
    verb.add("--time-unit", choice.record.log.time_unit, "unit of time in a CSV log: s, ms, us or ns")
        .one_of({"s", "ms", "us", "ns"});
    verb.add("--where", choice.record.log.where,
             "of a CSV log only the rows with this value, such as SENSOR=2, for tables with several sensors");
    verb.add("--skip-rows", choice.record.log.skip_rows, "lines before the header of a CSV log (default: found)")
        .range(0, 1 << 30);
    verb.add(rate, choice.record.log.rate, "rate of a CSV log without times, such as \"3.2 kHz\"")
        .unit("Hz")
        .range(1e-6, 1e9);
    add_stretch_options(verb, choice.stretch);
}

}  // namespace tactus::command
