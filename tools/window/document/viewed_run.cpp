// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/viewed_run.hpp"

#include "nodes/plan/step_record.hpp"
#include "tools/run/live_table.hpp"
#include "tools/run/run_session.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

namespace {

GroupStatus status_of(const run::GroupRuntime& group) {
    const observe::GroupTelemetry& t = group.telemetry;
    const double rate = rate_of(group.plan->period);
    const double execution_us = t.execution.quantile_ns(0.5) * 1e-3;
    return {group.plan->name,
            rate,
            t.ticks.load(),
            t.misses.load() + t.skipped.load(),
            t.lateness.quantile_ns(0.99) * 1e-6,
            static_cast<double>(t.lateness.max_ns()) * 1e-6,
            execution_us,
            execution_us * 1e-6 * rate / group.max_frames};
}

NodeStatus status_of(const build::LiveNode& node) {
    const double period_us = seconds(node.group->plan->period) * 1e6 * node.group->max_frames;
    const double mean = node.time.mean_ns() * 1e-3;
    return {node.name, mean, static_cast<double>(node.time.max_ns.load()) * 1e-3, mean / period_us};
}

std::shared_ptr<const plan::CasePlan> plan_of(const run::Engine& engine) {
    for (const auto& stream : engine.host().streams)
        if (const auto* keeper = dynamic_cast<const nodes::StepKeeper*>(stream->format().keeper.get()))
            if (auto plan = keeper->versions().newest()) return plan;
    return nullptr;
}

}  // namespace

ViewedRun::ViewedRun(RunChoice choice, compile::AssetCache& assets, observe::Observer& observer)
    : choice_(std::move(choice)), assets_(assets), observer_(observer), thread_([this] { work(); }) {}

ViewedRun::~ViewedRun() {
    stop_ = true;
    thread_.join();
}

void ViewedRun::work() {
    try {
        session_ = std::make_unique<RunSession>(choice_, assets_, &observer_);
        RunSession& session = *session_;
        if (!stop_) session.run({[&] { tend(session); }, [this](const std::string& said) { say(said); }}, stop_);
        look_at(session);
        session.finish();
        {
            const std::lock_guard lock(lock_);
            losses_ = session.losses();
            json_ = session.summary_json();
            text_ = fmt::format("{}  results in {}/\n", session.summary_text(), session.folder().string());
        }
        end({});
    } catch (const std::exception& error) {
        say(error.what());
        end(error.what());
    }
}

void ViewedRun::end(const std::string& failure) {
    const std::lock_guard lock(lock_);
    auto last = std::make_shared<RunStatus>(*status_);
    if (session_) last->plan = plan_of(session_->engine());
    last->state = RunStatus::State::over;
    last->failure = failure;
    status_ = std::move(last);
    over_ = true;
}

void ViewedRun::tend(RunSession& session) {
    if (session.control()) session.control()->saved = [this] { saved_ = true; };
    std::vector<std::function<void(RunSession&)>> asked;
    {
        const std::lock_guard lock(lock_);
        asked.swap(asked_);
    }
    for (const auto& what : asked) {
        try {
            what(session);
        } catch (const Error& error) {
            say(error.what());
        }
    }
    constexpr int looks = 5;  // every 100 ms, a new version of the plan at once
    if (tends_++ % looks == 0 || plan_of(session.engine()) != status()->plan) look_at(session);
}

void ViewedRun::look_at(RunSession& session) {
    run::Engine& engine = session.engine();
    RunStatus status;
    constexpr RunStatus::State states[] = {RunStatus::State::runs, RunStatus::State::fades, RunStatus::State::stands};
    status.state = states[static_cast<std::size_t>(engine.pausing())];
    status.time = engine.progress_seconds();
    status.folder = session.folder();
    status.edits = engine.edits();
    status.is_recording = engine.is_recording();
    status.plan = plan_of(engine);
    for (const auto& notices = engine.host().notices; told_notices_ < notices.size(); ++told_notices_)
        say(notices[told_notices_]);
    for (const auto& group : engine.groups()) {
        status.most = std::max(status.most, group->telemetry.take_most_force());
        if (group->is_over()) continue;
        status.groups.push_back(status_of(*group));
        status.force = std::max(status.force, group->telemetry.force_N.load(std::memory_order_relaxed));
    }
    status.peak = peak_ = std::max(peak_, status.most);
    for (const auto& node : engine.nodes()) status.nodes.push_back(status_of(*node));
    for (const auto& slot : engine.host().devices)
        if (const auto* const pulled = dynamic_cast<const haptic::PulledDevice*>(slot->device.get()))
            status.pulls.push_back({slot->name, pulled->pull()});
    status.forces = run::forces_of(engine);
    status.faults = run::faults_on_record(engine);
    for (const std::string& told : news_.next(engine)) {
        say(told);
        tactus::say(stderr, told + "\n");
    }
    const std::lock_guard lock(lock_);
    status_ = std::make_shared<RunStatus>(std::move(status));
}

std::shared_ptr<const RunStatus> ViewedRun::status() const {
    const std::lock_guard lock(lock_);
    return status_;
}

std::vector<std::string> ViewedRun::messages() {
    const std::lock_guard lock(lock_);
    return std::exchange(messages_, {});
}

void ViewedRun::say(const std::string& text) {
    const std::lock_guard lock(lock_);
    messages_.push_back(text);
}

void ViewedRun::ask(std::function<void(RunSession&)> what) {
    const std::lock_guard lock(lock_);
    if (over_) return;
    asked_.push_back(std::move(what));
}

void ViewedRun::set(const std::string& node, const std::string& param, const std::string& value) {
    ask([=](RunSession& session) { session.engine().set(node, param, value); });
}

void ViewedRun::edit(const std::string& text) {
    ask([text](RunSession& session) {
        if (!session.control()) throw Error("this run does not accept edits (--no-edits)");
        session.control()->edit(text);
    });
}

void ViewedRun::move_to(const std::filesystem::path& file) {
    ask([file](RunSession& session) {
        if (session.control()) session.control()->move_to(file);
    });
}

void ViewedRun::pause(bool wanted) {
    ask([wanted](RunSession& session) { session.engine().pause(wanted); });
}

void ViewedRun::recover(const std::string& node) {
    ask([=](RunSession& session) {
        // Any number that is not the one before.
        const auto number = 1 + static_cast<std::int64_t>(session.engine().progress_seconds() * 1e3);
        session.engine().set(node, "recover", std::to_string(number));
    });
}

void ViewedRun::press(const std::string& node) {
    ask([node](RunSession& session) {
        if (!session.control()) throw Error("this run does not accept buttons (--no-edits)");
        session.control()->press_button(node);
    });
}

void ViewedRun::record(const std::filesystem::path& folder) {
    ask([this, folder](RunSession& session) {
        session.record(folder);
        say(fmt::format("recording into {}, from {:.2f} s on", folder.string(), session.engine().progress_seconds()));
    });
}

void ViewedRun::stop_recording() {
    ask([this](RunSession& session) {
        session.stop_recording();
        say(fmt::format("recorded up to {:.2f} s", session.engine().progress_seconds()));
    });
}

std::vector<std::string> ViewedRun::losses() const {
    const std::lock_guard lock(lock_);
    return losses_;
}

std::string ViewedRun::summary_json() const {
    const std::lock_guard lock(lock_);
    return json_;
}

std::string ViewedRun::summary_text() const {
    const std::lock_guard lock(lock_);
    return text_;
}

}  // namespace tactus::window
