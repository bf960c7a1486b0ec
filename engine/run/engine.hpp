// SPDX-License-Identifier: Apache-2.0
// Runs a plan: on a virtual clock as fast as it goes, or in real time. Both give the same output bits. A plan that runs
// can be changed: another takes over at one logical time, and what the edit does not touch goes on.
#pragma once

#include "engine/build/generation.hpp"
#include "engine/io/host.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/take/take_writer.hpp"
#include "graph/compile/plan.hpp"

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::run {

struct EngineOptions {
    double seconds = 1.0;
    int block = 0;  ///< most samples per call of an audio group, 0: the patch's quantum
    bool random_blocks = false;  ///< calls of random length up to `block`, for tests
    std::optional<std::filesystem::path> folder;  ///< where recordings go, none: nowhere
    const take::TimingLog* replay = nullptr;  ///< repeat what timing decided in a live run
    const std::vector<io::RecordedDevice>* devices =
        nullptr;  ///< stand-ins for the devices of the run that is repeated
    take::TakeWriter* take = nullptr;  ///< records the run
    bool record_values = true;  ///< the take has them from the beginning; else from `Engine::record` on
    std::uint64_t longest_journal = std::uint64_t{4} << 30;  ///< bytes of decisions kept while no values are recorded
    observe::Observer* observer = nullptr;  ///< looks on; changes nothing
    bool live = false;
    io::AudioChoice audio;  ///< live only
    bool hash = true;  ///< keep `output_hash`; costs about as much per sample of a signal as a trivial node
    bool time_nodes = true;  ///< keep the time of each node, from one call in 64
    /// Where every value of an output goes; used by replay, which compares. Null results: nowhere.
    std::function<std::unique_ptr<io::Stream>(const std::string& port, const ValueType&, const GroupRuntime&)> tap;
};

struct LiveOptions {
    double dilate = 1.0;  ///< real seconds per logical second
    std::optional<std::filesystem::path> log;  ///< where timing decisions are written
    const std::atomic<bool>* stop = nullptr;  ///< set from outside to end the run early
    std::function<void()> watch;  ///< called about every 20 ms by the control thread
};

/// What became of an edit.
struct EditOutcome {
    std::optional<std::string> error;  ///< why the old plan runs on
    std::int64_t generation = 0;
    Flicks when = 0;  ///< logical time of the switch
    std::size_t kept = 0, nodes = 0;  ///< nodes that go on, of all
};

class Engine {
public:
    using PortHashes = std::vector<std::pair<std::string, std::uint64_t>>;

    /// Takes the plan, prepares every node and lays out the wires. Assets must be loaded. Throws Error.
    Engine(compile::Plan plan, const EngineOptions& options);
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    /// Before an offline run: from logical time `when` on, or where the replayed log says, this plan runs. Later ones
    /// have later times. Throws Error.
    void schedule(compile::Plan plan, Flicks when);
    /// Before an offline run: parameter changes by their number in the replayed log, in the plan scheduled last.
    void schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value);

    /// Runs to the end on `threads` threads; `progress` is told the fraction done; what it throws ends the
    /// run. Throws Error.
    void render(int threads, const std::function<void(double)>& progress = {});
    /// Runs in real time, one thread per group. An output that the disk has no room for ends, the run goes on. Throws
    /// Error. Engines run once.
    void run_live(const LiveOptions& options);

    /// While a live run goes on, from `watch`: `make` compiles a plan on another thread, which then takes over.
    /// `told` hears of the outcome from the control thread. Edits wait for each other; of those that wait the last one
    /// counts.
    void edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told);
    /// While a live run goes on, from `watch`: sets a parameter, "0.8 N/mm", two quanta ahead. Returns the logical time.
    /// Throws Error on unknown names, structural or driven parameters, and values out of range.
    Flicks set(const std::string& node, const std::string& param, const std::string& text);
    /// While a live run goes on, from `watch`: forces fade to zero and logical time stops, or it goes on and forces come
    /// in anew. A take repeats it to the bit.
    void pause(bool wanted) { wants_pause_ = wanted; }
    /// While a live run with a take goes on, from `watch`: from a moment a little ahead on, the same for all groups, the
    /// take holds every value, or no more. What timing decided it holds from the beginning, so it repeats the run up to
    /// there. No tick is disturbed. Throws Error when the take was given up.
    void record(bool wanted);
    bool is_recording() const { return options_.take && wants_record_ && !options_.take->is_lost(); }
    /// Some values are in the take.
    bool was_recorded() const { return was_recorded_; }
    enum class Pausing : std::uint8_t { runs, fades, stands };
    Pausing pausing() const;
    /// No edit is on its way.
    bool is_settled() const { return !waiting_ && !building_.valid() && !before_; }

    /// During a render, any thread: it ends soon, as if it had been asked for no more.
    void stop();

    /// Completes recordings; what could not be written to its end is among the `losses`.
    void complete();
    /// The same; throws Error when there are losses.
    void finish();
    /// What the disk had no room for, and why; among the notices, too. Control thread.
    const std::vector<std::string>& losses() const { return losses_; }

    /// What the nodes report. After the run.
    Report report() const;
    /// Hash over every published value of every output, joined in name order. After the run.
    std::uint64_t output_hash() const;
    /// The same, per output ("node.port").
    PortHashes port_hashes() const;

    /// The plan that runs, or ran last.
    const compile::Plan& plan() const { return now_->plan; }
    /// Every group that ever ran, the first plan's first.
    const std::vector<std::shared_ptr<GroupRuntime>>& groups() const { return groups_; }
    /// Those of the plan that runs. Control thread.
    const std::vector<std::shared_ptr<build::LiveNode>>& nodes() const { return now_->nodes; }
    const io::EngineHost& host() const { return host_; }
    std::uint64_t plan_hash() const { return plan_hash_; }
    std::int64_t edits() const { return now_->number; }
    /// Logical time that every group has reached, s.
    double progress_seconds() const;

