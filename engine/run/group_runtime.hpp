// SPDX-License-Identifier: Apache-2.0
// The running state of one rate group: its current program and its logical time.
#pragma once

#include "dsp/core/ring.hpp"
#include "engine/build/group_program.hpp"
#include "engine/observe/telemetry.hpp"
#include "engine/run/decisions.hpp"
#include "engine/run/pause_window.hpp"
#include "engine/take/timing_log.hpp"
#include "graph/compile/schedule.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace tactus::run {

class GroupRuntime {
public:
    /// `number` is the group's number in the log, `frames` the maximum of activations per call. Starts with the virtual
    /// clock.
    GroupRuntime(const compile::ScheduleGroup& description, int number, int frames);
    ~GroupRuntime();
    GroupRuntime(const GroupRuntime&) = delete;
    GroupRuntime& operator=(const GroupRuntime&) = delete;

    const compile::ScheduleGroup* plan;  ///< name, period and the like; its nodes change with the program
    const int index;
    const int max_frames;
    std::atomic<std::int64_t> end{0};  ///< activations before this one run; only lowered during a run
    DecisionLog log;
    std::vector<build::GroupProgram*> scheduled;  ///< programs known before the run, in order
    bool times_nodes = true;
    Flicks now = 0;  ///< logical time of the current call
    std::int64_t due_ns = 0;  ///< live: steady time at which it should have begun. Own thread only.
    observe::GroupTelemetry telemetry;

    /// Next activation to run. Own thread only.
    std::int64_t next() const { return next_; }
    bool finished() const { return next_ >= end.load(std::memory_order_relaxed); }
    /// True if its last activation is complete; then `done` is the number of activations. Any thread.
    bool is_over() const noexcept { return over_.load(std::memory_order_acquire); }
    /// Activations that ran. Own thread, or after the run.
    std::int64_t ran() const { return ran_; }
    /// Activations before this one are complete; their values may be read. Any thread.
    std::int64_t done() const noexcept { return done_.load(std::memory_order_acquire); }
    /// The activation after the last one that was computed, not skipped. Any thread.
    std::int64_t computed() const noexcept { return computed_.load(std::memory_order_acquire); }
    /// Number of pauses between calls so far. An increase proves that references held by the earlier call were
    /// released. Any thread.
    std::int64_t rests() const noexcept { return rests_.load(std::memory_order_acquire); }
    /// Number of the running plan; −1 before the first. Any thread.
    std::int64_t plan_number() const noexcept { return plan_number_.load(std::memory_order_acquire); }
    /// Largest number of activations that may run late. Own thread only.
    int backlog() const { return program_ ? program_->backlog : 0; }

    // Control thread. Returns false if too many programs are pending.
    bool hand_over(build::GroupProgram* program) { return programs_.push(program); }
    bool hand_over(const ParameterChange& change) {
        if (!changes_.ring.push(change)) return false;
        ++changes_.given;
        return true;
    }
    /// Adds the counts of an older group that has ended; this group must have ended too.
    void take_over_counts(const GroupRuntime& older) {
        telemetry.merge(older.telemetry);
        description_.name = "ended groups";
    }
    /// Number of changes passed to the group so far.
    std::int64_t changes_given() const { return changes_.given; }
    /// Number of changes that the group no longer refers to. Any thread.
    std::int64_t changes_applied() const noexcept { return changes_.applied.load(std::memory_order_acquire); }
    /// Abandons the group's thread if it is in a driver, and ends the group with the values computed so far. Nothing of
    /// the group may be destroyed then.
    bool forsake() noexcept;
    // Control thread, before the group's thread starts.
    /// Switches to real-time decisions. `pause` must outlive the group's thread.
    void decide_live(const PauseWindow& pause);
    /// Switches to the virtual clock with parameters that change while forces are suspended; see Engine::advance.
    void decide_advanced(const PauseWindow& pause);
    /// Switches to the decisions of a log; see ReplayedDecisions.
    void replay(take::GroupRecords records, const ReplayedChanges& changes);
    void start_at(std::int64_t tick) {
        next_ = tick;
        done_.store(tick);
        computed_.store(tick);
    }

    // Own thread.
    /// True if its thread was abandoned in a driver: the thread must end and access nothing.
    bool is_forsaken() const noexcept { return decisions_->driver.is_forsaken(); }
    /// True if it runs a program.
    bool has_program() const noexcept { return program_ != nullptr; }

