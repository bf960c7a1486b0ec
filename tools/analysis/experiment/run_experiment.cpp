// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/run_experiment.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "tools/analysis/experiment/experiment_folder.hpp"
#include "tools/analysis/experiment/port_values.hpp"
#include "tools/analysis/experiment/simulated_subject.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tactus::analysis {

namespace fs = std::filesystem;
using experiment::Phase;
using experiment::Protocol;
using experiment::ResponseKind;
using experiment::Stimulus;
using experiment::TrialRecord;
using file::Json;

namespace {

constexpr const char* trials_name = "trials.jsonl";

/// What the summary of a run says of things that may spoil a trial.
void read_quality(const std::string& summary, TrialRecord& record) {
    const Json json = Json::parse(summary);
    record.output_hash = json["output_hash"].get<std::string>();
    record.seconds = json["seconds"].get<double>();
    for (const Json& group : json["groups"]) {
        const double ticks = group["ticks"].get<double>();
        const double lost = group["misses"].get<double>() + group["skipped"].get<double>();
        if (ticks > 0.0) record.missed = std::max(record.missed, lost / ticks);
        if (const Json* late = group.find("lateness_us"))
            record.gap = std::max(record.gap, 1e-6 * (*late)["max"].get<double>());
    }
    if (const Json* force = json.find("force")) {
        const double ticks = force->value("ticks", 0.0);
        const double limited = force->value("over_limit_ticks", 0.0) + force->value("slew_limited_ticks", 0.0);
        if (ticks > 0.0) record.limited = limited / ticks;
    }
}

std::string mark_of(const TrialRecord& record, const experiment::Limits& limits) {
    if (record.missed > limits.missed) return fmt::format("{:.3g} % of the ticks were missed", 100.0 * record.missed);
    if (record.gap > limits.gap) return fmt::format("a gap of {:.3g} ms", 1e3 * record.gap);
    if (record.limited > limits.limited)
        return fmt::format("the force was limited {:.3g} % of the time", 100.0 * record.limited);
    return {};
}

/// Level of a rendered stimulus: relative to what was rendered as the standard where there is one, as a person compares them.
std::optional<double> level_of(const Protocol& protocol, std::size_t condition, const std::vector<double>& rendered,
                               int interval) {
    if (interval < 1) return std::nullopt;
    const double value = rendered[static_cast<std::size_t>(interval - 1)];
    double standard = protocol.standard(condition);
    int others = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < rendered.size(); ++i)
        if (static_cast<int>(i) + 1 != interval && std::isfinite(rendered[i])) {
            sum += rendered[i];
            ++others;
        }
    if (others > 0) standard = sum / others;
    const double level = protocol.stimulus->is_relative ? value / standard - 1.0 : value - standard;
    return std::isfinite(level) ? std::optional(level) : std::nullopt;
}

std::vector<double> rendered_of(const Stimulus& stimulus, const PortValues& values) {
    std::vector<double> rendered;
    for (const experiment::Window& window : stimulus.windows)
        rendered.push_back(measure_of(stimulus.measure, values, window));
    return rendered;
}

/// The first answering port that becomes true after the last interval began.
std::optional<Answered> answer_of_ports(const Protocol& protocol, const PortValues& values) {
    std::optional<Answered> answer;
    for (std::size_t i = 0; i < protocol.response.ports.size(); ++i) {
        const PortSeries& series = values.at(protocol.response.ports[i]);
        const experiment::Window& last = protocol.stimulus->windows.back();
        bool before = true;  // held from the beginning is no answer
        for (std::size_t tick = 0; tick < series.values.size(); ++tick) {
            const double time = static_cast<double>(tick) * series.period;
            const bool now = series.values[tick] > 0.5;
            const bool pressed = now && !before;
            before = now;
            if (time < last.begin || !pressed) continue;
            if (!answer || time - last.end < answer->response_time)
                answer = Answered{static_cast<int>(i), time - last.end};
            break;
        }
    }
    return answer;
}

bool is_right(const Protocol& protocol, const TrialSpec& spec, int answer) {
    switch (protocol.response.kind) {
        case ResponseKind::choice: return answer == spec.interval - 1;
        case ResponseKind::yes_no:
        case ResponseKind::same_different: return (answer == 1) == (spec.interval > 0);
    }
    return false;
}

/// Time of the last line of a file of targets.
double end_of_targets(const std::string& text) {
    double last = 0.0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        double time = 0.0;
        if (std::sscanf(text.c_str() + begin, "%lf s:", &time) == 1) last = std::max(last, time);
        begin = end + 1;
    }
    return last;
}

