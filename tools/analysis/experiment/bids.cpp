// SPDX-License-Identifier: Apache-2.0
// Tables of an experiment as the Brain Imaging Data Structure lays them out.
#include "tools/analysis/experiment/analysis.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace fs = std::filesystem;
using experiment::Protocol;
using file::Json;

namespace {

std::string cell(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? fmt::format("{:.9g}", *value) : "n/a";
}
/// A tab or the end of a line would begin another cell.
std::string cell(std::string text) {
    std::ranges::replace_if(text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return text.empty() ? "n/a" : text;
}
const char* cell(bool value) { return value ? "true" : "false"; }

Json yes_or_no(const char* yes, const char* no) {
    return {{"Description", yes}, {"Levels", {{"true", yes}, {"false", no}}}};
}

void write_participants(const ExperimentAnalysis& analysis, const fs::path& folder) {
    std::string rows =
        "participant_id\torder_row\tsimulated\trehearsal\tcomplete\ttrials\tmarked\texcluded\tsettings\n";
    for (const AnalysedSubject& subject : analysis.subjects)
        rows += fmt::format("sub-{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", subject.entry.pseudonym, subject.entry.row + 1,
                            cell(subject.entry.is_simulated), cell(subject.is_rehearsal),
                            cell(subject.entry.is_complete), subject.trials, subject.marked, cell(subject.excluded),
                            subject.entry.settings ? cell(fmt::format("{}", fmt::join(*subject.entry.settings, "; ")))
                                                   : std::string("unknown"));
    file::write_whole_file(folder / "participants.tsv", rows);
    const Json about{
        {"order_row", {{"Description", "row of the order of conditions, from 1"}}},
        {"simulated", yes_or_no("the subject is a model", "a person")},
        {"rehearsal", yes_or_no("without a haptic device or without a registered display", "with both")},
        {"complete", yes_or_no("the session came to its end", "it did not")},
        {"trials", {{"Description", "without practice"}}},
        {"marked", {{"Description", "trials beyond the limits of timing or force"}}},
        {"excluded", {{"Description", "reason by the rules of the protocol; n/a: included"}}},
        {"settings",
         {{"Description", "what the command line set for all trials; n/a: nothing; unknown: it was not stored"}}}};
    file::write_whole_file(folder / "participants.json", about.dump(2) + "\n");
}

Json column(const char* text, const std::string& unit = {}) {
    Json json{{"Description", text}};
    if (!unit.empty()) json["Units"] = unit;
    return json;
}

void write_answers(const Protocol& protocol, const AnalysedSubject& subject, const fs::path& file) {
    const bool is_adjustment = protocol.is_adjustment();
    std::string rows = fmt::format(
        "trial\tblock\tphase\tcondition\tlevel\t{}level_rendered\tinterval\tanswer\tcorrect\tresponse_"
        "time\tmissed\tgap\t"
        "limited\tsound_limited\tmarked\n",
        is_adjustment ? "match\tturns\t" : "");
    const double factor = parse_unit(protocol.stimulus->level_unit()).factor;
    for (const experiment::TrialRecord& t : subject.records)
        rows += fmt::format(
            "{}\t{}\t{}\t{}\t{}\t{}{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", t.number, t.block + 1, name_of(t.phase),
            t.condition, cell(std::optional(t.level / factor)),
            is_adjustment ? fmt::format("{}\t{}\t", cell(t.match ? std::optional(*t.match / factor) : std::nullopt),
                                        t.turns.size())
                          : std::string(),
            cell(t.rendered_level ? std::optional(*t.rendered_level / factor) : std::nullopt), t.interval,
            t.answer >= 0 && static_cast<std::size_t>(t.answer) < protocol.response.names.size()
                ? protocol.response.names[static_cast<std::size_t>(t.answer)]
                : "n/a",
            cell(t.is_correct), cell(t.response_time), cell(std::optional(t.missed)), cell(std::optional(t.gap)),
            cell(std::optional(t.limited)), cell(std::optional(t.sound_limited)), cell(t.marked));
    file::write_whole_file(file.string() + ".tsv", rows);
}

void write_measures(const AnalysedSubject& subject, const experiment::Task& task, const fs::path& file) {
    std::string rows = "trial\tblock\tphase\tcondition";
    for (const experiment::Measure& measure : task.measures) rows += "\t" + measure.name;
    rows += "\tfinished\tmissed\tgap\tlimited\tsound_limited\tmarked\n";
    for (const experiment::TrialRecord& t : subject.records) {
        if (t.task != task.name) continue;
        rows += fmt::format("{}\t{}\t{}\t{}", t.number, t.block + 1, name_of(t.phase), t.condition);
        for (const experiment::Measure& measure : task.measures) {
            const auto found = t.measures.find(measure.name);
            rows +=
                "\t" + cell(found == t.measures.end() ? std::nullopt
                                                      : std::optional(found->second / parse_unit(measure.unit).factor));
        }
        rows += fmt::format("\t{}\t{}\t{}\t{}\t{}\t{}\n", cell(t.is_finished), cell(std::optional(t.missed)),
                            cell(std::optional(t.gap)), cell(std::optional(t.limited)),
                            cell(std::optional(t.sound_limited)), cell(t.marked));
    }
    file::write_whole_file(file.string() + ".tsv", rows);
}

Json shared_columns() {
    return {{"trial", column("number in the session, from 1")},
            {"block", column("block of the session, from 1")},
            {"phase", column("practice, main, catch, or repeat of a marked trial")},
            {"condition", column("condition of the protocol")},
            {"missed", column("fraction of ticks that were missed")},
            {"gap", column("latest tick", "s")},
            {"limited", column("fraction of the time in which a limiter changed the force")},
            {"sound_limited", column("fraction of the samples of an audio output that its limit changed")},
            {"marked", column("why the trial is beyond the limits of the protocol")}};
}

void make_folder(const fs::path& folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder.string(), failure.message()));
}

}  // namespace

