// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis_options.hpp"

#include <CLI/CLI.hpp>

namespace tactus {

namespace {

void add_record_options(CLI::App& verb, RecordOptions& options, const char* files) {
    verb.add_option("files", options.files, files)->required();
    verb.add_option("--calibration,--full-scale", options.calibration,
                    "what a value of 1 (sound: full scale) is worth, such as \"49 m/s^2\"");
    verb.add_option("--channel", options.channels, "only these, from 1")->delimiter(',')->allow_extra_args(false);
    verb.add_option("--time-column", options.log.time_column, "of a CSV log: name or number");
    verb.add_option("--column", options.log.columns, "of a CSV log: names or numbers of what to analyse")
        ->delimiter(',')
        ->allow_extra_args(false);
    verb.add_option("--time-unit", options.log.time_unit, "of a CSV log: s, ms, us or ns")
        ->check(CLI::IsMember({"s", "ms", "us", "ns"}));
    verb.add_flag("--json", options.json, "as JSON");
}

void add_spectrum(CLI::App& app, SpectrumChoice& choice) {
    CLI::App* verb = app.add_subcommand(
        "spectrum", "what vibrates in a record: spectrum, fundamental, harmonics, hum, bands, envelope");
    add_record_options(*verb, choice, "sound files, CSV logs, or folders of them");
    verb->add_option("--window", choice.window, "of the spectrum")
        ->capture_default_str()
        ->check(CLI::IsMember({"hann", "hamming", "blackman", "blackmanharris", "flattop", "boxcar"}));
    verb->add_option("--segment", choice.segment, "samples (default: about 0.75 s)")->check(CLI::Range(2, 1 << 26));
    verb->add_option("--overlap", choice.overlap, "share of a segment (default 0.5)")->check(CLI::Range(0.0, 0.99));
    verb->add_option("--detrend", choice.detrend, "what is taken out of each segment")
        ->capture_default_str()
        ->check(CLI::IsMember({"none", "constant", "linear"}));
    verb->add_option("--average", choice.average, "over segments")
        ->capture_default_str()
        ->check(CLI::IsMember({"mean", "median", "max", "min"}));
    verb->add_option("--scaling", choice.scaling, "density: unit^2/Hz, spectrum: unit^2")
        ->capture_default_str()
        ->check(CLI::IsMember({"density", "spectrum"}));
    verb->add_option("--envelope", choice.envelope, "LOW:HIGH in Hz: spectrum of this band's envelope");
    verb->add_option("--fundamental", choice.rate, "LOW:HIGH in Hz: where the fundamental may lie")
        ->capture_default_str();
    verb->add_option("--orders", choice.orders, "rows of the harmonic table")
        ->capture_default_str()
        ->check(CLI::Range(1, 200));
    verb->add_option("--csv", choice.csv, "frequency and spectrum per channel; for several files a folder");
    verb->add_option("--plot", choice.plot, "figure, .svg or .png; for several files a folder, of SVG");
    verb->add_option("--table", choice.table, "a row per file and channel, CSV");
    verb->add_option("--report", choice.report, "figures, tables and how they were computed in one HTML file");
    verb->add_option("--jobs", choice.jobs, "files at a time, 0: one per core")->check(CLI::Range(0, 256));
}

void add_orders(CLI::App& app, OrdersChoice& choice) {
    CLI::App* verb = app.add_subcommand("orders", "levels of the orders of a machine whose rate changes");
    add_record_options(*verb, choice, "a sound file or CSV log");
    auto* tacho =
        verb->add_option("--tacho", choice.tacho, "channel of the tachometer, from 1")->check(CLI::Range(1, 1024));
    verb->add_option("--pulses", choice.pulses, "of the tachometer, per revolution")
        ->capture_default_str()
        ->check(CLI::Range(0.01, 1e5));
    verb->add_option("--rate", choice.fixed, "the rate, when it is known and constant, Hz")
        ->check(CLI::Range(0.01, 1e6))
        ->excludes(tacho);
    verb->add_option("--range", choice.range, "LOW:HIGH in Hz: where a rate to be tracked may lie")
        ->capture_default_str();
    verb->add_option("--orders", choice.highest, "highest order")->capture_default_str()->check(CLI::Range(1, 200));
    verb->add_option("--csv", choice.csv, "amplitude over orders");
}

void add_exposure(CLI::App& app, ExposureChoice& choice) {
    CLI::App* verb = app.add_subcommand(
        "exposure", "vibration exposure of the hand (ISO 5349-1): A(8), minutes to action and limit value");
    add_record_options(*verb, choice, "a record per tool, its channels the axes; or folders of them");
    verb->add_option("--duration", choice.durations,
                     "of contact per day, such as \"90 min\" (default 8 h); one, or one per file")
        ->allow_extra_args(false);
    verb->add_flag("--uncalibrated", choice.uncalibrated, "take an uncalibrated record's values as m/s^2");
    verb->add_option("--table", choice.table, "a row per file, CSV");
    verb->add_option("--jobs", choice.jobs, "files at a time, 0: one per core")->check(CLI::Range(0, 256));
}

}  // namespace

void add_analysis_verbs(CLI::App& app, AnalysisChoices& choices) {
    add_spectrum(app, choices.spectrum);
    add_orders(app, choices.orders);
    add_exposure(app, choices.exposure);
}

}  // namespace tactus
