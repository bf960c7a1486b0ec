// SPDX-License-Identifier: Apache-2.0
// The decisions of a rate group that depend on timing: which value a link gives, what is skipped or dropped, when a
// change takes effect. They come from the clock or from the log of an earlier run; the tick does not know which.
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
    std::int64_t id = 0;  ///< as the take names it
    Flicks when = 0;     ///< applied at the first activation at or after
    Param* param = nullptr;
    double value = 0.0;  ///< SI
    ParamRamp* ramp = nullptr;  ///< how it gets there, or null: at once
};

/// Changes of a run that is repeated, by their number in the log.
using ReplayedChanges = std::unordered_map<std::int64_t, ParameterChange>;

/// The changes of one group on their way to it.
struct ChangeQueue {
    Ring<ParameterChange> ring{1024};
    std::int64_t given = 0;  ///< control thread
    std::atomic<std::int64_t> applied{0};  ///< nothing refers to these any more
};

/// Where a group notes its decisions. Without a ring it notes nothing.
class DecisionLog {
public:
    explicit DecisionLog(int group) : group_(static_cast<std::uint16_t>(group)) {}

    /// Set by the control thread while the group's thread does not run.
    Ring<take::TimingRecord>* ring = nullptr;
    std::atomic<bool> overflow{false};  ///< a record found no room

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

/// All functions: group's thread, wait-free except `acquire` and `commit`, which may call the system in drivers. `tick`
/// is the activation at which the call begins.
class Decisions {
public:
    explicit Decisions(DecisionLog& log) : log_(log) {}
    virtual ~Decisions() = default;
    Decisions(const Decisions&) = delete;
    Decisions& operator=(const Decisions&) = delete;

    // Before a call.
    /// The activation to go on with: `tick`, or a later one when a log leaves some out.
    virtual std::int64_t skip_from(std::int64_t tick) const noexcept;
    /// Sets the parameters that are due, in `ramps`; the plan numbered `plan` runs.
    virtual void apply_parameters(std::int64_t tick, std::int64_t plan, ParamRamps& ramps) noexcept = 0;
    /// Activations over which parameters change that `next`, which takes over now, has changed.
    virtual std::int64_t ramp_length(std::int64_t tick) const noexcept = 0;
    /// Forces are held off because the run pauses. `before`: what the last call said.
    virtual bool holds_off(std::int64_t tick, bool before) noexcept;
    /// A change of a parameter waits to be applied.
    virtual bool has_changes() noexcept;
    /// A log says what happens, also what happened after the last activation.
    virtual bool is_replayed() const noexcept;
    /// `next` takes over now from the program that runs.
    virtual bool switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept = 0;
    /// Forces fade from now on, because `next` will take over. Asked until it says yes.
    virtual bool fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept = 0;
    /// The first activation in tick + 1 … until − 1 at which one of these decisions may change, or `until`. `next` is
    /// the program that waits, or null.
    virtual std::int64_t end_of_call(std::int64_t tick, std::int64_t until,
                                     const build::GroupProgram* next) const noexcept = 0;

    // When to call, on the virtual clock. Live, nothing is waited for.
    /// The index of `link` that must be there before the call.
    virtual std::int64_t awaited(const Link& link, std::int64_t tick) const noexcept;
    /// The first activation in tick + 1 … until − 1 for which `link` may not have its value yet, or `until`. The value for
    /// `tick` is there, or will be missed.
    virtual std::int64_t readable_until(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                                        std::int64_t until) const noexcept;
    /// There is room on all `links` for what has to be published.
    virtual bool has_room(const std::vector<Link*>& links, std::int64_t tick, int frames) const noexcept;
    /// There is room enough on `links` to begin.
    virtual bool may_begin(const std::vector<Link*>& links, std::int64_t tick) const noexcept;

    // In a call.
    /// Puts the device's state into its port. `elapsed` in flicks since the last call. When the thread was left behind in
    /// the driver, `driver` says so.
    virtual void acquire(build::DeviceSlot& slot, std::int64_t tick, Flicks elapsed) noexcept;
    /// Which of the `sources` of the force on a device is overdue or not finite, the first of them; −1: none. `slot.overdue`
    /// has the answer of the call before. Wait-free.
    virtual int overdue(const build::DeviceSlot& slot, const std::vector<build::ValueSource>& sources,
                        std::int64_t tick) noexcept;
    /// Fills the port with the activations of the call, due at steady time `due_ns`. Wait-free.
    virtual void hear(io::SoundHeard& heard, std::int64_t tick, int frames, std::int64_t due_ns) noexcept;
    virtual LinkReading read(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                             int frames) noexcept = 0;
    /// What the call gives is not published on `link`.
    virtual bool drops(const Link& link, std::int64_t tick, int frames) noexcept;
    /// Gives the device the force, which is within its bounds, and the motor speeds of its port.
    virtual void commit(build::DeviceSlot& slot) noexcept = 0;
    /// Gives the device no force, through its guard.
    void let_rest(build::DeviceSlot& slot) noexcept;
    /// All activations before `tick` are complete.
    virtual void pass(std::int64_t tick) noexcept;

    io::DriverGate driver;  ///< every call of a driver passes it

protected:
    /// The newest index that is there, at most the wanted one.
    static std::int64_t newest(const Link& link, const GroupRuntime& producer, std::int64_t tick) noexcept;
    /// `index` is older than the wanted one, and not because the producer ended: `last` is its last activation.
    static bool is_late(const Link& link, std::int64_t index, std::int64_t last, std::int64_t tick) noexcept;
    /// From the device itself.
    void sample(build::DeviceSlot& slot, Flicks elapsed) noexcept;
    void note_heard(const io::SoundHeard& heard, std::int64_t tick, int frames) noexcept;

    DecisionLog& log_;
};

}  // namespace tactus::run
