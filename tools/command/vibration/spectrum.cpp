// SPDX-License-Identifier: Apache-2.0
// tactus spectrum: spectral analysis of records.
#include "assets/file/json.hpp"
#include "assets/table/csv_file.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/result_options.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/vibration/spectrum_result.hpp"

#include <fmt/format.h>

#include <functional>
#include <iterator>
#include <memory>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct SpectrumChoice : RecordChoice {
    report::SpectrumMethod method;
    std::string band;                  // LOW:HIGH in Hz, of plots
    std::string octaves, integrate;    // none, octave or third; none, velocity or displacement
    double high_pass = 10.0;           // Hz
    bool only_psd = false;
    std::vector<std::string> marks;
    std::optional<std::size_t> segment;
    std::optional<double> overlap;
    int orders = 10, jobs = 0;         // files at a time, 0: one per core
    fs::path csv, plot, table, cepstrum;
    ResultChoice result;
};

struct Outcome {
    report::Result result;
    std::vector<file::Json> table;                // rows of CSV
    std::optional<analysis::AnalysedFile> drawn;  // for a figure of several files
};

/// Frequency and density per channel.
std::string analysis_csv(const analysis::AnalysedFile& file) {
    std::string text = "frequency_hz";
    for (const analysis::AnalysedChannel& channel : file.channels) text += "," + table::csv_field(channel.name);
    text += '\n';
    const std::size_t bins = file.channels.empty() ? 0 : file.channels.front().report.psd.power.size();
    for (std::size_t k = 0; k < bins; ++k) {
        fmt::format_to(std::back_inserter(text), "{}", file.channels.front().report.psd.frequency(k));
        for (const analysis::AnalysedChannel& channel : file.channels)
            fmt::format_to(std::back_inserter(text), ",{}", channel.report.psd.power[k]);
        text += '\n';
    }
    return text;
}

/// Quefrency and cepstrum per channel.
std::string cepstrum_csv(const analysis::AnalysedFile& file) {
    std::string text = "quefrency_s";
    for (const analysis::AnalysedChannel& channel : file.channels) text += "," + csv_field(channel.name);
    text += '\n';
    const std::size_t values = file.channels.empty() ? 0 : file.channels.front().report.cepstrum.value.size();
    for (std::size_t k = 0; k < values; ++k) {
        fmt::format_to(std::back_inserter(text), "{}", file.channels.front().report.cepstrum.quefrency(k));
        for (const analysis::AnalysedChannel& channel : file.channels)
            // A silent channel has none.
            text +=
                k < channel.report.cepstrum.value.size() ? fmt::format(",{}", channel.report.cepstrum.value[k]) : ",";
        text += '\n';
    }
    return text;
}

analysis::SpectrumSettings settings_of(const SpectrumChoice& choice, bool overlay) {
    constexpr std::pair<const char*, signal::WindowKind> windows[] = {
        {"hann", signal::WindowKind::hann},         {"hamming", signal::WindowKind::hamming},
        {"blackman", signal::WindowKind::blackman}, {"blackmanharris", signal::WindowKind::blackman_harris},
        {"flattop", signal::WindowKind::flat_top},  {"boxcar", signal::WindowKind::rectangular}};
    const report::SpectrumMethod& words = choice.method;
    analysis::SpectrumSettings settings;
    settings.record = choice.settings();
    for (const auto& [name, kind] : windows)
        if (words.window == name) settings.window = kind;
    settings.detrend = words.detrend == "none"     ? signal::Detrend::none
                       : words.detrend == "linear" ? signal::Detrend::linear
                                                   : signal::Detrend::constant;
    settings.averaging = words.average == "median" ? signal::Averaging::median
                         : words.average == "max"  ? signal::Averaging::maximum
                         : words.average == "min"  ? signal::Averaging::minimum
                                                   : signal::Averaging::mean;
    settings.is_density = words.scaling != "spectrum";
    settings.segment = choice.segment;
    settings.overlap = choice.overlap.value_or(0.5);
    settings.fundamental = parse_band(choice.method.fundamental, "--fundamental");
    if (!words.envelope.empty()) settings.envelope = parse_band(words.envelope, "--envelope");
    settings.orders = choice.orders;
    settings.octave_filters = choice.octaves == "octave" ? 1 : choice.octaves == "third" ? 3 : 0;
    settings.integrations = choice.integrate == "velocity" ? 1 : choice.integrate == "displacement" ? 2 : 0;
    settings.high_pass = choice.high_pass;
    settings.only_psd = choice.only_psd;
    settings.spectrogram = (!choice.plot.empty() && !overlay) || choice.result.shows_figures();
    for (const std::string& mark : choice.marks) settings.marks.push_back(analysis::parse_mark(mark));
    return settings;
}

