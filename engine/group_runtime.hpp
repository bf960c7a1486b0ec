// SPDX-License-Identifier: Apache-2.0
// One rate group while it runs: its steps, links, devices, hashes, and where it is in logical time.
#pragma once

#include "dsp/core/signal_hash.hpp"
#include "engine/link.hpp"
#include "engine/telemetry.hpp"
#include "engine/timing_log.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus {

/// A number that drives a parameter before its node's step: from the same group, or gliding from another.
struct Drive {
    Param* param = nullptr;
    const Output* source = nullptr;   ///< same group
    const LinkWire* glide = nullptr;  ///< or a linear wire from another
};

/// A wire that closes a loop inside a group: the value `count` activations ago.
struct DelayLine {
    const ValueType* type = nullptr;
    const Output* source = nullptr;
    Input* target = nullptr;
    Param* param = nullptr;
    std::int64_t count = 1;
    std::vector<std::byte> history;  ///< `count` values, activation index modulo count
    std::vector<std::byte> delayed;  ///< the values of this call
};

/// What every call touches of a node; 32 bytes, so that a long chain runs through few cache lines.
struct Step {
    void (*process)(void*, const Tick&) noexcept = nullptr;
    void* node = nullptr;
    std::uint32_t first_output = 0, output_count = 0;  ///< in the group's `published`
    bool driven = false;         ///< numbers of this group, or gliding ones, drive its parameters
    bool one_at_a_time = false;  ///< in an audio group: called once per activation
};

/// The rest of it, at the same index.
struct StepWires {
    std::vector<Drive> drives;
    std::vector<Input*> inputs;
};

/// An output and the hash over all it gave. The values of a signal are there only until its last reader has run (see
/// graph/layout.hpp), so each is hashed right after its step.
struct PublishedOutput {
    Output* port = nullptr;
    bool is_signal = false;
    Hash hash;
    SignalHash samples;
};

/// A device of this group; see graph/setup.hpp for how nodes see it.
struct DeviceSlot {
    std::string name;
    std::unique_ptr<HapticDevice> device;
    DevicePort port;
    int group = -1;
    int id = 0;  ///< within its group
};

/// What decides when a value counts as being there.
enum class Pace { offline, live };

class GroupRuntime {
public:
    const PlanGroup* plan = nullptr;
    int index = 0;
    int max_frames = 1;
    int backlog = 0;
    std::atomic<std::int64_t> end{0};  ///< activations 0 … end − 1 run; only ever lowered while running
    std::vector<Step> steps;
    std::vector<StepWires> wires;
    std::vector<PublishedOutput> published;  ///< every output, in the order of the steps
    bool hashes_outputs = true;
    std::vector<Link*> inputs, outputs;         ///< links into and out of this group
    std::vector<const GroupRuntime*> producers; ///< of each input link
    std::vector<DelayLine> delays;
    std::vector<DeviceSlot*> devices;
    std::vector<Output*> snapshots;
    Flicks now = 0;  ///< logical time of the call that runs
    const std::vector<TimingRecord>* replayed = nullptr;  ///< decisions to repeat, or null
    Ring<TimingRecord>* log = nullptr;                    ///< where live decisions go, or null
    GroupTelemetry telemetry;
    std::atomic<bool> log_overflow{false};

    /// Next activation to run. Own thread only.
    std::int64_t next() const { return next_; }
    bool finished() const { return next_ >= end.load(std::memory_order_relaxed); }
    /// Activations that ran. Own thread, or after the run.
    std::int64_t ran() const { return ran_; }
    /// Hash over every value of published[k]. Own thread, or after the run.
    std::uint64_t hash_of(std::size_t k) const;
    /// Activations before this one are complete; their values may be read. Any thread.
    std::int64_t done() const noexcept { return done_.load(std::memory_order_acquire); }

    /// Offline: every value that the next call reads is there and its slots are free.
    bool ready() const noexcept;
    /// Runs one call and returns how many activations it covered. At most `frames` of them.
    int call(int frames, Pace pace) noexcept;
    /// Leaves out activations up to `to`, because they are too late.
    void skip_to(std::int64_t to) noexcept;
    /// Repeats a logged skip that starts at the next activation; false when there is none.
    bool replay_skip() noexcept;
    void end_at(std::int64_t tick) noexcept;

private:
    int cut(int frames) const noexcept;
    const TimingRecord* replayed_at(TimingKind kind, std::uint16_t source, std::int64_t tick) const noexcept;
    void read_links(int frames, Pace pace) noexcept;
    void acquire(Pace pace) noexcept;
    void run_steps(int frames) noexcept;
    template <bool hashed>
    void run_each(const Tick& tick) noexcept;
    void drive(const StepWires& step, int i) noexcept;
    void run_one_at_a_time(const Step& step, const StepWires& of, const Tick& all) noexcept;
    void hash_outputs(const Step& step, int frames) noexcept;
    void publish(int frames, Pace pace) noexcept;
    void note(TimingKind kind, int source, std::int64_t count, std::int64_t value, const DeviceSample* sample) noexcept;

    std::int64_t next_ = 0, last_ = -1, ran_ = 0;
    mutable std::size_t cursor_ = 0;  ///< replayed records before this one are past
    alignas(64) std::atomic<std::int64_t> done_{0};
};

}  // namespace tactus
