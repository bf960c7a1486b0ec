// SPDX-License-Identifier: Apache-2.0
#include "tools/command/vibration/record_options.hpp"

namespace tactus::command {

study::RecordSettings RecordChoice::settings() const {
    study::RecordSettings all = record;
    all.stretch = stretch_of(stretch);
    return all;
}

void add_record_options(VerbOptions& verb, RecordChoice& choice, const char* files) {
    verb.add("files", choice.files, files).required();
    verb.add("--calibration,--full-scale", choice.record.calibration,
             "quantity of a value of 1 (sound: full scale), such as \"49 m/s^2\"");
    verb.add("--channel", choice.record.channels, "channels to analyse, from 1").separated_by(',').one_each();
    verb.add("--time-column", choice.record.log.time_column, "time column of a CSV log: name or number");
    verb.add("--column", choice.record.log.columns, "columns of a CSV log to analyse: names or numbers")
        .separated_by(',')
        .one_each();
    verb.add("--time-unit", choice.record.log.time_unit, "unit of time in a CSV log: s, ms, us or ns")
        .one_of({"s", "ms", "us", "ns"});
    add_stretch_options(verb, choice.stretch);
    verb.flag("--json", choice.json, "as JSON");
}

}  // namespace tactus::command
