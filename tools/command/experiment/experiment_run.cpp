// SPDX-License-Identifier: Apache-2.0
// tactus experiment run: a subject's session, with a person or simulated.
#include "assets/experiment/observer_model.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/experiment/run_experiment.hpp"
#include "tools/command/experiment/key_reader.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/run_session.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/terminal.hpp"
#include "tools/window/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct ExperimentRunChoice {
    std::string experiment, subject, model;
    fs::path out, view_script;
    std::vector<std::string> settings, assets;
    std::optional<double> registration;  // mm
    int simulated = 0;  // number of simulated subjects
    bool drops_takes = false, has_window = false;
};

/// Asks a person at the terminal.
class Person {
public:
    Person(bool has_window, fs::path view_script, const std::atomic<bool>& stop)
        : has_window_(has_window), view_script_(std::move(view_script)), stop_(stop) {}

    bool confirm(const std::string& text, char wanted) {
        say(stdout, text + "\n");
        while (const std::optional<char> key = keys_.read(stop_)) {
            if (*key == 'q') return false;
            if (wanted == 0 || *key == wanted) return true;
        }
        return false;
    }

    std::optional<analysis::Answered> ask(const experiment::Protocol& protocol) {
        say(stdout, question_of(protocol));
        keys_.forget();
        const auto begin = std::chrono::steady_clock::now();
        while (const std::optional<char> key = keys_.read(stop_)) {
            if (*key == 'q') return std::nullopt;
            const std::optional<int> answer = answer_of(protocol, *key);
            if (!answer) continue;
            const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
            return analysis::Answered{*answer, time.count()};
        }
        return std::nullopt;
    }

    analysis::LiveEnd perform(const experiment::Protocol& protocol, const run::RunChoice& choice,
                              const experiment::Condition& condition, std::atomic<bool>& over,
                              analysis::TurnedLevel* turned) {
        analysis::LiveEnd end;
        if (has_window_) {
            window::ViewedRunChoice viewed;
            static_cast<run::RunChoice&>(viewed) = choice;
            viewed.view.wanted = true;
            viewed.view.script = view_script_;
            if (!condition.display.empty()) viewed.view.sight.display = run::find_display(condition.display);
            viewed.view.sight.offset = condition.offset;
            // The window waits for `over` alone.
            const std::jthread forward([&](const std::stop_token& stopping) {
                while (!stopping.stop_requested()) {
                    if (stop_) over = true;
                    std::this_thread::sleep_for(std::chrono::milliseconds(20));
                }
            });
            if (window::view_run(viewed, over) == output_lost) end.losses.emplace_back("files of the run were lost");
            end.summary = file::read_whole_file(choice.out / "summary.json");
            return end;
        }
        run::RunSession run(choice, assets_);
        if (turned) {
            say(stdout, question_of(protocol));
            keys_.forget();
        }
        LiveLine line;
        run.run({[&] {
                     line.show(fmt::format("{:.1f} s of {:.1f} s", run.engine().progress_seconds(), *choice.seconds));
                     if (stop_) over = true;
                     if (turned) turned->answer_by_ports(run.engine());
                     // 'q' ends any trial at once. A pipe holds the answers of later trials.
                     if (!turned && !KeyReader::is_terminal()) return;
                     while (const std::optional<char> key = keys_.pressed()) {
                         const auto answer = answer_of(protocol, *key);
                         if (*key == 'q') end.is_ended = over = true;
                         else if (turned && answer) turned->answer(*answer, run.engine());
                     }
                 },
                 [](const std::string&) {}},
                over);
        line.clear();
        run.finish();
        end.summary = run.summary_json();
        end.losses = run.losses();
        return end;
    }

private:
    static std::string question_of(const experiment::Protocol& protocol) {
        const experiment::Response& response = protocol.response;
        std::string text = protocol.question.empty() ? std::string("Your answer?") : protocol.question;
        for (std::size_t i = 0; i < response.keys.size(); ++i)
            text += fmt::format("{} {} = {}", i == 0 ? "  [" : ",", response.keys[i], response.names[i]);
        return text + "; q ends]\n";
    }
    static std::optional<int> answer_of(const experiment::Protocol& protocol, char key) {
        const auto found = std::ranges::find(protocol.response.keys, std::string(1, key));
        if (found == protocol.response.keys.end()) return std::nullopt;
        return static_cast<int>(found - protocol.response.keys.begin());
    }

    bool has_window_;
    fs::path view_script_;
    const std::atomic<bool>& stop_;
    KeyReader keys_;
    compile::AssetCache assets_;
};

int run_one(const analysis::ExperimentChoice& choice, const analysis::ExperimentHooks& hooks,
            const std::atomic<bool>& stop, bool is_only) {
    const analysis::ExperimentEnd end = analysis::run_experiment(choice, hooks, stop);
    for (const std::string& loss : end.losses) say(stderr, fmt::format("tactus: {}\n", loss));
    say(stdout,
        fmt::format("{}: {}{}{}; {}\n", choice.subject, counted(static_cast<std::size_t>(end.trials), "trial"),
                    end.resumed > 0 ? fmt::format(" after {} of an earlier session", end.resumed) : std::string(),
                    end.marked > 0 ? fmt::format(", {} marked as beyond the limits", end.marked) : std::string(),
                    end.is_complete ? "complete" : "not complete; the same command resumes it"));
    if (is_only)
        say(stdout, fmt::format("protocol {}; data in {}; next: tactus experiment analyse {}\n", end.protocol_hash,
                                choice.out.string(), choice.out.string()));
    return end.losses.empty() ? done : output_lost;
}

