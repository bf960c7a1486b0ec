// SPDX-License-Identifier: Apache-2.0
// The decisions of a rate group that depend on timing: which value a link delivers, what is skipped or dropped, when a
// change takes effect. They come from the clock or from the log of an earlier run; the tick code is the same for both.
#pragma once

#include "dsp/core/ring.hpp"
#include "engine/build/group_program.hpp"
#include "engine/io/driver_gate.hpp"
#include "engine/run/param_ramps.hpp"
#include "engine/take/timing_log.hpp"

#include <atomic>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace tactus::run {

class GroupRuntime;
class Link;

/// A parameter set from outside while the patch runs.
struct ParameterChange {
    std::int64_t id = 0;  ///< its number in the take
    Flicks when = 0;     ///< applied at the first activation at or after this time
    Param* param = nullptr;
    double value = 0.0;  ///< SI
    ParamRamp* ramp = nullptr;  ///< ramp to the value, or null: immediately
};

/// Changes of a replayed run, by their number in the log.
using ReplayedChanges = std::unordered_map<std::int64_t, ParameterChange>;

/// The queue of changes to one group.
struct ChangeQueue {
    Ring<ParameterChange> ring{1024};
    std::int64_t given = 0;  ///< control thread
    std::atomic<std::int64_t> applied{0};  ///< changes that are no longer referenced
};

/// The log of a group's decisions. Without a ring it records nothing.
class DecisionLog {
public:
    explicit DecisionLog(int group) : group_(static_cast<std::uint16_t>(group)) {}

    /// Set by the control thread while the group's thread does not run.
    Ring<take::TimingRecord>* ring = nullptr;
    std::atomic<bool> overflow{false};  ///< a record was dropped for lack of room

    struct Entry {
        int source = 0;
        std::int64_t count = 0, value = 0;
        const DeviceSample* sample = nullptr;
    };
    /// Group's thread; wait-free.
    void note(take::TimingKind kind, std::int64_t tick, const Entry& entry) noexcept;

private:
    std::uint16_t group_;
};

/// The index that a call reads from a link.
struct LinkReading {
    std::int64_t index = 0;
    bool is_late = false;  ///< older than the wanted one
};

/// All functions: group's thread, wait-free except `acquire` and `commit`, whose drivers may make system calls. `tick`
/// is the activation at which the call begins.
class Decisions {
public:
    explicit Decisions(DecisionLog& log) : log_(log) {}
    virtual ~Decisions() = default;
    Decisions(const Decisions&) = delete;
    Decisions& operator=(const Decisions&) = delete;

    // Before a call.
    /// Returns the next activation to run: `tick`, or a later one if a log skips some.
    virtual std::int64_t skip_from(std::int64_t tick) const noexcept;
    /// Sets the parameters that are due, in `ramps`; `plan` is the number of the running plan.
    virtual void apply_parameters(std::int64_t tick, std::int64_t plan, ParamRamps& ramps) noexcept = 0;
    /// Returns the number of activations over which the parameters that differ in `next`, which takes over now, change.
    virtual std::int64_t ramp_length(std::int64_t tick) const noexcept = 0;
    /// True if forces are suspended because the run pauses. `before`: the previous result.
    virtual bool holds_off(std::int64_t tick, bool before) noexcept;
    /// True if a change of a parameter is pending.
    virtual bool has_changes() noexcept;
    /// True if a log determines the decisions, including those after the last activation.
    virtual bool is_replayed() const noexcept;
    /// True if `next` takes over now from the running program.
    virtual bool switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept = 0;
    /// True if forces fade from now on because `next` will take over. Called until it returns true.
    virtual bool fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept = 0;
    /// Returns the first activation in tick + 1 … until − 1 at which one of these decisions may change, or `until`.
    /// `next` is the pending program, or null.
    virtual std::int64_t end_of_call(std::int64_t tick, std::int64_t until,
                                     const build::GroupProgram* next) const noexcept = 0;

    // Scheduling on the virtual clock. A live run never waits.
    /// Returns the index of `link` that must be available before the call.
    virtual std::int64_t awaited(const Link& link, std::int64_t tick) const noexcept;
    /// Returns the first activation in tick + 1 … until − 1 for which `link` may not have its value yet, or `until`.
    /// The value for `tick` is available, or will be missed.
    virtual std::int64_t readable_until(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                                        std::int64_t until) const noexcept;
    /// True if all `links` have room for the values to publish.
    virtual bool has_room(const std::vector<Link*>& links, std::int64_t tick, int frames) const noexcept;
    /// True if `links` have enough room to begin.
    virtual bool may_begin(const std::vector<Link*>& links, std::int64_t tick) const noexcept;

    // In a call.
    /// Reads the device's state into its port. `elapsed` in flicks since the last call. If the thread was abandoned in
    /// the driver, `driver` reports it.
    virtual void acquire(io::DeviceSlot& slot, std::int64_t tick, Flicks elapsed) noexcept;
    /// Returns the index of the first of the `sources` of a device's force that is overdue or not finite; −1: none.
    /// `slot.overdue` holds the previous result. Wait-free.
    virtual int overdue(const io::DeviceSlot& slot, const std::vector<build::ValueSource>& sources,
                        std::int64_t tick) noexcept;
    /// Fills the port with the activations of the call, due at steady time `due_ns`. Wait-free.
    virtual void hear(io::SoundHeard& heard, std::int64_t tick, int frames, std::int64_t due_ns) noexcept;
    virtual LinkReading read(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                             int frames) noexcept = 0;
    /// True if the values of the call are not published on `link`.
    virtual bool drops(const Link& link, std::int64_t tick, int frames) noexcept;
    /// Sends the device its force, which is within its limits, and the motor speeds of its port.
    virtual void commit(io::DeviceSlot& slot) noexcept = 0;
    /// Sends zero force to the device, through its guard.
    void let_rest(io::DeviceSlot& slot) noexcept;
    /// Notifies that all activations before `tick` are complete.
    virtual void pass(std::int64_t tick) noexcept;

    io::DriverGate driver;  ///< every driver call passes it

protected:
    /// Returns the newest available index, at most the wanted one.
    static std::int64_t newest(const Link& link, const GroupRuntime& producer, std::int64_t tick) noexcept;
    /// True if `index` is older than the wanted one, unless the producer has ended: `last` is its last activation.
    static bool is_late(const Link& link, std::int64_t index, std::int64_t last, std::int64_t tick) noexcept;
    /// Reads the device itself.
    void sample(io::DeviceSlot& slot, Flicks elapsed) noexcept;
    void note_heard(const io::SoundHeard& heard, std::int64_t tick, int frames) noexcept;

    DecisionLog& log_;
};

}  // namespace tactus::run