class Session {
public:
    Session(const ExperimentChoice& choice, const ExperimentHooks& hooks, const std::atomic<bool>& stop)
        : choice_(choice), protocol_(choice.protocol), hooks_(hooks), stop_(stop), folder_(choice.out, protocol_) {}

    ExperimentEnd run() {
        ExperimentEnd end;
        end.protocol_hash = folder_.protocol_hash();
        // Before a row of the order is given away: a model may not suit the protocol.
        if (choice_.model) simulated_.emplace(*choice_.model, protocol_, choice_.subject);
        entry_ = folder_.enrol(choice_.subject, choice_.model.has_value());
        home_ = folder_.subject_folder(choice_.subject);
        std::error_code failure;
        fs::create_directories(home_, failure);
        if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", home_.string(), failure.message()));
        trials_ = experiment::load_trials(home_ / trials_name);
        end.resumed = static_cast<int>(trials_.size());
        SubjectSession session(protocol_, entry_.row, trials_);
        if (session.next() && prepare(end.resumed > 0)) {
            while (const std::optional<TrialSpec> spec = session.next()) {
                if (stop_) break;
                if (!pause_before(*spec, session)) break;
                const std::optional<TrialRecord> record = present(*spec, end);
                if (!record) break;
                trials_.push_back(*record);
                experiment::save_trials(trials_, home_ / trials_name);
                session.add(*record);
                ++end.trials;
                if (!record->marked.empty()) ++end.marked;
                if (hooks_.progress) hooks_.progress(*spec, session.done(), session.blocks());
            }
        }
        end.is_complete = !session.next();
        if (end.is_complete && !entry_.is_complete) {
            entry_.is_complete = true;
            folder_.update(entry_);
            if (!simulated_ && !protocol_.farewell.empty()) hooks_.say(protocol_.farewell + "\n");
        }
        end.subject = entry_;
        return end;
    }

private:
    /// Consent, registration, instructions. False: the session is not begun.
    bool prepare(bool is_resumed) {
        if (simulated_) return true;
        if (protocol_.needs_consent && entry_.consent.empty()) {
            if (!hooks_.confirm("Has the subject given informed consent in writing? y records it, q ends.", 'y'))
                return false;
            entry_.consent = plan::time_of_day();
            folder_.update(entry_);
        }
        if (protocol_.registration) {
            if (choice_.registration && *choice_.registration > *protocol_.registration)
                throw Error(fmt::format(
                    "--registration {:.3g} mm: the display must be registered within {:.3g} mm; calibrate it",
                    1e3 * *choice_.registration, 1e3 * *protocol_.registration));
            entry_.registration =
                choice_.registration ? fmt::format("{:.3g} mm", 1e3 * *choice_.registration) : "not measured";
            folder_.update(entry_);
        }
        if (is_rehearsal())
            hooks_.say(
                "This is a rehearsal: no haptic device is chosen, or the registration is not given. The analysis "
                "tests neither mode nor display from it.\n");
        return protocol_.welcome.empty() || is_resumed || hooks_.confirm(protocol_.welcome, 0);
    }

    /// A mouse or the patch's own simulated hand is no haptic device.
    bool is_rehearsal() const {
        if (simulated_) return false;
        if (protocol_.registration && !choice_.registration) return true;
        for (const std::string& setting : choice_.settings) {
            const std::size_t at = setting.find(".device=");
            if (at == std::string::npos) continue;
            const std::string device = setting.substr(at + 8);
            // Drivers that give a hand no force, or move it themselves.
            for (const char* other : {"mouse", "gamepad", "space_mouse", "simulated", "scripted", "replay",
                                      "openigtlink", "wqsm_gripper", "twum_gripper"})
                if (device == other) return true;
            return false;
        }
        return true;
    }

    bool pause_before(const TrialSpec& spec, const SubjectSession& session) {
        if (simulated_) return true;
        if (session.is_break_due() &&
            !hooks_.confirm(protocol_.pause.empty() ? "Have a break. Press a key to go on, q to end." : protocol_.pause,
                            0))
            return false;
        if (!spec.begins_block) return true;
        if (protocol_.is_psychophysics()) return true;
        const experiment::Task& task = protocol_.tasks[spec.task];
        return hooks_.confirm(fmt::format("Block {} of {}, condition {}. {}", spec.block + 1, session.blocks(),
                                          protocol_.conditions[spec.condition].name, task.instruction),
                              0);
    }

