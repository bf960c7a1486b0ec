// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/engine.hpp"
#include "engine/take/take_compare.hpp"
#include "engine/take/take_copy.hpp"
#include "tools/command/options.hpp"
#include "tools/command/progress.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/output_folder.hpp"
#include "tools/run/replayed_take.hpp"
#include "tools/run/results.hpp"
#include "tools/run/summary.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <thread>

namespace tactus::command {

using namespace run;

namespace {

using file::Json;

struct ReplayChoice {
    std::filesystem::path take, out, record;  // folders for the results and for a take with all values; empty: none
    bool json = false;
    bool overwrite = false;
    bool anyway = false;  // even if assets have changed
};

/// Outputs with different hashes but equal values: the take does not store all of their values.
std::vector<std::string> differing_hashes(const take::Take& take, const run::Engine& engine) {
    std::vector<std::string> ports;
    if (take.result.empty()) return ports;
    for (const auto& [port, hash] : engine.port_hashes()) {
        const auto expected = take.result.find(port);
        if (expected == take.result.end() || expected->second != hash) ports.push_back(port);
    }
    return ports;
}

Json difference_json(const take::TakeDifference& d) {
    return {{"port", d.port},         {"tick", d.tick},         {"time_s", d.time},
            {"channels", d.channels}, {"expected", d.expected}, {"got", d.got}};
}

struct Verdict {
    std::vector<take::TakeDamage> damages;
    std::vector<std::string> hashes;  ///< outputs whose hash differs
    std::optional<take::TakeDifference> first;
    std::uint64_t compared = 0;
    std::size_t compared_hashes = 0;
    bool is_complete = false;
    std::optional<double> values_end_s;  // by their limit