    // Own thread, before each call.
    /// Applies the parameters and takes over the program that are due at the next activation. Returns true if it took
    /// over a program, after which other groups may be ready. Wait-free.
    bool take_changes() noexcept;
    /// Live, while the next activation is far ahead: takes over the program that is due then, so that the previous plan
    /// can be destroyed. A group with devices waits for its activation. Wait-free.
    void take_program_ahead() noexcept;
    /// Offline: true if every value that the next call reads is available, and slots for one activation are free. For a
    /// call that has begun: true if there are slots for its results.
    bool ready() const noexcept;
    /// Runs one call of at most `frames` activations and returns their number.
    int call(int frames) noexcept;
    /// The same in two steps, for a replay: a call that has begun ends when there is room for its results.
    void begin_call(int frames) noexcept;
    int finish_call() noexcept;
    bool has_begun() const noexcept { return begun_ > 0; }
    /// Call regularly during a pause: reports to the watchdog that the tick thread is alive. Drivers may make system
    /// calls.
    void rest() noexcept;
    /// Skips the activations before `to`, which are too late.
    void skip_to(std::int64_t to) noexcept;
    /// Skips the activations that a replayed log skips here; returns false if there are none.
    bool skip_as_decided() noexcept;
    void end_at(std::int64_t tick) noexcept;
    /// Times the nodes in each of the next calls, because the previous call took too long.
    void watch_closely() noexcept { closely_ = timed_every; }

private:
    int cut(int frames) const noexcept;
    void apply_pause() noexcept;
    /// True if the hands that the pending program reaches are without force, in this and all other groups.
    bool is_let_go() noexcept;
    bool switch_if_due() noexcept;
    void take_over(build::GroupProgram& next) noexcept;
    void read_links(int frames) noexcept;
    /// Returns true if it read an older value than scheduled.
    bool read_link(Link& link, const GroupRuntime& producer, int frames) noexcept;
    /// Reports to nodes which of their snapshots are still in use.
    void note_readers(int frames) noexcept;
    void acquire(int frames) noexcept;
    /// Determines for each device that the group drives whether forces are suspended, and whether a value on the force
    /// path is overdue.
    void check_sources() noexcept;
    void run_steps(int frames) noexcept;
    /// `watched`: the outputs of the steps are hashed or recorded, or the steps are timed.
    template <bool watched>
    void run_each(const build::Stretch& stretch, const Tick& tick, bool timed) noexcept;
    void run_cycle(const build::Stretch& stretch, const Tick& all, bool timed) noexcept;
    /// Runs a step for `part` of a call of `frames` activations, starting with its activation `from`, and advances its
    /// ports.
    void run_part(std::size_t step, const Tick& part, int from, int frames) noexcept;
    void run_one_at_a_time(std::size_t step, const Tick& all) noexcept;
    /// Advances the ports of a step by `by` activations, to activation `to` of the call.
    void move_ports(std::size_t step, int by, int to, int frames) noexcept;
    void move_back(std::size_t step, int frames) noexcept;
    void hold_outputs(int frames) noexcept;
    /// After a call: clears its events, so that each is delivered only once.
    void clear_events(int frames) noexcept;
    /// Delivers the driven parameters of a node for an activation of the call, and its events.
    void drive(const build::StepWires& wires, int activation) noexcept;
    void hash_outputs(const build::Step& step, int frames) noexcept;
    void record_outputs(const build::Step& step, int frames) noexcept;
    void put_into_frames(const build::PublishedOutput& output, int frames) noexcept;
    void publish(int frames) noexcept;

    static constexpr int timed_every = 64;  ///< nodes are timed in one call out of this many

    compile::ScheduleGroup description_;
    Ring<build::GroupProgram*> programs_{64};
    ChangeQueue changes_;
    ParamRamps ramps_;
    build::GroupProgram* program_ = nullptr;
    build::GroupProgram* upcoming_ = nullptr;
    std::unique_ptr<Decisions> decisions_;
    bool fades_for_plan_ = false, has_let_go_ = false, is_paused_ = false;
    std::size_t taken_ = 0;  ///< of `scheduled`
    std::int64_t next_ = 0, last_ = -1, ran_ = 0;
    int closely_ = 0;  ///< number of further calls to be timed
    RecordStream* recorded_ = nullptr;  ///< destination of the outputs of this call
    int begun_ = 0;  ///< activations of a call that has begun but not ended
    int committing_ = 0;  ///< activations whose forces are being sent
    std::uint64_t calls_ = 0;
    std::atomic<std::int64_t> plan_number_{-1};
    std::atomic<std::int64_t> rests_{0};
    std::atomic<bool> over_{false};
    alignas(64) std::atomic<std::int64_t> done_{0};
    std::atomic<std::int64_t> computed_{0};
};

}  // namespace tactus::run