void write_bids(const ExperimentAnalysis& analysis, const fs::path& folder) {
    const Protocol& protocol = analysis.protocol;
    const Json description{{"Name", protocol.title},
                           {"BIDSVersion", "1.9.0"},
                           {"DatasetType", "raw"},
                           {"GeneratedBy", Json::array({{{"Name", "tactus experiment analyse"}}})}};
    file::write_whole_file(folder / "dataset_description.json", description.dump(2) + "\n");
    // What is not of the standard: validators leave it out.
    std::string ignored = "frozen/\nexperiment.json\n";
    for (const std::string_view stem : result_stems) ignored += fmt::format("{}.*\n", stem);
    file::write_whole_file(folder / ".bidsignore", ignored + "mixed/\nsub-*/trials.jsonl\nsub-*/trial-*\n");
    // A laboratory may have written its own.
    if (!fs::exists(folder / "README"))
        file::write_whole_file(
            folder / "README",
            fmt::format("{}\n\n{}\n\nTables of 'tactus experiment analyse', in the layout of BIDS. A column of a "
                        "table is described in the JSON file of the same name.\n",
                        protocol.title, protocol.about));
    write_participants(analysis, folder);
    for (const AnalysedSubject& subject : analysis.subjects) {
        const fs::path beh = folder / ("sub-" + subject.entry.pseudonym) / "beh";
        make_folder(beh);
        const auto name = [&](const std::string& task) {
            return beh / fmt::format("sub-{}_task-{}_beh", subject.entry.pseudonym, task);
        };
        if (protocol.is_psychophysics()) {
            write_answers(protocol, subject, name(protocol.name));
            Json about = shared_columns();
            const std::string unit = protocol.stimulus->level_unit();
            about.update({{"TaskName", protocol.name},
                          {"level", column("wanted level of the stimulus", unit)},
                          {"level_rendered", column("level commanded to the device after all limits", unit)},
                          {"interval", column("interval with the stimulus, from 1; 0: none")},
                          {"answer", column("answer of the subject")},
                          {"correct", column("the answer is right")},
                          {"response_time", column("from the end of the trial to the answer", "s")}});
            if (protocol.is_adjustment()) {
                about["level"] = column("level of the stimulus at which the trial began", unit);
                about["match"] = column("level at which the subject ended the trial; n/a: it ended without", unit);
                about["turns"] = column("number of levels that the subject set");
                about["correct"] = column("the trial ended with a match");
                about["response_time"] = column("from the beginning of the trial to the match", "s");
            }
            file::write_whole_file(name(protocol.name).string() + ".json", about.dump(2) + "\n");
            continue;
        }
        for (const experiment::Task& task : protocol.tasks) {
            write_measures(subject, task, name(task.name));
            Json about = shared_columns();
            about["TaskName"] = task.name;
            about["finished"] = column("the task was done before its time was over");
            for (const experiment::Measure& measure : task.measures)
                about[measure.name] = column("measure of the protocol", measure.unit);
            file::write_whole_file(name(task.name).string() + ".json", about.dump(2) + "\n");
        }
    }
}

}  // namespace tactus::analysis