report::PlottedBand plotted_band(const SpectrumChoice& choice) {
    return choice.band.empty() ? report::PlottedBand() : parse_band(choice.band, "--band");
}

report::SpectrumMethod method_of(const SpectrumChoice& choice) {
    report::SpectrumMethod method = choice.method;
    method.overlap = choice.overlap.value_or(0.5);
    method.cepstrum = !choice.cepstrum.empty();
    method.band = plotted_band(choice);
    return method;
}

Outcome analyse(const fs::path& path, const SpectrumChoice& choice, const report::SpectrumMethod& method, bool many,
                const std::function<void(double)>& progress) {
    // Several files go into one figure, unless --plot names a folder.
    const bool overlay = many && report::is_figure_file(choice.plot);
    analysis::AnalysedFile file = analysis::analyse_file(path, settings_of(choice, overlay), progress);
    const auto output = [&](const fs::path& wanted, const char* ending) {
        return many ? wanted / (path.filename().string() + ending) : wanted;
    };
    if (!choice.csv.empty()) table::save_csv(output(choice.csv, ".csv"), analysis_csv(file));
    if (!choice.cepstrum.empty()) table::save_csv(output(choice.cepstrum, ".csv"), cepstrum_csv(file));
    if (!choice.plot.empty() && !overlay)
        save_figure(report::draw_spectrum(file, method.band), output(choice.plot, ".svg"), choice.result.figure);
    Outcome outcome{report::spectrum_result(file, method, choice.result.shows_figures()), {}, {}};
    if (!choice.table.empty()) outcome.table = report::spectrum_rows(file, method);
    if (overlay) outcome.drawn = std::move(file);
    return outcome;
}

int spectrum(const SpectrumChoice& choice) {
    const std::vector<fs::path> files = analysis::expand_folders(choice.files);
    const bool many = files.size() > 1 ||
                      std::ranges::any_of(choice.files, [](const fs::path& one) { return fs::is_directory(one); });
    settings_of(choice, false);  // refuses what cannot be read, before the files are
    const report::SpectrumMethod method = method_of(choice);
    for (const fs::path& out : {choice.csv, choice.cepstrum}) check_batch_output(out, {".csv"}, many);
    if (!many) check_batch_output(choice.plot, {".svg", ".png", ".pdf"}, many);
    if (many)
        for (const fs::path& folder : {choice.csv, choice.plot, choice.cepstrum})
            if (!folder.empty() && !(folder == choice.plot && report::is_figure_file(folder)))
                fs::create_directories(folder);
    check_result_files(choice.result, choice.files);
    std::vector<Outcome> outcomes(files.size());
    const std::vector<std::string> failures = run_batch(
        files.size(), choice.jobs, "files",
        [&](std::size_t i, const std::function<void(double)>& progress) {
            outcomes[i] = analyse(files[i], choice, method, many, progress);
        },
        choice.result.quiet);
    const bool bad = tell_failures(failures) > 0;
    if (many && report::is_figure_file(choice.plot)) {
        std::vector<analysis::AnalysedFile> drawn;
        for (Outcome& outcome : outcomes)
            if (outcome.drawn) drawn.push_back(std::move(*outcome.drawn));
        if (!drawn.empty()) save_figure(report::draw_overlay(drawn, method.band), choice.plot, choice.result.figure);
    }
    report::Spectra found{{}, &method};
    std::vector<file::Json> table;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string name = files[i].string();
        const bool is_read = failures[i].empty();
        found.records.push_back(is_read ? std::move(outcomes[i].result) : report::unread_spectrum(name, failures[i]));
        if (!is_read) table.push_back({{"file", name}, {"error", failures[i]}});
        for (file::Json& row : outcomes[i].table) table.push_back(std::move(row));
    }
    if (!choice.table.empty()) table::save_csv(choice.table, report::csv_table(report::spectrum_columns, table));
    // Of one bad file only its error is printed.
    if (!bad || many || choice.result.json) write_result(report::spectrum_fields().of(found), choice.result);
    return bad ? bad_input : done;
}

