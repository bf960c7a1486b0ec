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
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
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

constexpr const char *trials_name = "trials.jsonl", *sound_node = "audio_output";

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
    record.sound_limited = 0.0;
    for (const auto& [name, section] : json.items())
        if (section.is_object() && section.contains("clipped_samples"))
            if (const double samples = section.value("samples", 0.0); samples > 0.0)
                record.sound_limited = std::max(record.sound_limited, section.value("clipped_samples", 0.0) / samples);
}

/// Throws Error when an output that the protocol limits would play louder.
void check_sound(const Protocol& protocol, const compile::Schedule& plan, const std::string& summary,
                 const std::string& where) {
    const Json json = Json::parse(summary);
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (node.type->name != sound_node || !json.contains(node.name)) continue;
        const Json& played = json[node.name];
        const double limit = node.params.at("limit")->value, peak = played.value("peak", 0.0);
        if (!(played.value("clipped_samples", 0.0) > 0.0)) continue;
        throw Error(
            fmt::format("{}: {}: '{}' would play {:.1f} dBFS ({:.3g} of the signal), louder than its limit of {:.1f} "
                        "dBFS ({:.3g}); "
                        "make the sound quieter, or change the limit in [limits]",
                        protocol.file.string(), where, node.name, 20.0 * std::log10(peak),
                        peak * node.params.at("full_scale")->value, 20.0 * std::log10(limit),
                        limit * node.params.at("full_scale")->value));
    }
}