    bool differs() const { return first || !damages.empty() || !hashes.empty(); }
    /// A take without values has a hash of all values of each output.
    bool is_equal_so_far() const { return !differs() && (compared > 0 || compared_hashes > 0); }
    bool is_identical() const { return is_equal_so_far() && is_complete; }
};

void print(const Verdict& verdict, std::size_t outputs, double seconds) {
    for (const take::TakeDamage& d : verdict.damages)
        fmt::print("differs: {} has {} {}, the run wrote {}\n", d.file, d.holds, d.unit, d.written);
    if (const auto& first = verdict.first)
        fmt::print("differs: {} at tick {} ({:.6f} s): expected {}, got {}\n", first->port, first->tick, first->time,
                   fmt::join(first->expected, " "), fmt::join(first->got, " "));
    // An incomplete run has other hashes.
    else if (verdict.damages.empty() && !verdict.hashes.empty())
        fmt::print("differs: the hashes of {}\n", fmt::join(verdict.hashes, ", "));
    if (verdict.differs()) return;
    if (verdict.compared == 0 && verdict.compared_hashes > 0)
        fmt::print("identical: the hash of {}, {:.3g} s; the take has no values\n",
                   counted(verdict.compared_hashes, "output"), seconds);
    else if (verdict.compared == 0)
        fmt::print("{}0 values compared: the take has none\n", verdict.is_complete ? "" : "cut off; ");
    else if (!verdict.is_complete)
        fmt::print("cut off; {} compared, equal so far; {:.3g} s can be repeated\n", counted(verdict.compared, "value"),
                   seconds);
    else
        fmt::print("identical: {} of {}, {:.3g} s{}\n", counted(verdict.compared, "value"), counted(outputs, "output"),
                   seconds,
                   verdict.values_end_s
                       ? fmt::format("; values up to {:.4g} s, then the hash of each output", *verdict.values_end_s)
                       : std::string());
}

/// The summary of a run that was cut off says so, and how far the results reach.
std::string with_end(const std::string& summary, const take::Take& take, double covered) {
    if (take.is_complete) return summary;
    Json json = Json::parse(summary);
    json["cut_off"] = {{"reaches_s", covered},
                       {"asked_s", take.about.seconds > 0.0 ? Json(take.about.seconds) : Json()}};
    return json.dump(2) + "\n";
}

void print_end(const ReplayChoice& choice, const take::Take& take, double covered) {
    if (take.is_complete) return;
    if (choice.out.empty()) {
        fmt::print("to have the run's results as far as that: tactus replay {} --out FOLDER\n", choice.take.string());
        return;
    }
    fmt::print("the results in {} reach {:.3f} s{}, where the take ends\n", choice.out.string(), covered,
               take.about.seconds > covered ? fmt::format(" of {:.6g} s", take.about.seconds) : std::string());
}

int replay(const ReplayChoice& choice) {
    take::Take take = take::Take::load(choice.take);
    const std::vector<std::string> differences = take.differences(), changed = take.changed_assets();
    for (const std::string& difference : differences)
        fmt::print(stderr, "tactus: {}; the bits may differ\n", difference);
    for (const std::string& difference : changed) fmt::print(stderr, "tactus: {}\n", difference);
    if (!changed.empty() && !choice.anyway)
        throw Error("the take cannot be repeated with changed assets; use --anyway to try");

    const std::vector<take::TakeDamage> damages = take.damages();
    take.drop_unreadable_streams();
    compile::AssetCache assets;
    take::TakeComparison comparison(take);
    run::EngineOptions options;
    options.seconds = take.about.seconds;
    std::optional<OutputFolder> folder;
    if (!choice.out.empty()) {
        folder.emplace(OutputChoice{choice.out, choice.overwrite});
        options.folder = choice.out;
    }
    std::optional<take::TakeCopy> copy;
    if (!choice.record.empty()) copy.emplace(take, choice.record);
    options.tap = [&](const io::FrameLayout& layout, const run::GroupRuntime& group) -> std::unique_ptr<io::Sink> {
        std::unique_ptr<io::Sink> compared = comparison.tap(layout, group);
        return copy ? io::both_sinks(copy->sink(layout, group), std::move(compared)) : std::move(compared);
    };
    ReplayedTake repeated(take, options, assets);
    run::Engine& engine = repeated.engine();
    Progress shown;
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    engine.render(threads, [&](double done) { shown.show(done); });
    shown.clear();
    engine.complete();
    std::vector<std::string> losses = engine.losses();
    if (folder) {
        const Report report = engine.report();
        WrittenFiles written = write_results(report, folder->path());
        losses.insert(losses.end(), written.losses.begin(), written.losses.end());
        written.names.emplace_back("summary.json");
        try {
            const double covered = engine.progress_seconds();
            folder->write_summary(
                with_end(summary_json(engine, report, covered, false, written.names, losses), take, covered));
        } catch (const Error& error) {
            losses.emplace_back(error.what());
        }
    }
    for (const std::string& loss : losses) fmt::print(stderr, "tactus: {}\n", loss);

    const Verdict verdict{damages,
                          differing_hashes(take, engine),
                          comparison.first_difference(),
                          comparison.compared_values(),
                          take.result.size(),
                          take.is_complete,
                          take.values_end_s};
    // With other files, or when nothing could be compared, the values may not be those of the run.
    const bool is_of_run = verdict.is_equal_so_far() && changed.empty();
    if (copy && !is_of_run)
        fmt::print(stderr, "tactus: {} is not written, because {}\n", choice.record.string(),
                   verdict.differs() ? "the replay differs from the run"
                   : changed.empty() ? "the take has no values or hashes to compare the replay with"
                                     : "a file has changed since the run");
    else if (copy) copy->finish();
    const double covered = engine.progress_seconds();
    if (choice.json) {
        Json json{{"identical", verdict.is_identical()},
                  {"cut_off", !verdict.is_complete},
                  {"compared_values", verdict.compared},
                  {"values_end_s", verdict.values_end_s ? Json(*verdict.values_end_s) : Json()},
                  {"first_difference", verdict.first ? difference_json(*verdict.first) : Json()},
                  {"damaged_files", Json::array()},
                  {"differing_hashes", verdict.hashes},
                  {"seconds", covered},
                  {"whole", take.log.is_whole},
                  {"edits", engine.edits()},
                  {"notices", differences}};
        for (const take::TakeDamage& d : verdict.damages)
            json["damaged_files"].push_back(
                {{"file", d.file}, {"holds", d.holds}, {"written", d.written}, {"unit", d.unit}});
        fmt::print("{}\n", json.dump(2));
    } else {
        print(verdict, take.streams.size(), covered);
        print_end(choice, take, covered);
    }
    if (!losses.empty()) return output_lost;
    return verdict.is_equal_so_far() ? done : answer_is_no;
}

}  // namespace

namespace {

Action add_replay(VerbOptions& verb) {
    const auto choice = std::make_shared<ReplayChoice>();
    verb.add("take", choice->take, "folder of a take, made with --record").required();
    verb.output("-o,--out", choice->out, OutputFormat::folder(),
                "folder for the results: sounds, traces, bones, summary.json; of a run that was cut off as far as the "
                "take reaches");
    verb.output("--record", choice->record, OutputFormat::folder(),
                "write the take again into this folder, with every value of the run");
    verb.flag("--overwrite", choice->overwrite, "replace results that the folder already holds");
    verb.flag("--anyway", choice->anyway, "replay even if assets have changed");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return replay(*choice); };
}

}  // namespace

Verb replay_verb() { return {"replay", "repeat a take and compare every value, bit by bit", add_replay}; }

}  // namespace tactus::command
