// SPDX-License-Identifier: Apache-2.0
#include "tools/embed/embedded.hpp"

#include "dsp/core/error.hpp"
#include "tools/embed/host_node.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/results.hpp"
#include "tools/run/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

namespace tactus::embed {

namespace {

constexpr double unlimited_s = 1e9;  // 30 years

std::string one_per_line(const patch::Problems& problems) {
    return fmt::format("{}", fmt::join(run::problem_lines(problems), "\n"));
}

double rate_of(Flicks period) { return static_cast<double>(flicks_per_second) / static_cast<double>(period); }

}  // namespace

PatchErrors::PatchErrors(const patch::Problems& problems)
    : Error(problems.list.front()), all_(one_per_line(problems)) {}

Patch::Patch(run::PatchChoice choice) {
    add_host_driver();
    change(std::move(choice));
}

void Patch::change(run::PatchChoice changed) {
    patch::Problems problems;
    run::read_plan(changed, problems);
    if (!problems.empty()) throw PatchErrors(problems);
    choice_ = std::move(changed);
}

void Patch::configure(const std::string& setting) {
    run::PatchChoice changed = choice_;
    changed.overrides.settings.push_back(setting);
    change(std::move(changed));
}

void Patch::use_asset(const std::string& asset) {
    run::PatchChoice changed = choice_;
    changed.overrides.assets.push_back(asset);
    change(std::move(changed));
}

void Patch::attach_hand(const std::string& name, const DeviceInfo& info) {
    patch::Problems problems;
    const patch::Patch read = run::read_choice(choice_, problems);
    std::vector<std::string> names;
    for (const patch::PatchDevice& device : read.devices) names.push_back(device.name);
    if (std::ranges::find(names, name) == names.end())
        throw Error(fmt::format("the patch has no device '{}'{}; it has: {}", name, did_you_mean(name, names),
                                names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
    std::erase_if(hands_, [&](const Hand& hand) { return hand.name == name; });
    hands_.push_back({name, info});
}

compile::Schedule Patch::plan(const std::vector<std::unique_ptr<HostHand>>& links, std::uint64_t seed) {
    patch::Problems problems;
    patch::Patch read = run::read_choice(choice_, problems);
    for (std::size_t i = 0; i < hands_.size(); ++i)
        for (patch::PatchDevice& device : read.devices)
            if (device.name == hands_[i].name) {
                device.driver = "host";
                device.settings = {{"link", links[i]->link(), device.where}};
            }
    const std::optional<std::uint64_t> given = seed == 0 ? choice_.seed : seed;
    assets_.forget_changed();
    std::optional<compile::Schedule> plan = run::plan_of(std::move(read), choice_.overrides, given, &assets_, problems);
    if (!problems.empty()) throw PatchErrors(problems);
    return std::move(*plan);
}

Run::Run(Patch& patch, RunOptions options)
    : options_(std::move(options)),
      observer_(options_.live ? observe::Observer::Pace::live : observe::Observer::Pace::lossless) {
    if (!(options_.seconds >= 0.0) || options_.seconds > unlimited_s)
        throw Error(fmt::format("a run of {} s is impossible; 0 runs until it is finished", options_.seconds));
    for (const Patch::Hand& hand : patch.hands()) {
        hand_names_.push_back(hand.name);
        hands_.push_back(std::make_unique<HostHand>(hand.info, options_.live));
    }
    compile::Schedule plan = patch.plan(hands_, options_.seed);
    callbacks_ = std::make_unique<CallbackFailure>([this] { engine_->stop(); });
    admit_host_nodes(plan, options_.live, *callbacks_);
    if (options_.folder) folder_.emplace(run::OutputChoice{*options_.folder});
    run::EngineOptions engine;
    engine.seconds = options_.seconds > 0.0 ? options_.seconds : unlimited_s;
    if (folder_) engine.folder = folder_->path();
    engine.observer = &observer_;
    engine.live = options_.live;
    engine.audio.device = options_.audio == "default" ? "" : options_.audio;
    engine_ = std::make_unique<run::Engine>(std::move(plan), engine);
    if (!options_.live) return;
    go(Way::live);
    thread_ = std::thread([this] { run_live(); });
}

Run::~Run() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void Run::go(Way way) {
    if (is_finished_) throw Error("the run is finished");
    if (way_ == Way::none) way_ = way;
    if (way_ != way)
        throw Error(way_ == Way::live       ? "the run is live: it goes on by itself"
                    : way_ == Way::rendered ? "the run was rendered: start another one"
                                            : "the run is being advanced: advance it to where it is to end");
    check_callbacks();
}

void Run::check_callbacks() {
    if (way_ == Way::live) return;
    try {
        callbacks_->check();
    } catch (const Error&) {
        failure_ = std::current_exception();
        throw;
    }
}

void Run::advance(double seconds) {
    go(Way::advanced);
    if (!(seconds >= 0.0) || asked_s_ + seconds > unlimited_s)
        throw Error(fmt::format("a run cannot be advanced by {} s", seconds));
    asked_s_ += seconds;
    now_ = std::llround(asked_s_ * static_cast<double>(flicks_per_second));
    engine_->advance(now_);
    check_callbacks();
}

void Run::render() {
    if (options_.seconds == 0.0) throw Error("how long is the run to be? The options give no seconds");
    if (way_ == Way::rendered) throw Error("the run was rendered: start another one");
    go(Way::rendered);
    engine_->render(options_.threads > 0 ? options_.threads
                                         : static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
    check_callbacks();
}

void Run::run_live() {
    try {
        engine_->run_live({.dilate = 1.0, .log = std::nullopt, .stop = &stop_, .watch = [this] { tend(); }});
    } catch (...) {
        failure_ = std::current_exception();
    }
    const std::lock_guard hold(lock_);
    is_over_ = true;
    changed_.notify_all();
}

/// The control thread of the live run.
void Run::tend() {
    std::unique_lock hold(lock_);
    while (!tasks_.empty()) {
        const std::shared_ptr<Task> task = tasks_.front();
        tasks_.pop_front();
        hold.unlock();
        try {
            task->work();
        } catch (...) {
            task->failure = std::current_exception();
        }
        hold.lock();
        task->is_done = true;
        changed_.notify_all();
    }
}

void Run::set(const std::string& node_and_parameter, const std::string& value) {
    const std::size_t dot = node_and_parameter.rfind('.');
    if (dot == std::string::npos) throw Error(fmt::format("write NODE.PARAM, not '{}'", node_and_parameter));
    const std::string node = node_and_parameter.substr(0, dot), param = node_and_parameter.substr(dot + 1);
    if (way_ == Way::rendered || is_finished_) throw Error("the run is over: nothing can be set any more");
    if (way_ != Way::live) {
        if (way_ == Way::none) advance(0.0);
        engine_->set(node, param, value);
        return;
    }
    const auto task = std::make_shared<Task>();
    task->work = [this, node, param, value] { engine_->set(node, param, value); };
    std::unique_lock hold(lock_);
    if (!is_over_) tasks_.push_back(task);
    changed_.wait(hold, [&] { return task->is_done || is_over_; });
    if (!task->is_done) throw Error("the run is over: nothing can be set any more");
    if (task->failure) std::rethrow_exception(task->failure);
}

double Run::time() const {
    return way_ == Way::advanced ? static_cast<double>(now_) / static_cast<double>(flicks_per_second)
                                 : engine_->progress_seconds();
}

int Run::find_hand(const std::string& name) const {
    const auto found = std::ranges::find(hand_names_, name);
    if (found == hand_names_.end())
        throw Error(fmt::format("no hand '{}' was attached to the patch before the run began", name));
    return static_cast<int>(found - hand_names_.begin());
}

HostHand* Run::hand(int number) {
    return number < 0 || number >= static_cast<int>(hands_.size()) ? nullptr
                                                                   : hands_[static_cast<std::size_t>(number)].get();
}

std::string Run::output_name(int index) const {
    for (const observe::Observer::Port& port : observer_.ports())
        if (!port.type->columns.empty() && index-- == 0) return port.name;
    return {};
}

int Run::output(const std::string& port, bool every) {
    const std::vector<observe::Observer::Port> ports = observer_.ports();
    const auto found = std::ranges::find(ports, port, &observe::Observer::Port::name);
    if (found == ports.end()) {
        std::vector<std::string> names;
        for (const auto& known : ports) names.push_back(known.name);
        throw Error(fmt::format("the patch has no output '{}'{}", port, did_you_mean(port, names)));
    }
    if (found->type->columns.empty())
        throw Error(
            fmt::format("'{}' gives {}, which has no numbers to read", port, value::with_article(*found->type)));
    if (every && way_ != Way::none && way_ != Way::live)
        throw Error(fmt::format("every value of '{}' is kept only when that is asked for before the run begins", port));
    auto known = std::ranges::find(outputs_, port, &Output::port);
    if (known == outputs_.end()) {
        Output made{port, found->type, rate_of(found->period), {}, false, {}, 0};
        for (const std::string_view name : found->type->columns) made.names.emplace_back(name);
        outputs_.push_back(std::move(made));
        known = outputs_.end() - 1;
    }
    known->every = known->every || every;
    observer_.watch(port, known->every ? observe::Watch::every : observe::Watch::latest, this);
    return static_cast<int>(known - outputs_.begin());
}

Run::Output* Run::find_output(int number) {
    return number < 0 || number >= static_cast<int>(outputs_.size()) ? nullptr
                                                                     : &outputs_[static_cast<std::size_t>(number)];
}

void Run::newest(const Output& output, double* values) {
    if (!options_.live) observer_.advance();
    const auto read = [&]<class T>(const T*) {
        const ValueType& type = []() -> const ValueType& {
            if constexpr (std::is_same_v<T, float>) return value::signal;
            else return value_type<T>();
        }();
        if (&type != output.type) return;
        if (const auto seen = observer_.latest<T>(output.port)) type.to_columns(&seen->value, values);
    };
    std::fill_n(values, output.names.size(), 0.0);
    read(static_cast<const Pose*>(nullptr));
    read(static_cast<const Twist*>(nullptr));
    read(static_cast<const Wrench*>(nullptr));
    read(static_cast<const Vec3*>(nullptr));
    read(static_cast<const double*>(nullptr));
    read(static_cast<const bool*>(nullptr));
    read(static_cast<const float*>(nullptr));
}

void Run::take_in(Output& output) {
    if (!output.every) throw Error(fmt::format("'{}' was not asked for with all of its values", output.port));
    if (output.taken == output.values.when.size()) {
        output.values.when.clear();
        output.values.columns.clear();
        output.taken = 0;
    }
    observer_.advance();
    observer_.fetch(output.port, output.values);
}

std::size_t Run::available(Output& output) {
    take_in(output);
    return output.values.when.size() - output.taken;
}

std::size_t Run::fetch(Output& output, double* times, double* values, std::size_t max) {
    const std::size_t count = std::min(available(output), max), width = output.names.size();
    for (std::size_t i = 0; times && i < count; ++i)
        times[i] = static_cast<double>(output.values.when[output.taken + i]) / static_cast<double>(flicks_per_second);
    std::copy_n(output.values.columns.begin() + static_cast<std::ptrdiff_t>(output.taken * width), count * width,
                values);
    output.taken += count;
    return count;
}

void Run::finish() {
    if (is_finished_) return;
    if (way_ == Way::live) {
        stop_ = true;
        thread_.join();
    } else if (way_ != Way::rendered) {
        if (way_ == Way::none) advance(0.0);
        engine_->end_advance();
    }
    is_finished_ = true;
    if (failure_) std::rethrow_exception(failure_);
    const double seconds = std::min(way_ == Way::advanced ? time() : engine_->progress_seconds(),
                                    options_.seconds > 0.0 ? options_.seconds : unlimited_s);
    engine_->complete();
    const Report report = engine_->report();
    run::WrittenFiles written;
    if (folder_) {
        written = run::write_results(report, folder_->path(), false);
        written.names.emplace_back("summary.json");
    }
    std::vector<std::string> losses = engine_->losses();
    losses.insert(losses.end(), written.losses.begin(), written.losses.end());
    summary_ = run::summary_json(*engine_, report, seconds, options_.live, written.names, losses);
    if (folder_) folder_->write_summary(summary_);
    if (!losses.empty()) throw Error(fmt::format("{}", fmt::join(losses, "\n")));
}

}  // namespace tactus::embed