std::string mark_of(const TrialRecord& record, const experiment::Limits& limits) {
    if (record.missed > limits.missed) return fmt::format("{:.3g} % of the ticks were missed", 100.0 * record.missed);
    if (record.gap > limits.gap) return fmt::format("a gap of {:.3g} ms", 1e3 * record.gap);
    if (record.limited > limits.limited)
        return fmt::format("the force was limited {:.3g} % of the time", 100.0 * record.limited);
    if (record.sound_limited > limits.limited)
        return fmt::format("the sound was limited {:.3g} % of the time", 100.0 * record.sound_limited);
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
        case ResponseKind::adjust: return answer == 2;
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
    Session(const ExperimentChoice& choice, const ExperimentHooks& hooks, const std::atomic<bool>& stop,
            compile::AssetCache& assets)
        : choice_(choice),
          protocol_(choice.protocol),
          hooks_(hooks),
          stop_(stop),
          assets_(assets),
          folder_(choice.out, protocol_) {}

    ExperimentEnd run() {
        ExperimentEnd end;
        end.protocol_hash = folder_.protocol_hash();
        // Before a row of the order is given away: a model may not suit the protocol, and a table of orders may end.
        if (choice_.model) simulated_.emplace(*choice_.model, protocol_, choice_.subject);
        (void)experiment::condition_order(protocol_, folder_.row_of(choice_.subject));
        entry_ = folder_.enrol(choice_.subject, choice_.model.has_value());
        home_ = folder_.subject_folder(choice_.subject);
        std::error_code failure;
        fs::create_directories(home_, failure);
        if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", home_.string(), failure.message()));
        trials_ = experiment::load_trials(home_ / trials_name);
        end.resumed = static_cast<int>(trials_.size());
        note_settings();
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
    /// Trials of one subject must not differ in what the command line set.
    void note_settings() {
        std::vector<std::string> settings = choice_.settings;
        for (const std::string& asset : choice_.assets) settings.push_back("asset " + asset);
        if (entry_.settings && by_key(settings) == by_key(*entry_.settings)) return;
        if (!trials_.empty() && entry_.settings)
            throw Error(
                fmt::format("{}: the trials of {} were run with {}, and now with {}; resume the session with the same "
                            "--set and --asset, or withdraw the subject and begin anew",
                            choice_.out.string(), entry_.pseudonym, listed(*entry_.settings), listed(settings)));
        entry_.settings = std::move(settings);
        folder_.update(entry_);
    }

    /// Those of one key stay in their order: the last one counts.
    static std::vector<std::string> by_key(std::vector<std::string> settings) {
        std::ranges::stable_sort(settings, {}, [](const std::string& one) { return one.substr(0, one.find('=')); });
        return settings;
    }

    static std::string listed(const std::vector<std::string>& settings) {
        return settings.empty() ? std::string("none") : fmt::format("'{}'", fmt::join(settings, "', '"));
    }

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
        bool has_rehearsal = false;
        for (std::size_t task = 0; task < std::max<std::size_t>(protocol_.tasks.size(), 1); ++task)
            has_rehearsal = has_rehearsal || is_rehearsal(task);
        if (has_rehearsal)
            hooks_.say(
                "This is a rehearsal: no haptic device is chosen, or the registration is not given. The analysis "
                "tests neither mode nor display from it.\n");
        return protocol_.welcome.empty() || is_resumed || hooks_.confirm(protocol_.welcome, 0);
    }

    /// A mouse or the patch's own simulated hand is no haptic device.
    bool is_rehearsal(std::size_t task) {
        if (simulated_) return false;
        if (protocol_.registration && !choice_.registration) return true;
        if (!has_hand(task)) return false;  // a sound card is the device
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

    bool has_hand(std::size_t task) {
        const auto [found, is_new] = has_hand_.try_emplace(task);
        if (is_new) {
            TrialSpec spec;
            spec.task = task;
            const compile::Schedule plan = run::load_plan(trial_choice(protocol_, spec), assets_);
            found->second = std::ranges::any_of(plan.nodes, [](const compile::ScheduleNode& node) {
                return node.type->role == NodeRole::hand_source || node.type->role == NodeRole::motor_sink;
            });
        }
        return found->second;
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
        record.is_rehearsal = is_rehearsal(spec.task);
        const fs::path at = home_ / record.folder;
        // What a trial left that was cut off.
        std::error_code failure;
        fs::remove_all(at, failure);
        if (failure) throw Error(fmt::format("{}: cannot be deleted: {}", at.string(), failure.message()));
        run::RunChoice run = trial_choice(protocol_, spec);
        run.overrides.settings.insert(run.overrides.settings.end(), choice_.settings.begin(), choice_.settings.end());
        run.overrides.assets.insert(run.overrides.assets.end(), choice_.assets.begin(), choice_.assets.end());
        if (!protocol_.limits.sound.empty()) {
            const auto caps = sound_settings(protocol_, run::load_plan(run, assets_));
            run.overrides.settings.insert(run.overrides.settings.end(), caps.begin(), caps.end());
        }
        run.out = at / "run";
        run.record = at / "take";
        run.edits = false;
        if (!protocol_.is_psychophysics()) {
            record.task = protocol_.tasks[spec.task].name;
            if (simulated_) {
                const std::string targets = simulated_->hand_targets(spec);
                fs::create_directories(at, failure);
                if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", at.string(), failure.message()));
                file::write_whole_file(at / "hand.txt", targets);
                run.overrides.assets.push_back("hand=" + (at / "hand.txt").string());
                run.seconds = std::min(*run.seconds, end_of_targets(targets) + 0.5);
            }
        }
        PortCollector collector(ports_of(protocol_, spec.task),
                                protocol_.is_psychophysics() ? std::string() : protocol_.tasks[spec.task].done,
                                protocol_.is_adjustment() ? protocol_.response.ports : std::vector<std::string>());
        run.tap = collector.tap();
        const std::size_t losses = end.losses.size();
        std::optional<TurnedLevel> turned;
        if (protocol_.is_adjustment()) turned.emplace(protocol_, spec, collector);
        if (!perform(spec, run, collector, turned ? &*turned : nullptr, record, end)) return std::nullopt;
        // A trial that was cut short, by Ctrl-C or by closing the window, is not kept.
        if (stop_ || (!simulated_ && !collector.over() && record.seconds < 0.99 * *run.seconds)) return std::nullopt;
        const PortValues values = collector.values();
        if (turned) {
            record.turns = turned->turns();
            record.response_time = turned->matched_at();
            if (turned->matched_at()) record.match = turned->level();
            record.answer = turned->matched_at() ? 2 : -1;
            record.is_correct = is_right(protocol_, spec, record.answer);
            read_rendered(spec, values, record);
        } else if (protocol_.is_psychophysics()) {
            if (!answer(spec, values, record)) return std::nullopt;
        } else {
            const experiment::Task& task = protocol_.tasks[spec.task];
            for (const experiment::Measure& measure : task.measures)
                if (const double value = measure_of(measure, values); std::isfinite(value))
                    record.measures[measure.name] = value;
            record.is_finished = task.done.empty() || std::ranges::any_of(values.at(task.done).values,
                                                                          [](double value) { return value > 0.5; });
        }
        if (end.losses.size() > losses) {
            record.marked = "the take is not whole";
            hooks_.say(fmt::format("trial {} is marked: {}\n", spec.number, end.losses.back()));
        }
        if (record.marked.empty()) record.marked = mark_of(record, protocol_.limits);
        if (record.marked.empty()) record.marked = level_mark(record);
        if (!choice_.keeps_takes) fs::remove_all(at, failure);
        return record;
    }

    /// Late ticks, a fault, or a hand that did not explore an interval leave another stimulus than the wanted one.
    std::string level_mark(const TrialRecord& record) const {
        if (!protocol_.is_psychophysics() || record.interval == 0) return {};
        const std::string unit = protocol_.stimulus->level_unit();
        if (protocol_.is_adjustment() && !record.match)
            return fmt::format("it ended after {:.3g} s without a match", record.seconds);
        if (!record.rendered_level) return "an interval has nothing that can be measured";
        if (protocol_.stimulus->is_rendered(record.match.value_or(record.level), *record.rendered_level)) return {};
        return fmt::format("the device was commanded level {}", format_quantity(*record.rendered_level, unit));
    }

    /// False: the subject ended the session.
    bool perform(const TrialSpec& spec, const run::RunChoice& run, PortCollector& collector, TurnedLevel* turned,
                 TrialRecord& record, ExperimentEnd& end) {
        if (simulated_) {
            const run::RenderedRun rendered =
                turned ? render_adjustment(spec, run, *turned) : run::render_run(run, assets_, stop_, [](double) {});
            end.losses.insert(end.losses.end(), rendered.losses.begin(), rendered.losses.end());
            read_quality(rendered.summary, record);
            return true;
        }
        const LiveEnd live = hooks_.perform(run, protocol_.conditions[spec.condition], collector.over(), turned);
        end.losses.insert(end.losses.end(), live.losses.begin(), live.losses.end());
        read_quality(live.summary, record);
        return !live.is_ended;
    }

    /// The simulated subject turns the level after each presentation, by what was rendered in it.
    run::RenderedRun render_adjustment(const TrialSpec& spec, const run::RunChoice& run, TurnedLevel& turned) {
        observe::Observer observer(observe::Observer::Pace::lossless);
        const std::set<std::string> ports = ports_of(protocol_, spec.task);
        SteppedPorts seen(ports, observer);
        return run::render_in_steps(run, assets_, &observer, [&](run::Engine& engine) {
            for (int shown = 1; shown <= protocol_.method.presentations && !stop_; ++shown) {
                engine.advance(std::llround(shown * protocol_.length * static_cast<double>(flicks_per_second)));
                seen.fetch();
                TrialRecord so_far;
                so_far.turns = turned.turns();
                so_far.seconds = shown * protocol_.length;
                const int presses = simulated_->presses(
                    spec,
                    level_of(protocol_, spec.condition, rendered_of(protocol_, so_far, seen.values()), spec.interval));
                const double before = turned.level();
                turned.turn(presses, engine);
                if (turned.level() != before) continue;
                // It matches, or the range ends here.
                turned.answer(2, engine);
                return;
            }
        });
    }

    void read_rendered(const TrialSpec& spec, const PortValues& values, TrialRecord& record) const {
        record.rendered = rendered_of(protocol_, record, values);
        record.rendered_level = level_of(protocol_, spec.condition, record.rendered, spec.interval);
    }

    bool answer(const TrialSpec& spec, const PortValues& values, TrialRecord& record) {
        read_rendered(spec, values, record);
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
    compile::AssetCache& assets_;
    ExperimentFolder folder_;
    experiment::SubjectEntry entry_;
    fs::path home_;
    std::vector<TrialRecord> trials_;
    std::optional<SimulatedSubject> simulated_;
    std::map<std::size_t, bool> has_hand_;  ///< the patch of each task
};

}  // namespace

run::RunChoice trial_choice(const Protocol& protocol, const TrialSpec& spec) {
    run::RunChoice run;
    const experiment::Condition& condition = protocol.conditions[spec.condition];
    auto& settings = run.overrides.settings;
    if (protocol.is_psychophysics()) {
        run.patch = protocol.patch.string();
        run.seconds = protocol.trial_length();
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

std::vector<std::string> sound_settings(const Protocol& protocol, const compile::Schedule& plan) {
    std::vector<std::string> outputs, settings;
    for (const compile::ScheduleNode& node : plan.nodes)
        if (node.type->name == sound_node) outputs.push_back(node.name);
    for (const experiment::SoundCap& cap : protocol.limits.sound)
        if (!cap.output.empty() && std::ranges::find(outputs, cap.output) == outputs.end())
            throw Error(fmt::format("{}: [limits]: sound: {} has no audio output '{}'{}", protocol.file.string(),
                                    plan.patch.file.string(), cap.output, did_you_mean(cap.output, outputs)));
    for (const compile::ScheduleNode& node : plan.nodes) {
        if (node.type->name != sound_node) continue;
        const Param *limit = node.params.at("limit"), *full_scale = node.params.at("full_scale");
        const auto refuse_stimulus = [&](const char* param, const char* what) {
            if (protocol.stimulus &&
                std::ranges::find(protocol.stimulus->parameters, fmt::format("{}.{}", node.name, param)) !=
                    protocol.stimulus->parameters.end())
                throw Error(
                    fmt::format("{}: [stimulus]: it changes the {} of '{}', which [limits] sound needs; "
                                "change the level of a node before it",
                                protocol.file.string(), what, node.name));
        };
        for (const experiment::SoundCap& cap : protocol.limits.sound) {
            if (!cap.output.empty() && cap.output != node.name) continue;
            refuse_stimulus("limit", "limit");
            if (!cap.is_of_full_scale) refuse_stimulus("full_scale", "full scale");
            for (const compile::ScheduleWire& wire : plan.wires) {
                if (wire.param == full_scale && !cap.is_of_full_scale)
                    throw Error(wire.where,
                                fmt::format("this wire drives the full scale of '{}', so that a limit in the unit of "
                                            "its signal is none; give the limit in dBFS",
                                            node.name));
                if (wire.param == limit)
                    throw Error(wire.where,
                                fmt::format("this wire drives the limit of '{}', which the experiment sets; "
                                            "remove one of them",
                                            node.name));
            }
            const double level = cap.is_of_full_scale ? cap.level : cap.level / full_scale->value;
            settings.push_back(fmt::format("{}.limit={}", node.name, std::min(level, 1.0)));
        }
    }
    return settings;
}

namespace {

/// Renders a trial with the limits of its sound and returns the summary. Throws Error when a limit was reached.
std::string render_limited(const Protocol& protocol, run::RunChoice& run, compile::AssetCache& assets,
                           const std::string& where) {
    const std::atomic<bool> never{false};
    if (protocol.limits.sound.empty()) return run::render_run(run, assets, never, [](double) {}).summary;
    const auto caps = sound_settings(protocol, run::load_plan(run, assets));
    run.overrides.settings.insert(run.overrides.settings.end(), caps.begin(), caps.end());
    const std::string summary = run::render_run(run, assets, never, [](double) {}).summary;
    check_sound(protocol, run::load_plan(run, assets), summary, where);
    return summary;
}

}  // namespace

void check_levels(const Protocol& protocol, compile::AssetCache& assets, const std::vector<std::string>& more,
                  const std::function<void(const std::string&)>& say) {
    if (!protocol.is_psychophysics()) return;
    const Stimulus& stimulus = *protocol.stimulus;
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
                run.seconds = protocol.length;
                run.out = scratch.path() / "run";
                PortCollector collector(ports_of(protocol, 0));
                run.tap = collector.tap();
                const std::string where =
                    fmt::format("condition {}, interval {}, level {}", protocol.conditions[condition].name, interval,
                                format_quantity(level, stimulus.level_unit()));
                const std::string summary = render_limited(protocol, run, assets, where);
                TrialRecord record;
                read_quality(summary, record);
                const std::vector<double> rendered = rendered_of(protocol, record, collector.values());
                const std::optional<double> got = level_of(protocol, condition, rendered, interval);
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
            if (protocol.limits.sound.empty()) continue;
            const run::ScratchFolder scratch;
            run.out = scratch.path() / "run";
            render_limited(
                protocol, run, assets,
                fmt::format("task {}, condition {}", protocol.tasks[task].name, protocol.conditions[condition].name));
        }
}

namespace {

/// Throws Error if a patch does not accept --set and --asset, before the subject has a folder and a row of the order.
void check_overrides(const ExperimentChoice& choice, compile::AssetCache& assets) {
    for (std::size_t task = 0; task < std::max<std::size_t>(choice.protocol.tasks.size(), 1); ++task) {
        TrialSpec spec;
        spec.task = task;
        spec.level = choice.protocol.stimulus ? choice.protocol.stimulus->min : 0.0;
        run::RunChoice run = trial_choice(choice.protocol, spec);
        run.overrides.settings.insert(run.overrides.settings.end(), choice.settings.begin(), choice.settings.end());
        run.overrides.assets.insert(run.overrides.assets.end(), choice.assets.begin(), choice.assets.end());
        if (choice.model && !choice.protocol.tasks.empty() && !choice.protocol.tasks[task].ideal.empty())
            run.overrides.assets.push_back("hand=" + choice.protocol.tasks[task].ideal.string());
        run::load_plan(run, assets);
    }
}

}  // namespace

ExperimentEnd run_experiment(const ExperimentChoice& choice, const ExperimentHooks& hooks,
                             const std::atomic<bool>& stop) {
    compile::AssetCache assets;
    check_overrides(choice, assets);
    return Session(choice, hooks, stop, assets).run();
}

}  // namespace tactus::analysis
