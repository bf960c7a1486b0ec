// SPDX-License-Identifier: Apache-2.0
// One rate group while it runs: the program it runs now, and where it is in logical time.
#pragma once

#include "dsp/core/ring.hpp"
#include "engine/build/group_program.hpp"
#include "engine/observe/telemetry.hpp"
#include "engine/run/decisions.hpp"
#include "engine/run/pause_window.hpp"
#include "engine/take/timing_log.hpp"
#include "graph/compile/plan.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace tactus::run {

class GroupRuntime {
public:
    /// `number` is the group's name in the log, `frames` the most activations one call may run. Runs on the virtual
    /// clock.
    GroupRuntime(const compile::PlanGroup& description, int number, int frames);
    ~GroupRuntime();
    GroupRuntime(const GroupRuntime&) = delete;
    GroupRuntime& operator=(const GroupRuntime&) = delete;

    const compile::PlanGroup* plan;  ///< name, period and the like; its nodes change with the program
    const int index;
    const int max_frames;
    std::atomic<std::int64_t> end{0};  ///< activations … end − 1 run; only ever lowered while running
    DecisionLog log;
    std::vector<build::GroupProgram*> scheduled;  ///< programs known before the run, in order
    bool times_nodes = true;
    Flicks now = 0;  ///< logical time of the call that runs
    std::int64_t due_ns = 0;  ///< live: steady time at which it should have begun. Own thread only.
    observe::GroupTelemetry telemetry;

    /// Next activation to run. Own thread only.
    std::int64_t next() const { return next_; }
    bool finished() const { return next_ >= end.load(std::memory_order_relaxed); }
    /// Its last activation is complete, and `done` says how many there were. Any thread.
    bool is_over() const noexcept { return over_.load(std::memory_order_acquire); }
    /// Activations that ran. Own thread, or after the run.
    std::int64_t ran() const { return ran_; }
    /// Activations before this one are complete; their values may be read. Any thread.
    std::int64_t done() const noexcept { return done_.load(std::memory_order_acquire); }
    /// The activation after the last one that was computed, not left out. Any thread.
    std::int64_t computed() const noexcept { return computed_.load(std::memory_order_acquire); }
    /// How often it was between two calls. Any thread: what a call read that was begun before has been given up.
    std::int64_t rests() const noexcept { return rests_.load(std::memory_order_acquire); }
    /// Of the program that runs; −1 before the first. Any thread.
    std::int64_t plan_number() const noexcept { return plan_number_.load(std::memory_order_acquire); }
    /// How many activations may run late. Own thread only.
    int backlog() const { return program_ ? program_->backlog : 0; }

    // Control thread. False when too much is waiting already.
    bool hand_over(build::GroupProgram* program) { return programs_.push(program); }
    bool hand_over(const ParameterChange& change) {
        if (!changes_.ring.push(change)) return false;
        ++changes_.given;
        return true;
    }
    /// Counts for an older group that ended, too; this one has ended.
    void take_over_counts(const GroupRuntime& older) {
        telemetry.merge(older.telemetry);
        description_.name = "ended groups";
    }
    /// How many changes it was given by now.
    std::int64_t changes_given() const { return changes_.given; }
    /// How many of them it does not refer to any more. Any thread.
    std::int64_t changes_applied() const noexcept { return changes_.applied.load(std::memory_order_acquire); }
    /// Leaves the group's thread behind if it is in a driver, and ends the group with what it has computed. Nothing of the
    /// group may be destroyed then.
    bool forsake() noexcept;
    // Control thread, before the group's thread starts.
    /// The clock decides in real time. `pause` must outlive the group's thread.
    void decide_live(const PauseWindow& pause);
    /// On the virtual clock, with parameters that change while forces are held off; see Engine::advance.
    void decide_advanced(const PauseWindow& pause);
    /// A log decides; see ReplayedDecisions.
    void replay(take::GroupRecords records, const ReplayedChanges& changes);
    void start_at(std::int64_t tick) {
        next_ = tick;
        done_.store(tick);
        computed_.store(tick);
    }

    // Own thread.
    /// It was left behind in a driver: the thread must end and touch nothing.
    bool is_forsaken() const noexcept { return decisions_->driver.is_forsaken(); }
    /// It runs a program.
    bool has_program() const noexcept { return program_ != nullptr; }

