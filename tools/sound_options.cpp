// SPDX-License-Identifier: Apache-2.0
#include "tools/sound_options.hpp"

#include "tools/command/patch_options.hpp"

#include <CLI/CLI.hpp>

namespace tactus {

namespace {

void add_compare(CLI::App& app, CompareChoice& choice) {
    CLI::App* verb =
        app.add_subcommand("compare", "is what the actuator plays what the saw did? Exit code 0: yes, 1: no");
    verb->add_option("reference", choice.reference, "sound file or CSV log of what was wanted, or a folder")
        ->required();
    verb->add_option("output", choice.output,
                     "sound file or CSV log of what came out, or a folder: files are paired by name")
        ->required();
    verb->add_option("--thresholds", choice.thresholds, "TOML file of what must be reached; without: see README");
    verb->add_option("--plot", choice.plot, "a figure, .svg or .png; of folders a folder, of SVG");
    verb->add_option("--report", choice.report, "figure, tables and how they were computed in one HTML file");
    verb->add_option("--table", choice.table, "a row per pair, CSV");
    verb->add_option("--jobs", choice.jobs, "pairs at a time, 0: one per core")->check(CLI::Range(0, 256));
    verb->add_option("--reference-scale", choice.reference_scale, "units per full scale, such as m/s^2")
        ->capture_default_str();
    verb->add_option("--output-scale", choice.output_scale, "of the output, in the same unit")->capture_default_str();
    verb->add_option("--channel", choice.channel, "of both files, from 1; 0: the mean of all")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    verb->add_option("--time-column", choice.time_columns, "of CSV logs: name or number, of both files or of each")
        ->delimiter(',')
        ->expected(1, 2)
        ->allow_extra_args(false);
    verb->add_option("--column", choice.columns, "of CSV logs: name or number of what is compared, of both or of each")
        ->delimiter(',')
        ->expected(1, 2)
        ->allow_extra_args(false);
    verb->add_option("--time-unit", choice.time_unit, "of CSV logs: s, ms, us or ns")
        ->check(CLI::IsMember({"s", "ms", "us", "ns"}));
    verb->add_option("--actuator", choice.actuator, "state the level gap of this actuator at its limits, of m/s^2");
    verb->add_option("--mass", choice.mass, "that the actuator shakes, kg")->capture_default_str();
    verb->add_option("--touch", choice.touch, "what the threshold of touch is a threshold of")
        ->capture_default_str()
        ->check(CLI::IsMember({"displacement", "acceleration", "none"}));
    verb->add_option("--max-delay", choice.longest_delay, "greatest delay looked for, s")
        ->capture_default_str()
        ->check(CLI::Range(0.001, 100.0));
    verb->add_flag("--json", choice.json, "as JSON");
}

void add_validate(CLI::App& app, ValidateChoice& choice) {
    CLI::App* verb = app.add_subcommand(
        "validate", "does the handle vibrate as the saw did, at every rate and load recorded? Exit code 0: yes, 1: no");
    add_patch_options(*verb, choice);
    verb->add_option("--reference", choice.set, "recording set, TOML, or one sound; the patch's saw plays it")
        ->required();
    verb->add_option("--level", choice.levels, "dB on top of the patch's, one or more")
        ->capture_default_str()
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(-80.0, 40.0));
    verb->add_option("--saw", choice.saw, "the node that plays (default: the only one of type saw)");
    verb->add_option("--out", choice.out_port,
                     "NODE.PORT, the handle's vibration (default: what is recorded as handle.wav, or the actuator's)");
    verb->add_option("--seconds", choice.seconds, "that are compared of each run")
        ->capture_default_str()
        ->check(CLI::Range(0.5, 600.0));
    verb->add_option("--thresholds", choice.thresholds, "TOML file of what must be reached, as of compare");
    verb->add_option("--touch", choice.touch, "what the threshold of touch is a threshold of")
        ->capture_default_str()
        ->check(CLI::IsMember({"displacement", "acceleration", "none"}));
    verb->add_option("--report", choice.report, "figures, tables and how they were computed in one HTML file");
    verb->add_option("--plot", choice.plot, "folder for a figure of each run, SVG");
    verb->add_option("--table", choice.table, "a row per run, CSV");
    verb->add_option("--jobs", choice.jobs, "runs at a time, 0: one per core")->check(CLI::Range(0, 256));
    verb->add_flag("--json", choice.json, "as JSON");
}

void add_measure(CLI::App& app, MeasureChoice& choice) {
    CLI::App* verb = app.add_subcommand(
        "measure", "sweep through a patch or a sound card: response, resonance, distortion, latency");
    verb->add_option("patch", choice.patch, "patch file, or a name in the library");
    verb->add_option("--in", choice.in, "NODE.PORT that the sweep feeds (an input) or replaces (an output)");
    verb->add_option("--out", choice.out_port, "NODE.PORT, the output that is recorded");
    verb->add_option("--device", choice.device, "a sound card instead: part of its name, or 'default'");
    verb->add_option("--output-channel", choice.output_channel, "of the card, from 1")->capture_default_str();
    verb->add_option("--input-channel", choice.input_channel, "of the card, from 1")->capture_default_str();
    verb->add_option("--rate", choice.rate, "of the card, Hz")->capture_default_str()->check(CLI::Range(1e3, 1e6));
    verb->add_option("-o,--csv", choice.csv, "the response, CSV")->capture_default_str();
    verb->add_option("--first", choice.first, "first frequency, Hz")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 1e5));
    verb->add_option("--last", choice.last, "last frequency, Hz")->capture_default_str()->check(CLI::Range(0.1, 1e5));
    verb->add_option("--duration", choice.duration, "of the sweep, s")
        ->capture_default_str()
        ->check(CLI::Range(0.1, 1e3));
    verb->add_option("--pause", choice.pause, "silence after it, s")
        ->capture_default_str()
        ->check(CLI::Range(0.05, 1e2));
    verb->add_option("--repeats", choice.repeats, "sweeps, averaged")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    verb->add_option("--amplitude", choice.amplitude, "of the sweep, in the unit of what it feeds; card: of full scale")
        ->capture_default_str();
    verb->add_option("--fit-from", choice.fit_lowest, "where the resonance is looked for, Hz")->capture_default_str();
    verb->add_option("--fit-to", choice.fit_highest, "and up to where, Hz")->capture_default_str();
    verb->add_option("--set", choice.overrides.settings, "change a parameter: NODE.PARAM=VALUE")
        ->allow_extra_args(false);
    verb->add_option("--asset", choice.overrides.assets, "use another file: NAME=PATH")->allow_extra_args(false);
    verb->add_option("--seed", choice.seed, "seed of the random numbers");
    verb->add_flag("--json", choice.json, "as JSON");
}