    /// None: the session ends, and this trial is not kept.
    std::optional<TrialRecord> present(const TrialSpec& spec, ExperimentEnd& end) {
        TrialRecord record;
        record.number = spec.number;
        record.block = spec.block;
        record.phase = spec.phase;
        record.condition = protocol_.conditions[spec.condition].name;
        record.level = spec.level;
        record.interval = spec.interval;
        record.folder = fmt::format("trial-{:04}", spec.number);
        record.is_simulated = simulated_.has_value();
        record.is_rehearsal = is_rehearsal();
        const fs::path at = home_ / record.folder;
        // What a trial left that was cut off.
        std::error_code failure;
        fs::remove_all(at, failure);
        fs::create_directories(at, failure);
        if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", at.string(), failure.message()));
        run::RunChoice run = trial_choice(protocol_, spec);
        run.overrides.settings.insert(run.overrides.settings.end(), choice_.settings.begin(), choice_.settings.end());
        run.overrides.assets.insert(run.overrides.assets.end(), choice_.assets.begin(), choice_.assets.end());
        run.out = at / "run";
        run.record = at / "take";
        run.edits = false;
        if (!protocol_.is_psychophysics()) {
            record.task = protocol_.tasks[spec.task].name;
            if (simulated_) {
                const std::string targets = simulated_->hand_targets(spec);
                file::write_whole_file(at / "hand.txt", targets);
                run.overrides.assets.push_back("hand=" + (at / "hand.txt").string());
                run.seconds = std::min(*run.seconds, end_of_targets(targets) + 0.5);
            }
        }
        PortCollector collector(ports_of(protocol_, spec.task),
                                protocol_.is_psychophysics() ? std::string() : protocol_.tasks[spec.task].done);
        run.tap = collector.tap();
        const std::size_t losses = end.losses.size();
        perform(spec, run, collector, record, end);
        // A trial that was cut short, by Ctrl-C or by closing the window, is not kept.
        if (stop_ || (!simulated_ && !collector.over() && record.seconds < 0.99 * *run.seconds)) return std::nullopt;
        const PortValues values = collector.values();
        if (protocol_.is_psychophysics()) {
            if (!answer(spec, values, record)) return std::nullopt;
        } else {
            const experiment::Task& task = protocol_.tasks[spec.task];
            for (const experiment::Measure& measure : task.measures)
                if (const double value = measure_of(measure, values); std::isfinite(value))
                    record.measures[measure.name] = value;
            record.is_finished = task.done.empty() || std::ranges::any_of(values.at(task.done).values,
                                                                          [](double value) { return value > 0.5; });
        }
        if (end.losses.size() > losses) record.marked = "the take is not whole";
        if (record.marked.empty()) record.marked = mark_of(record, protocol_.limits);
        if (record.marked.empty()) record.marked = level_mark(record);
        if (!choice_.keeps_takes) fs::remove_all(at, failure);
        return record;
    }

    /// Late ticks, a fault, or a hand that did not explore an interval leave another stimulus than the wanted one.
    std::string level_mark(const TrialRecord& record) const {
        if (!protocol_.is_psychophysics() || record.interval == 0) return {};
        const std::string unit = protocol_.stimulus->level_unit();
        if (!record.rendered_level) return "an interval has nothing that can be measured";
        if (protocol_.stimulus->is_rendered(record.level, *record.rendered_level)) return {};
        return fmt::format("the device was commanded level {}", format_quantity(*record.rendered_level, unit));
    }

    void perform(const TrialSpec& spec, const run::RunChoice& run, PortCollector& collector, TrialRecord& record,
                 ExperimentEnd& end) {
        if (simulated_) {
            const run::RenderedRun rendered = run::render_run(run, assets_, stop_, [](double) {});
            end.losses.insert(end.losses.end(), rendered.losses.begin(), rendered.losses.end());
            read_quality(rendered.summary, record);
            return;
        }
        const LiveEnd live = hooks_.perform(run, protocol_.conditions[spec.condition], collector.over());
        end.losses.insert(end.losses.end(), live.losses.begin(), live.losses.end());
        read_quality(live.summary, record);
    }

    bool answer(const TrialSpec& spec, const PortValues& values, TrialRecord& record) {
        const Stimulus& stimulus = *protocol_.stimulus;
        record.rendered = rendered_of(stimulus, values);
        record.rendered_level = level_of(protocol_, spec.condition, record.rendered, spec.interval);
        std::optional<Answered> given;
        if (simulated_) {
            const SimulatedAnswer one = simulated_->answer(spec, record.rendered_level);
            given = Answered{one.answer, one.response_time};
        } else {
            if (!protocol_.response.ports.empty()) given = answer_of_ports(protocol_, values);
            if (!given) given = hooks_.ask(protocol_);
        }
        if (!given) return false;
        record.answer = given->answer;
        record.response_time = given->response_time;
        record.is_correct = is_right(protocol_, spec, given->answer);
        return true;
    }

