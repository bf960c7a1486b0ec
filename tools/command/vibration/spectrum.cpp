// SPDX-License-Identifier: Apache-2.0
// tactus spectrum: spectral analysis of records.
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "tools/command/batch.hpp"
#include "tools/command/figure_options.hpp"
#include "tools/command/vibration/record_options.hpp"
#include "tools/command/vibration/spectrum_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/figures/html_report.hpp"
#include "tools/report/figures/spectrum_figure.hpp"
#include "tools/report/figures/spectrum_page.hpp"

#include <fmt/format.h>

#include <functional>
#include <memory>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;
namespace html = report::html;

struct SpectrumChoice : RecordChoice {
    SpectrumWords words;
    std::string envelope;              // LOW:HIGH in Hz
    std::string fundamental = "5:1000";  // LOW:HIGH in Hz
    std::string band;                  // LOW:HIGH in Hz, of plots
    std::string octaves, integrate;    // none, octave or third; none, velocity or displacement
    double high_pass = 10.0;           // Hz
    bool only_psd = false;
    std::vector<std::string> marks;
    std::optional<std::size_t> segment;
    std::optional<double> overlap;
    int orders = 10, jobs = 0;         // files at a time, 0: one per core
    fs::path csv, plot, table, report, cepstrum;
    FigureChoice figure;
};

struct Outcome {
    std::string text, table;  // printed text; CSV rows
    std::string section;      // section of the HTML page
    std::optional<analysis::AnalysedFile> drawn;  // for a figure of several files
};

analysis::SpectrumSettings settings_of(const SpectrumChoice& choice, bool overlay) {
    constexpr std::pair<const char*, signal::WindowKind> windows[] = {
        {"hann", signal::WindowKind::hann},         {"hamming", signal::WindowKind::hamming},
        {"blackman", signal::WindowKind::blackman}, {"blackmanharris", signal::WindowKind::blackman_harris},
        {"flattop", signal::WindowKind::flat_top},  {"boxcar", signal::WindowKind::rectangular}};
    const SpectrumWords& words = choice.words;
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
    settings.fundamental = parse_band(choice.fundamental, "--fundamental");
    if (!choice.envelope.empty()) settings.envelope = parse_band(choice.envelope, "--envelope");
    settings.orders = choice.orders;
    settings.octave_filters = choice.octaves == "octave" ? 1 : choice.octaves == "third" ? 3 : 0;
    settings.integrations = choice.integrate == "velocity" ? 1 : choice.integrate == "displacement" ? 2 : 0;
    settings.high_pass = choice.high_pass;
    settings.only_psd = choice.only_psd;
    settings.spectrogram = (!choice.plot.empty() && !overlay) || !choice.report.empty();
    for (const std::string& mark : choice.marks) settings.marks.push_back(analysis::parse_mark(mark));
    return settings;
}

report::PlottedBand plotted_band(const SpectrumChoice& choice) {
    return choice.band.empty() ? report::PlottedBand() : parse_band(choice.band, "--band");
}

report::SpectrumMethod method_of(const SpectrumChoice& choice) {
    return {choice.words.window, choice.words.detrend, choice.words.average,         choice.words.scaling,
            choice.envelope,     choice.fundamental,   choice.overlap.value_or(0.5), plotted_band(choice)};
}

Outcome analyse(const fs::path& path, const SpectrumChoice& choice, bool many,
                const std::function<void(double)>& progress) {
    // Several files go into one figure, unless --plot names a folder.
    const bool overlay = many && report::is_figure_file(choice.plot);
    analysis::AnalysedFile file = analysis::analyse_file(path, settings_of(choice, overlay), progress);
    const auto output = [&](const fs::path& wanted, const char* ending) {
        return many ? wanted / (path.filename().string() + ending) : wanted;
    };
    if (!choice.csv.empty()) file::write_whole_file(output(choice.csv, ".csv"), analysis_csv(file));
    if (!choice.cepstrum.empty()) file::write_whole_file(output(choice.cepstrum, ".csv"), cepstrum_csv(file));
    if (!choice.plot.empty() && !overlay)
        save_figure(report::draw_spectrum(file, plotted_band(choice)), output(choice.plot, ".svg"), choice.figure);
    Outcome outcome{choice.json ? analysis_json(file, choice.words) : analysis_text(file, choice.words),
                    analysis_rows(file),
                    choice.report.empty() ? std::string() : report::analysis_section(file, method_of(choice)),
                    {}};
    if (overlay) outcome.drawn = std::move(file);
    return outcome;
}