void add_equalise(CLI::App& app, EqualiseChoice& choice) {
    CLI::App* verb = app.add_subcommand("equalise", "make a filter for the 'equaliser' node from a measured response");
    verb->add_option("response", choice.response, "file of 'tactus measure', or a table of Hz, dB and degrees")
        ->required();
    verb->add_option("-o,--out", choice.out, "the filter, TOML")->required();
    verb->add_option("--kind", choice.kind,
                     "minimum: adds at most 2 ms; linear: undoes the phase, adds half its length")
        ->capture_default_str()
        ->check(CLI::IsMember({"minimum", "linear"}));
    verb->add_option("--rate", choice.rate, "of the node that will use it, Hz")->capture_default_str();
    verb->add_option("--from", choice.lowest, "band to be made flat, Hz")->capture_default_str();
    verb->add_option("--to", choice.highest, "and its upper end, Hz")->capture_default_str();
    verb->add_option("--length", choice.length, "of the impulse response, s")->capture_default_str();
    verb->add_option("--max-boost", choice.greatest_boost_db, "greatest gain of the filter, dB")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 60.0));
    verb->add_option("--regularisation", choice.regularisation, "share of the mean power gain below which it lets go")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    verb->add_option("--actuator", choice.actuator, "whose voltage and current limits count")->capture_default_str();
    verb->add_option("--volts", choice.volts, "drive voltage per unit of the response's input")->capture_default_str();
    verb->add_option("--signal", choice.signal, "a recording to be played: how much of it the limits would cut");
    verb->add_option("--scale", choice.scale, "units of the response's input per full scale of the recording")
        ->capture_default_str();
    verb->add_flag("--json", choice.json, "as JSON");
}

}  // namespace

void add_sound_verbs(CLI::App& app, SoundChoices& choices) {
    add_compare(app, choices.compare);
    add_validate(app, choices.validate);
    add_measure(app, choices.measure);
    add_equalise(app, choices.equalise);
}

}  // namespace tactus