Action declare_spectrum(VerbOptions& verb) {
    const auto choice = std::make_shared<SpectrumChoice>();
    report::SpectrumMethod& words = choice->method;
    words.fundamental = "5:1000";
    add_record_options(verb, *choice, "sound files, CSV logs, or folders of them");
    verb.add("--window", words.window, "window function")
        .shows_default()
        .one_of({"hann", "hamming", "blackman", "blackmanharris", "flattop", "boxcar"});
    verb.add("--segment", choice->segment, "samples (default: about 0.75 s)").range(2, 1 << 26);
    verb.add("--overlap", choice->overlap, "overlap as a fraction of a segment (default 0.5)").range(0.0, 0.99);
    verb.add("--detrend", words.detrend, "trend removed from each segment")
        .shows_default()
        .one_of({"none", "constant", "linear"});
    verb.add("--average", words.average, "over segments").shows_default().one_of({"mean", "median", "max", "min"});
    verb.add("--scaling", words.scaling, "density: unit^2/Hz, spectrum: unit^2")
        .shows_default()
        .one_of({"density", "spectrum"});
    verb.add("--envelope", words.envelope, "LOW:HIGH in Hz: spectrum of the envelope of this band");
    verb.add("--fundamental", words.fundamental, "LOW:HIGH in Hz: search range of the fundamental").shows_default();
    verb.add("--orders", choice->orders, "rows of the harmonic table").shows_default().range(1, 200);
    verb.add("--octave-filters", choice->octaves,
             "levels by filters of IEC 61260-1, class 1, of an octave or a third, up to 0.24 times the sample rate")
        .one_of({"octave", "third"});
    verb.add("--integrate", choice->integrate, "analyse the velocity or displacement of an acceleration")
        .one_of({"velocity", "displacement"});
    verb.add("--high-pass", choice->high_pass, "high-pass of each integration, Hz")
        .unit("Hz")
        .shows_default()
        .range(1e-3, 1e6);
    verb.output(
        "--cepstrum", choice->cepstrum, OutputFormat::file_or_folder({".csv"}),
        "CSV file with quefrency and cepstrum per channel, and its peaks in the text; for several files: a folder");
    const Option only_psd = verb.flag("--psd-only", choice->only_psd, "the spectrum alone, in one pass: --csv, --json");
    verb.output("--csv", choice->csv, OutputFormat::file_or_folder({".csv"}),
                "CSV file with frequency and spectrum per channel; for several files: a folder");
    verb.output("--plot", choice->plot, OutputFormat::file_or_folder({".svg", ".png", ".pdf"}),
                "figure, .svg, .png or .pdf: several files in one plot; or a folder for a figure of each");
    add_result_options(verb, choice->result, ResultFigure::some);
    verb.old("--report", "--out");
    verb.add("--band", choice->band, "plotted range, Hz (default: 20 Hz to half the sample rate)")
        .value_name("LOW:HIGH");
    verb.add("--mark", choice->marks,
             "a frequency to mark in figures and to state the level of, with a label, such as 118.9:BPFI or \"118.9 "
             "Hz:BPFI:5\" with five harmonics; repeatable")
        .value_name("FREQUENCY:LABEL[:HARMONICS]")
        .one_each();
    verb.output("--table", choice->table, {{".csv"}}, "CSV file with one row per file and channel");
    verb.add("--jobs", choice->jobs, "files at a time, 0: one per core").range(0, 256);
    for (const char* other : {"--octave-filters", "--cepstrum", "--envelope", "--plot", "--mark", "--table"})
        verb.find(other).excludes(only_psd);
    return [choice] { return spectrum(*choice); };
}

}  // namespace

Verb spectrum_verb() {
    return {.name = "spectrum",
            .about = "analyse a vibration record: spectrum, fundamental, harmonics, hum, bands, envelope",
            .add = declare_spectrum,
            .schema = [] { return report::schema_of_output({report::spectrum_fields().schema()}); }};
}

}  // namespace tactus::command