void print_json(const std::vector<fs::path>& files, const std::vector<Outcome>& outcomes,
                const std::vector<std::string>& failures) {
    file::Json all = file::Json::array();
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (failures[i].empty()) all.push_back(file::Json::parse(outcomes[i].text));
        else all.push_back({{"file", files[i].string()}, {"error", failures[i]}});
    }
    fmt::print("{}\n", file::Json{{"version", 1}, {"rows", all}}.dump(2));
}

int spectrum(const SpectrumChoice& choice) {
    const std::vector<fs::path> files = analysis::expand_folders(choice.files);
    const bool many = files.size() > 1;
    settings_of(choice, false);  // refuses what cannot be read, before the files are
    plotted_band(choice);
    if (many)
        for (const fs::path& folder : {choice.csv, choice.plot, choice.cepstrum})
            if (!folder.empty() && !(folder == choice.plot && report::is_figure_file(folder)))
                fs::create_directories(folder);
    std::vector<Outcome> outcomes(files.size());
    const std::vector<std::string> failures =
        run_batch(files.size(), choice.jobs, "files", [&](std::size_t i, const std::function<void(double)>& progress) {
            outcomes[i] = analyse(files[i], choice, many, progress);
        });
    const bool bad = tell_failures(failures) > 0;
    if (many && report::is_figure_file(choice.plot)) {
        std::vector<analysis::AnalysedFile> drawn;
        for (Outcome& outcome : outcomes)
            if (outcome.drawn) drawn.push_back(std::move(*outcome.drawn));
        if (!drawn.empty()) save_figure(report::draw_overlay(drawn, plotted_band(choice)), choice.plot, choice.figure);
    }
    if (choice.json) print_json(files, outcomes, failures);
    else
        for (const Outcome& outcome : outcomes) fmt::print("{}", outcome.text);
    if (!choice.table.empty()) {
        std::string table = analysis_heading;
        for (std::size_t i = 0; i < files.size(); ++i)
            table += failures[i].empty()
                         ? outcomes[i].table
                         : fmt::format("{},,,,,,,,,,,{}\n", csv_field(files[i].string()), csv_field(failures[i]));
        file::write_whole_file(choice.table, table);
    }
    if (!choice.report.empty()) {
        std::string body;
        for (std::size_t i = 0; i < files.size(); ++i)
            body += failures[i].empty() ? outcomes[i].section
                                        : fmt::format("<p class=\"fail\">{}</p>\n", html::escaped(failures[i]));
        file::write_whole_file(choice.report,
                               html::page(many ? "Vibration of " + std::to_string(files.size()) + " records"
                                               : files.front().filename().string(),
                                          body + report::analysis_method(method_of(choice))));
    }
    return bad ? bad_input : done;
}

Action declare_spectrum(VerbOptions& verb) {
    const auto choice = std::make_shared<SpectrumChoice>();
    SpectrumWords& words = choice->words;
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
    verb.add("--envelope", choice->envelope, "LOW:HIGH in Hz: spectrum of the envelope of this band");
    verb.add("--fundamental", choice->fundamental, "LOW:HIGH in Hz: search range of the fundamental").shows_default();
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
    verb.add(
        "--cepstrum", choice->cepstrum,
        "CSV file with quefrency and cepstrum per channel, and its peaks in the text; for several files: a folder");
    const Option only_psd = verb.flag("--psd-only", choice->only_psd, "the spectrum alone, in one pass: --csv, --json");
    verb.add("--csv", choice->csv, "CSV file with frequency and spectrum per channel; for several files: a folder");
    verb.add("--plot", choice->plot,
             "figure, .svg, .png or .pdf: several files in one plot; or a folder for a figure of each");
    add_figure_options(verb, choice->figure);
    verb.add("--band", choice->band, "plotted range, Hz (default: 20 Hz to half the sample rate)")
        .value_name("LOW:HIGH");
    verb.add("--mark", choice->marks,
             "a frequency to mark in figures and to state the level of, with a label, such as 118.9:BPFI or \"118.9 "
             "Hz:BPFI:5\" with five harmonics; repeatable")
        .value_name("FREQUENCY:LABEL[:HARMONICS]")
        .one_each();
    verb.add("--table", choice->table, "CSV file with one row per file and channel");
    verb.add("--report", choice->report, "HTML file with figures, tables and methods");
    verb.add("--jobs", choice->jobs, "files at a time, 0: one per core").range(0, 256);
    for (const char* other :
         {"--octave-filters", "--cepstrum", "--envelope", "--plot", "--mark", "--table", "--report"})
        verb.find(other).excludes(only_psd);
    verb.check([choice] { choice->words.cepstrum = !choice->cepstrum.empty(); });
    return [choice] { return spectrum(*choice); };
}

}  // namespace

Verb spectrum_verb() {
    return {"spectrum", "analyse a vibration record: spectrum, fundamental, harmonics, hum, bands, envelope",
            declare_spectrum};
}

}  // namespace tactus::command