    const ExperimentChoice& choice_;
    const Protocol& protocol_;
    const ExperimentHooks& hooks_;
    const std::atomic<bool>& stop_;
    ExperimentFolder folder_;
    experiment::SubjectEntry entry_;
    fs::path home_;
    std::vector<TrialRecord> trials_;
    std::optional<SimulatedSubject> simulated_;
    compile::AssetCache assets_;
};

}  // namespace

run::RunChoice trial_choice(const Protocol& protocol, const TrialSpec& spec) {
    run::RunChoice run;
    const experiment::Condition& condition = protocol.conditions[spec.condition];
    auto& settings = run.overrides.settings;
    if (protocol.is_psychophysics()) {
        run.patch = protocol.patch.string();
        run.seconds = protocol.length;
        settings = protocol.settings;
        settings.insert(settings.end(), condition.settings.begin(), condition.settings.end());
        const Stimulus& stimulus = *protocol.stimulus;
        const double factor = parse_unit(stimulus.unit).factor;
        for (std::size_t i = 0; i < stimulus.parameters.size(); ++i) {
            const bool has = static_cast<int>(i) + 1 == spec.interval;
            const double si = has ? protocol.parameter(spec.condition, spec.level) : protocol.standard(spec.condition);
            settings.push_back(fmt::format("{}={} {}", stimulus.parameters[i], si / factor, stimulus.unit));
            if (stimulus.unit.empty()) settings.back().pop_back();
        }
    } else {
        const experiment::Task& task = protocol.tasks[spec.task];
        run.patch = task.patch.string();
        run.seconds = task.length;
        settings = task.settings;
        settings.insert(settings.end(), condition.settings.begin(), condition.settings.end());
    }
    return run;
}

void check_levels(const Protocol& protocol, compile::AssetCache& assets, const std::vector<std::string>& more,
                  const std::function<void(const std::string&)>& say) {
    if (!protocol.is_psychophysics()) return;
    const Stimulus& stimulus = *protocol.stimulus;
    const std::atomic<bool> never{false};
    for (std::size_t condition = 0; condition < protocol.conditions.size(); ++condition)
        for (const double level : {stimulus.min, stimulus.max})
            for (int interval = 1; interval <= static_cast<int>(stimulus.parameters.size()); ++interval) {
                const run::ScratchFolder scratch;
                TrialSpec spec;
                spec.condition = condition;
                spec.level = level;
                spec.interval = interval;
                run::RunChoice run = trial_choice(protocol, spec);
                run.overrides.settings.insert(run.overrides.settings.end(), more.begin(), more.end());
                run.out = scratch.path() / "run";
                PortCollector collector(ports_of(protocol, 0));
                run.tap = collector.tap();
                TrialRecord record;
                read_quality(run::render_run(run, assets, never, [](double) {}).summary, record);
                const std::vector<double> rendered = rendered_of(stimulus, collector.values());
                const std::optional<double> got = level_of(protocol, condition, rendered, interval);
                const std::string where =
                    fmt::format("condition {}, interval {}, level {}", protocol.conditions[condition].name, interval,
                                format_quantity(level, stimulus.level_unit()));
                if (!got || !stimulus.is_rendered(level, *got))
                    throw Error(fmt::format(
                        "{}: {}: the device is commanded {}, which misses the level by more than {:.3g} %; "
                        "change the range of levels or the patch",
                        protocol.file.string(), where, got ? format_quantity(*got, stimulus.level_unit()) : "nothing",
                        100.0 * stimulus.tolerance));
                if (record.limited > protocol.limits.limited)
                    throw Error(
                        fmt::format("{}: {}: the force is limited {:.3g} % of the time; change the range of levels",
                                    protocol.file.string(), where, 100.0 * record.limited));
                if (say) say(fmt::format("{}: commanded {}\n", where, format_quantity(*got, stimulus.level_unit())));
            }
}

void check_tasks(const Protocol& protocol, compile::AssetCache& assets, const std::vector<std::string>& more) {
    for (std::size_t task = 0; task < protocol.tasks.size(); ++task)
        for (std::size_t condition = 0; condition < protocol.conditions.size(); ++condition) {
            TrialSpec spec;
            spec.task = task;
            spec.condition = condition;
            run::RunChoice run = trial_choice(protocol, spec);
            run.overrides.settings.insert(run.overrides.settings.end(), more.begin(), more.end());
            if (!protocol.tasks[task].ideal.empty())
                run.overrides.assets.push_back("hand=" + protocol.tasks[task].ideal.string());
            check_ports(run::load_plan(run, assets), ports_of(protocol, task));
        }
}

ExperimentEnd run_experiment(const ExperimentChoice& choice, const ExperimentHooks& hooks,
                             const std::atomic<bool>& stop) {
    return Session(choice, hooks, stop).run();
}

}  // namespace tactus::analysis