int run_experiment_verb(const ExperimentRunChoice& options) {
    analysis::ExperimentChoice choice;
    choice.protocol = experiment::load_protocol(run::find_experiment(options.experiment));
    choice.out = options.out.empty() ? fs::path(choice.protocol.name + "-data") : options.out;
    choice.settings = options.settings;
    choice.assets = options.assets;
    choice.keeps_takes = !options.drops_takes;
    if (options.registration) choice.registration = 1e-3 * *options.registration;
    if (!options.model.empty())
        choice.model = experiment::load_observer_model(
            run::find_observer_model(options.model),
            choice.protocol.stimulus ? choice.protocol.stimulus->level_unit() : std::string());
    if (options.simulated > 0 && !choice.model) throw Error("--subjects needs --simulate: people come one at a time");
    if (options.simulated > 0 && !options.subject.empty())
        throw Error("--subjects names the subjects itself: S01, S02, …; leave --subject out");
    if (options.simulated == 0 && options.subject.empty()) throw Error("--subject PSEUDONYM is missing");
    if (options.drops_takes && !choice.model)
        throw Error("--no-takes is for simulated subjects: a person's trials cannot be had again");
    if (options.has_window && choice.protocol.is_adjustment())
        throw Error("--view: an adjustment is turned by keys of the terminal or ports of the patch; leave --view out");
    const std::atomic<bool>& stop = run::stop_on_signals();
    compile::AssetCache assets;
    analysis::check_levels(choice.protocol, assets, {}, nullptr);
    analysis::check_tasks(choice.protocol, assets, choice.settings);
    Person person(options.has_window, options.view_script, stop);
    LiveLine line;
    analysis::ExperimentHooks hooks;
    hooks.say = [&](const std::string& text) { say(stdout, text); };
    hooks.confirm = [&](const std::string& text, char key) { return person.confirm(text, key); };
    hooks.ask = [&](const experiment::Protocol& protocol) { return person.ask(protocol); };
    hooks.perform = [&](const run::RunChoice& run, const experiment::Condition& condition, std::atomic<bool>& over,
                        analysis::TurnedLevel* turned) {
        return person.perform(choice.protocol, run, condition, over, turned);
    };
    hooks.progress = [&](const analysis::TrialSpec& spec, int trials, int blocks) {
        if (choice.model)
            line.show(fmt::format("{}: trial {}, block {} of {}", choice.subject, trials, spec.block + 1, blocks));
    };
    if (options.simulated == 0) {
        choice.subject = options.subject;
        const int code = run_one(choice, hooks, stop, true);
        line.clear();
        return code;
    }
    if (const std::string warning =
            experiment::balance_warning(choice.protocol, static_cast<std::size_t>(options.simulated));
        !warning.empty())
        say(stderr, fmt::format("tactus: {}\n", warning));
    int worst = done;
    for (int subject = 1; subject <= options.simulated && !stop; ++subject) {
        choice.subject = fmt::format("S{:02}", subject);
        const int code = run_one(choice, hooks, stop, subject == options.simulated);
        worst = std::max(worst, code);
        line.clear();
    }
    return worst;
}

Action declare_experiment_run(VerbOptions& verb) {
    const auto choice = std::make_shared<ExperimentRunChoice>();
    verb.add("experiment", choice->experiment, "experiment file, or a name in the library").required();
    verb.add("--subject", choice->subject, "pseudonym: letters and digits; not a name");
    verb.output("-o,--out", choice->out, OutputFormat::folder(),
                "folder of the experiment's data, the same for all subjects; default: NAME-data");
    verb.add("--simulate", choice->model, "simulate the subject by this model file, or by one of the library");
    verb.add("--subjects", choice->simulated, "with --simulate: this many subjects, S01, S02, …").range(1, 1000);
    verb.add("--set", choice->settings, "NODE.PARAM=VALUE for all trials, as hand.device=touch; may be given again")
        .one_each();
    verb.add("--asset", choice->assets, "NAME=PATH for all trials; may be given again").one_each();
    verb.add("--registration", choice->registration,
             "largest error of the nine points by which the display was checked for this session, mm")
        .unit("mm")
        .positive();
    verb.flag("--no-takes", choice->drops_takes, "with --simulate: keep the numbers of each trial, but not its take");
    const Option view = verb.flag("--view", choice->has_window, "show each trial in a window");
    verb.add("--view-script", choice->view_script, "run the commands in this file in the window of each trial")
        .needs(view);
    return [choice] { return run_experiment_verb(*choice); };
}

}  // namespace

Verb experiment_run_verb() {
    return {"run", "run a subject's session; a session that was cut off is resumed at the trial",
            declare_experiment_run};
}

}  // namespace tactus::command