    // Own thread, before each call.
    /// Applies the parameters and takes over the program that are due at the next activation. True when it took one
    /// over: then other groups may have become ready. Wait-free.
    bool take_changes() noexcept;
    /// Live, while the next activation is far ahead: takes over the program that is due then, so that the plan before
    /// can be taken apart. A group with devices waits for its activation. Wait-free.
    void take_program_ahead() noexcept;
    /// Offline: every value that the next call reads is there, and slots for one activation are free. Of a call that
    /// has begun: slots for what it gives.
    bool ready() const noexcept;
    /// Runs one call and returns how many activations it covered. At most `frames` of them.
    int call(int frames) noexcept;
    /// The same in two steps, for a replay: a call that has begun ends when there is room for what it gives.
    void begin_call(int frames) noexcept;
    int finish_call() noexcept;
    bool has_begun() const noexcept { return begun_ > 0; }
    /// While it pauses, now and then: tells the watchdog that the devices are not forsaken. May call the system, in
    /// drivers.
    void rest() noexcept;
    /// Leaves out activations up to `to`, because they are too late.
    void skip_to(std::int64_t to) noexcept;
    /// Leaves out the activations that a replayed log leaves out here; false when there are none.
    bool skip_as_decided() noexcept;
    void end_at(std::int64_t tick) noexcept;
    /// Times the nodes of the next calls, all of them: the one before took too long.
    void watch_closely() noexcept { closely_ = timed_every; }

private:
    int cut(int frames) const noexcept;
    void apply_pause() noexcept;
    /// The hands that the upcoming program reaches are without force, here and in all groups.
    bool is_let_go() noexcept;
    bool switch_if_due() noexcept;
    void take_over(build::GroupProgram& next) noexcept;
    void read_links(int frames) noexcept;
    /// True when something older was read than the schedule says.
    bool read_link(Link& link, const GroupRuntime& producer, int frames) noexcept;
    /// Tells nodes which of their snapshots are still looked at.
    void note_readers(int frames) noexcept;
    void acquire(int frames) noexcept;
    /// Finds for each device whose force it sends whether forces are held off, and whether a value on the force's path is
    /// overdue.
    void check_sources() noexcept;
    void run_steps(int frames) noexcept;
    /// `watched`: what the steps give is hashed or recorded, or they are timed.
    template <bool watched>
    void run_each(const build::Stretch& stretch, const Tick& tick, bool timed) noexcept;
    void run_cycle(const build::Stretch& stretch, const Tick& all, bool timed) noexcept;
    /// A step for `part` of a call of `frames` activations, from its activation `from` on. Its ports move on.
    void run_part(std::size_t step, const Tick& part, int from, int frames) noexcept;
    void run_one_at_a_time(std::size_t step, const Tick& all) noexcept;
    /// Points the ports of a step at what comes `by` activations later, its activation `to` in a call.
    void move_ports(std::size_t step, int by, int to, int frames) noexcept;
    void move_back(std::size_t step, int frames) noexcept;
    void hold_outputs(int frames) noexcept;
    /// After a call: what happened in it happened once.
    void clear_events(int frames) noexcept;
    /// Gives a node what drives its parameters at an activation of the call, and its events.
    void drive(const build::StepWires& wires, int activation) noexcept;
    void hash_outputs(const build::Step& step, int frames) noexcept;
    void record_outputs(const build::Step& step, int frames) noexcept;
    void put_into_frames(const build::PublishedOutput& output, int frames) noexcept;
    void publish(int frames) noexcept;

    static constexpr int timed_every = 64;  ///< nodes are timed in one call of so many

    compile::PlanGroup description_;
    Ring<build::GroupProgram*> programs_{64};
    ChangeQueue changes_;
    ParamRamps ramps_;
    build::GroupProgram* program_ = nullptr;
    build::GroupProgram* upcoming_ = nullptr;
    std::unique_ptr<Decisions> decisions_;
    bool fades_for_plan_ = false, has_let_go_ = false, is_paused_ = false;
    std::size_t taken_ = 0;  ///< of `scheduled`
    std::int64_t next_ = 0, last_ = -1, ran_ = 0;
    int closely_ = 0;  ///< calls still to be timed
    RecordStream* recorded_ = nullptr;  ///< where the outputs of this call go
    int begun_ = 0;  ///< activations of the call that has begun and not ended
    int committing_ = 0;  ///< activations whose forces are being committed
    std::uint64_t calls_ = 0;
    std::atomic<std::int64_t> plan_number_{-1};
    std::atomic<std::int64_t> rests_{0};
    std::atomic<bool> over_{false};
    alignas(64) std::atomic<std::int64_t> done_{0};
    std::atomic<std::int64_t> computed_{0};
};

}  // namespace tactus::run