private:
    struct WaitingEdit {
        std::function<compile::Plan()> make;
        std::function<void(const EditOutcome&)> told;
    };
    struct LiveRun;

    void keep_opened();
    void adopt_groups(const build::Generation& generation, Flicks when);
    void set_end(GroupRuntime& group) const;
    void add_log(GroupRuntime& group);
    std::int64_t tick_at(double time, Flicks period) const;
    static void gather_hashes(const build::Generation& old, const build::Generation* next, PortHashes& parts);
    void drain_streams();
    void write_log(const take::TimingRecord& record);
    void complete_log();
    void note_losses();
    void note_loss(const std::string& loss);
    void service_cards();
    void drain_log();
    void complete_render();
    void offline_worker(const std::vector<GroupRuntime*>& mine, std::uint64_t seed);
    void live_worker(GroupRuntime& group);
    void start_thread(GroupRuntime& group);
    void service_pause();
    void service_record();
    void begin_record();
    void end_record();
    void give_up_journal(const std::string& why);
    RecordStream* tap_of(const std::string& port, const ValueType& type, const GroupRuntime& group);
    void service_edits();
    void hand_over(std::unique_ptr<build::Generation> next);
    void retire();
    void close_ended();
    void list_open_taps();
    void end_thread(const GroupRuntime& group);
    Flicks furthest() const;
    void fail(std::exception_ptr error);

    EngineOptions options_;
    std::uint64_t plan_hash_ = 0;
    io::EngineHost host_;
    build::BuildContext context_;
    struct Tap {
        std::unique_ptr<io::Stream> stream;
        const GroupRuntime* group;
    };
    std::map<std::string, Tap> taps_;  // by output, group and type: one writing thread each
    std::vector<Tap> ending_taps_;  // of stretches that are over
    std::vector<io::Stream*> open_taps_;  // those that may still be written
    bool wants_record_ = false, records_ = false, was_recorded_ = false;
    std::vector<std::shared_ptr<GroupRuntime>> groups_;
    std::unique_ptr<build::Generation> now_, before_;
    std::vector<std::unique_ptr<build::Generation>> scheduled_;  // offline: all that come before `now_`
    PortHashes ended_hashes_;
    std::vector<ParameterChange> replayed_changes_;
    std::optional<WaitingEdit> waiting_, making_;
    std::future<std::unique_ptr<build::Generation>> building_;
    std::vector<std::int64_t> settled_at_;  // what each group had done when nothing read the plan before any more
    std::int64_t changes_ = 0;
    std::vector<std::unique_ptr<Ring<take::TimingRecord>>> log_rings_;
    std::unique_ptr<take::TimingLogWriter> log_;
    std::mutex log_lock_;
    std::string log_loss_;  // under it
    std::vector<std::string> losses_;
    PauseWindow pause_;
    bool wants_pause_ = false;
    LiveRun* live_ = nullptr;
    std::atomic<std::uint32_t> generation_{0};  // rises after every offline call
    std::atomic<bool> stop_{false};
    std::mutex failure_lock_;
    std::exception_ptr failure_;
};

}  // namespace tactus::run
