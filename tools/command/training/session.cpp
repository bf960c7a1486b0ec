// SPDX-License-Identifier: Apache-2.0
// tactus session: a trainee's tasks in order, with their takes, resumed after a crash.
#include "assets/bone/content_hash.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "assets/training/task_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/report/training/score_result.hpp"
#include "tools/run/device_scale.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/run_session.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/run/summary.hpp"
#include "tools/run/training_session.hpp"
#include "tools/terminal.hpp"
#include "tools/window/view.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

using namespace run;

namespace {

namespace fs = std::filesystem;

struct SessionChoice {
    std::vector<std::string> tasks;
    std::string trainee;
    fs::path out;
    window::ViewedRunChoice run;  // what all attempts share
    std::optional<double> device_scale;
    SawChoice saw;
    bool offline = false, is_new = false;
};

/// What an attempt came to. `code` is the exit code that its failures stand for.
struct AttemptEnd {
    double seconds = 0.0;
    int code = done;
};

window::ViewedRunChoice attempt_choice(const SessionChoice& choice, const training::TaskFile& task,
                                       const fs::path& at) {
    window::ViewedRunChoice run = choice.run;
    run.patch = task.patch.empty() ? "saw-task" : task.patch;
    run.overrides.settings = task.settings;
    choose_device_scale(run, choice.device_scale);
    // What the command line says is said last, and wins.
    run.overrides.settings.insert(run.overrides.settings.end(), choice.run.overrides.settings.begin(),
                                  choice.run.overrides.settings.end());
    run.overrides.assets = {"task=" + task.file.string(), "bone=" + task.bone.string()};
    run.overrides.assets.insert(run.overrides.assets.end(), choice.run.overrides.assets.begin(),
                                choice.run.overrides.assets.end());
    choose_saw(run, choice.saw);
    if (!run.seconds) run.seconds = task.length;
    run.out = at / "run";
    run.record = at / "take";
    run.edits = false;
    return run;
}

AttemptEnd tell(double seconds, const std::vector<std::string>& losses, const std::vector<std::string>& faults) {
    for (const std::string& loss : losses) say(stderr, fmt::format("tactus: {}\n", loss));
    for (const std::string& fault : faults) say(stderr, fmt::format("tactus: {}\n", fault));
    return {seconds, losses.empty() && faults.empty() ? done : output_lost};
}

AttemptEnd make_attempt(const window::ViewedRunChoice& choice, bool offline, compile::AssetCache& assets,
                        const std::atomic<bool>& stop) {
    if (choice.view.wanted) {
        const int code = window::view_run(choice, stop);
        return {choice.seconds.value(), code};
    }
    LiveLine line;
    if (offline) {
        const RenderedRun run =
            render_run(choice, assets, stop, [&](double share) { line.show(fmt::format("{:3.0f} %", 100.0 * share)); });
        line.clear();
        return tell(run.seconds, run.losses, run.faults);
    }
    RunSession run(choice, assets);
    run.run({[&] {
                 line.show(fmt::format("{:.0f} s of {:.0f} s; Ctrl-C ends the attempt and the session",
                                       run.engine().progress_seconds(), *choice.seconds));
             },
             [](const std::string&) {}},
            stop);
    line.clear();
    run.finish();
    return tell(run.engine().progress_seconds(), run.losses(), unrecovered(run.engine()));
}

/// Scores what was done; a failure is told, and the session goes on: the score can be made again.
void keep_score(const fs::path& attempt) {
    try {
        const analysis::ScoredRun run = analysis::score_run(attempt);
        const report::Result score = report::score_result({{&run, 1}, {}});
        file::write_whole_file(attempt / "score.json", report::output_json(score).dump(2) + "\n");
        say(stdout, report::text_of(score));
    } catch (const Error& error) {
        say(stderr, fmt::format("tactus: no score: {}\n", error.what()));
    }
}

/// Another bone than the task's could be cut, but not scored.
void check_bone(const SessionChoice& choice, const training::TaskFile& task) {
    for (const std::string& asset : choice.run.overrides.assets) {
        if (!asset.starts_with("bone=")) continue;
        if (bone::content_hash(bone::load_bone(asset.substr(5))) != bone::content_hash(bone::load_bone(task.bone)))
            throw Error(
                fmt::format("--asset {}: is another bone than {} of the task '{}', so its cut could not be "
                            "scored; write a task file for it",
                            asset, task.bone.string(), task.title));
    }
}

int run_session(const SessionChoice& choice) {
    TrainingSession::Choice wanted{choice.trainee, choice.out, {}, choice.is_new};
    check_pseudonym(choice.trainee);
    std::vector<training::TaskFile> tasks;
    compile::AssetCache assets;
    for (const std::string& name : choice.tasks) {
        const fs::path file = fs::absolute(find_task(name));
        // Everything is read before anything is made: an error of the last task must not end a session halfway.
        const training::Task task = training::load_task(file);
        wanted.tasks.push_back({file.stem().string(), file, task.hash});
        tasks.push_back(task);
        check_bone(choice, task);
        load_plan(attempt_choice(choice, task, "attempt"), assets);
    }
    if (!choice.saw.file.empty())
        if (const std::string question =
                sound::saw_question(sound::load_recording_set(choice.saw.file, choice.saw.rate));
            !question.empty())
            say(stderr, fmt::format("tactus: {}\n", question));
    TrainingSession session(wanted);
    if (session.is_resumed())
        say(stderr, fmt::format("resuming {}: {} of {} tasks were completed\n", session.folder().string(),
                                session.done(), session.count()));
    const std::atomic<bool>& stop = stop_on_signals();
    int worst = done;
    while (!session.is_complete() && !stop) {
        const training::TaskFile& task = tasks[session.done()];
        const fs::path attempt = session.next_attempt();
        say(stderr, fmt::format("task {} of {}: {}\n{}{}", session.done() + 1, session.count(), task.title, task.about,
                                task.about.empty() ? "" : "\n"));
        const window::ViewedRunChoice run = attempt_choice(choice, task, attempt);
        const AttemptEnd end = make_attempt(run, choice.offline, assets, stop);
        session.complete_attempt(end.seconds, stop);
        worst = std::max(worst, end.code);
        keep_score(attempt);
    }
    if (!session.is_complete()) {
        say(stderr, fmt::format("tactus: {} of {} tasks were completed; the same command goes on with the next\n",
                                session.done(), session.count()));
        return worst == done ? answer_is_no : worst;
    }
    say(stdout, fmt::format("session complete: {}\n", session.folder().string()));
    return worst;
}

Action declare_session(VerbOptions& verb) {
    const auto choice = std::make_shared<SessionChoice>();
    verb.add("tasks", choice->tasks, "task files, or names in the library such as mandible-canal, in their order")
        .required();
    verb.add("--trainee", choice->trainee, "pseudonym of the trainee: letters, digits, '-', '_', '.'; not a name")
        .required();
    verb.output("-o,--out", choice->out, OutputFormat::folder(),
                "folder of all sessions; this one is DIR/PSEUDONYM/NUMBER")
        .required();
    verb.flag("--new", choice->is_new, "begin another session although the last one is not complete");
    verb.flag("--offline", choice->offline, "render the attempts instead of running them in real time");
    verb.add("--seconds", choice->run.seconds, "length of each attempt, s (default: that of the task)")
        .unit("s")
        .range(1e-3, 1e5);
    add_override_options(verb, choice->run);
    add_device_scale(verb, choice->device_scale);
    add_saw_options(verb, choice->saw);
    verb.add("--audio", choice->run.audio, "sound output: part of a card's name, default, file or none");
    verb.flag("--view", choice->run.view.wanted, "open a window for each attempt; closing it ends the attempt");
    return [choice] { return run_session(*choice); };
}

}  // namespace

Verb session_verb() {
    return {"session", "run training tasks in order for a trainee; keeps takes and scores, and resumes after a crash",
            declare_session};
}

}  // namespace tactus::command
