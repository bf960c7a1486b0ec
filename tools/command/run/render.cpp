// SPDX-License-Identifier: Apache-2.0
#include "tools/command/patch_options.hpp"
#include "tools/command/progress.hpp"
#include "tools/command/run/sight_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/render/frames.hpp"
#include "tools/run/device_scale.hpp"
#include "tools/run/kept_assets.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/output_folder.hpp"
#include "tools/run/results.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/run/summary.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <thread>

namespace tactus::command {

using namespace run;
using namespace render;

namespace {

struct RenderChoice : PatchChoice {
    double seconds = 10.0;
    std::filesystem::path out;
    int threads = 0;      // 0: one per core
    std::string block;    // "", a number, or "random"
    std::filesystem::path log, record;
    bool record_values = true;
    bool overwrite = false;  // replace existing results
    FrameChoice frames;
    bool json = false;
};

int parse_block(const std::string& text) {
    int block = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), block);
    if (failure != std::errc{} || end != text.data() + text.size() || block < 1 || block > 65536)
        throw Error(fmt::format("--block must be a number from 1 to 65536 or 'random', not '{}'", text));
    return block;
}

int render(const RenderChoice& choice) {
    run::EngineOptions options;
    options.seconds = choice.seconds;
    options.random_blocks = choice.block == "random";
    if (options.random_blocks) options.block = 480;
    else if (!choice.block.empty()) options.block = parse_block(choice.block);
    std::optional<take::TimingLog> log;
    if (!choice.log.empty()) {
        log = take::TimingLog::load(choice.log);
        options.replay = &*log;
        options.seconds = log->seconds;
    }
    compile::Schedule plan = load_plan(choice, kept_assets());
    OutputFolder folder({choice.out, choice.overwrite});
    options.folder = folder.path();
    const std::atomic<bool>& interrupted = stop_on_signals();
    std::unique_ptr<take::TakeWriter> take;
    if (!choice.record.empty()) {
        take = make_take(choice, choice.record, options.seconds, false);
        options.take = take.get();
        if (!choice.record_values) take->limit_values(take::max_first_bytes);
    }
    std::unique_ptr<FrameWriter> frames;
    if (choice.frames.frames > 0) {
        frames = std::make_unique<FrameWriter>(choice.frames, outline_of(plan), options.seconds, folder.path());
        options.observer = &frames->observer();
    }
    run::Engine engine(std::move(plan), options);
    const int threads =
        choice.threads > 0 ? choice.threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));

    Progress shown;
    const auto begin = std::chrono::steady_clock::now();
    engine.render(threads, [&](double done) {
        if (interrupted) engine.stop();
        if (frames) frames->advance(engine.progress_seconds() - 1e-6);
        shown.show(done, fmt::format("{:.1f} s of {:.1f} s", done * options.seconds, options.seconds));
    });
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double ran = engine.progress_seconds();
    const bool is_whole = !interrupted || ran >= options.seconds;
    if (frames) frames->advance(is_whole ? options.seconds : ran - 1e-6);
    shown.clear();
    engine.complete();
    const Report report = engine.report();
    WrittenFiles written = write_results(report, folder.path());
    std::vector<std::string> losses = engine.losses();
    if (frames) {
        written.names.insert(written.names.end(), frames->files().begin(), frames->files().end());
        losses.insert(losses.end(), frames->losses().begin(), frames->losses().end());
    }
    losses.insert(losses.end(), written.losses.begin(), written.losses.end());
    written.names.emplace_back("summary.json");
    const double seconds = is_whole ? options.seconds : ran;
    const std::string summary = summary_json(engine, report, seconds, false, written.names, losses);
    try {
        folder.write_summary(summary);
    } catch (const Error& error) {
        losses.emplace_back(error.what());
    }
    for (const std::string& loss : losses) say(stderr, fmt::format("tactus: {}\n", loss));
    say(stdout, choice.json ? summary : summary_text(engine, report, seconds, wall));
    const std::vector<std::string> faults = unrecovered(engine);
    for (const std::string& fault : faults) say(stderr, fmt::format("tactus: {}\n", fault));
    if (!losses.empty()) return output_lost;
    if (!faults.empty()) return machine_failed;
    if (is_whole) return done;
    say(stderr, fmt::format("tactus: ended at {:.3f} s of {:.3f} s\n", ran, options.seconds));
    return answer_is_no;
}

}  // namespace

namespace {

void add_frame_options(VerbOptions& verb, FrameChoice& choice) {
    const Option frames = verb.add("--frames", choice.frames,
                                   "number of pictures of the scene, evenly spaced in time: frame_0001.png, ...")
                              .range(1, 100000);
    const auto add = [&](const char* name, std::string& value, const char* about) {
        verb.add(name, value, about).shows_default().needs(frames);
    };
    add("--view-from", choice.view_from, "front, back, left, right, top, bottom, iso (front left) or tool (its side)");
    add("--size", choice.size, "size of the pictures in pixels, WIDTHxHEIGHT");
    add("--clip", choice.clip,
        "clip the scene at a plane: x, -y, \"z=12 mm\", 1,1,0; what is cut shows its density in grey");
    add("--map", choice.map, "colour a plan's fragments: gaps (to what faces them) or mirror (from the healthy side)");
    add("--map-range", choice.map_range, "distance of the fullest colour of --map");
    verb.flag("--no-legend", choice.has_no_legend, "with --frames: without legend and scale, for small pictures");
    add_sight_options(verb, choice.sight, &frames);
}

Action add_render(VerbOptions& verb) {
    const auto choice = std::make_shared<RenderChoice>();
    add_patch_options(verb, *choice);
    const auto site = std::make_shared<run::SiteText>();
    add_site_options(verb, *site);
    const auto saw = std::make_shared<run::SawChoice>();
    add_saw_options(verb, *saw);
    const auto scale = std::make_shared<std::optional<double>>();
    add_device_scale(verb, *scale);
    verb.add("--seconds", choice->seconds, "logical time to render, s").unit("s").shows_default().range(1e-3, 1e6);
    verb.output("-o,--out", choice->out, OutputFormat::folder(), "folder for the results").required();
    verb.flag("--overwrite", choice->overwrite, "replace results that the folder already holds");
    verb.add("--jobs", choice->threads, "threads, 0: one per core").range(0, 64);
    verb.old("--threads", "--jobs");
    verb.add("--block", choice->block, "greatest number of samples per call, or 'random'; does not change the output");
    verb.add("--log", choice->log, "use the timing decisions of a live run, from a file of 'run --log'");
    add_record_options(verb, choice->record, choice->record_values);
    add_frame_options(verb, choice->frames);
    verb.flag("--json", choice->json, "print the summary as JSON");
    return [choice, site, saw, scale] {
        run::choose_site(*choice, *site);
        use_saw(*choice, *saw);
        run::choose_device_scale(*choice, *scale);
        return render(*choice);
    };
}

}  // namespace

Verb render_verb() { return {"render", "run a patch offline, as fast as possible", add_render}; }

}  // namespace tactus::command
