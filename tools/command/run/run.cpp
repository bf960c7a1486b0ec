// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/run.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/run/sight_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/device_scale.hpp"
#include "tools/run/force_news.hpp"
#include "tools/run/live_table.hpp"
#include "tools/run/run_session.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/run/summary.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>

namespace tactus::command {

using namespace run;

namespace {

int run(const window::ViewedRunChoice& choice) {
    const std::atomic<bool>& interrupted = stop_on_signals();
    if (choice.view.wanted) return run_in_window(choice, interrupted);
    if (!choice.view.scan.empty()) throw Error("--scan: slices of a scan are shown in the window; add --view");
    compile::AssetCache assets;
    RunSession session(choice, assets);
    LiveLine line;
    auto next_table = std::chrono::steady_clock::now();
    std::size_t told = 0;
    const auto tell_losses = [&] {
        for (const auto losses = session.losses(); told < losses.size(); ++told) {
            line.clear();
            say(stderr, fmt::format("tactus: {}\n", losses[told]));
        }
    };
    const LetReturn way = choice.edits ? LetReturn::by_set : LetReturn::by_nothing;
    ForceNews news(way);
    const auto tell_forces = [&] {
        for (const std::string& text : news.next(session.engine())) {
            line.clear();
            say(stderr, text + "\n");
        }
    };
    const auto tend = [&] {
        tell_losses();
        tell_forces();
        const auto now = std::chrono::steady_clock::now();
        if (choice.json || !line.is_terminal() || now < next_table) return;
        next_table = now + std::chrono::milliseconds(200);
        line.show(live_table(session.engine(), way));
    };
    const auto tell = [&line](const std::string& said) {
        line.clear();
        say(stderr, said + "\n");
    };
    if (!choice.json)
        say(stderr, fmt::format("running {} for {}; Ctrl-C ends it\n", session.engine().plan().patch.title,
                                choice.seconds ? fmt::format("{} s", *choice.seconds) : "an unlimited time"));
    session.run({tend, tell}, interrupted);
    line.clear();
    tell_forces();  // what came after the last look
    session.finish();
    tell_losses();
    if (choice.json) say(stdout, session.summary_json());
    else say(stdout, fmt::format("{}  results in {}/\n", session.summary_text(), session.folder().string()));
    const std::vector<std::string> faults = unrecovered(session.engine());
    for (const std::string& fault : faults) say(stderr, fmt::format("tactus: {}\n", fault));
    if (!session.losses().empty()) return output_lost;
    return faults.empty() ? done : machine_failed;
}

}  // namespace

namespace {

Action add_run(VerbOptions& verb) {
    const auto choice = std::make_shared<window::ViewedRunChoice>();
    add_patch_options(verb, *choice);
    const auto site = std::make_shared<run::SiteText>();
    add_site_options(verb, *site);
    const auto saw = std::make_shared<run::SawChoice>();
    add_saw_options(verb, *saw);
    const auto scale = std::make_shared<std::optional<double>>();
    add_device_scale(verb, *scale);
    verb.add("--seconds", choice->seconds, "stop after this logical time, s").unit("s").range(1e-3, 1e6);
    verb.add("--dilate", choice->dilate, "real seconds per logical second").range(0.01, 1000.0);
    verb.add("--audio", choice->audio,
             "sound output: part of a card's name, default, file or none (default: a card if there is one)");
    verb.add("--audio-margin", choice->audio_margin, "sound buffered for the card in case a thread is late, ms")
        .unit("ms")
        .shows_default()
        .range(1.0, 2000.0);
    verb.output("-o,--out", choice->out, OutputFormat::folder(),
                "folder for the results (default: PATCH-run, or PATCH-run-2 and so on)");
    verb.flag("--overwrite", choice->overwrite, "replace results that the folder already holds");
    verb.output("--log", choice->log, OutputFormat::text(),
                "write the timing decisions to this file, for 'render --log'");
    add_record_options(verb, choice->record, choice->record_values);
    verb.flag("--json", choice->json, "print the summary as JSON and nothing else");
    const Option window =
        verb.flag("--view", choice->view.wanted,
                  "open a window with the patch, its values and the scene; edits take effect at once");
    verb.flag("--keep-running", choice->view.keep_running, "continue the run when the window is closed").needs(window);
    add_view_options(verb, choice->view);
    verb.flag("!--no-edits", choice->edits, "do not watch the patch file, and refuse 'set' and 'trigger'");
    return [choice, site, saw, scale] {
        run::choose_site(*choice, *site);
        use_saw(*choice, *saw);
        run::choose_device_scale(*choice, *scale);
        return run(*choice);
    };
}

}  // namespace

Verb run_verb() { return {"run", "run a patch in real time, until Ctrl-C or --seconds", add_run}; }

}  // namespace tactus::command
