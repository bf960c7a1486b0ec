// SPDX-License-Identifier: Apache-2.0
// What one plan makes of one rate group: steps, links and what has to be set when the group takes it over. Built by the
// control thread; from then on only the group's thread touches it.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/signal_hash.hpp"
#include "engine/io/device_guard.hpp"
#include "engine/observe/telemetry.hpp"
#include "engine/run/link.hpp"
#include "graph/node/device.hpp"
#include "graph/node/setup.hpp"

#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::observe {
class ObservedPort;
}
namespace tactus::run {
class GroupRuntime;
struct ParamRamp;
}  // namespace tactus::run

namespace tactus::build {

/// A number that drives a parameter before its node's step: from the same group, or gliding from another.
struct Drive {
    Param* param = nullptr;
    const Output* source = nullptr;  ///< same group
    const run::LinkWire* glide = nullptr;  ///< or a linear wire from another
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
    DelayLine* before = nullptr;  ///< the same wire in the program before, whose history goes on

    /// Lays out what activations tick … tick + count − 1 see. Wait-free.
    void recall(std::int64_t tick, int activations) noexcept {
        for (int i = 0; i < activations; ++i)
            std::memcpy(delayed.data() + static_cast<std::size_t>(i) * type->size, place(tick + i), type->size);
    }
    /// Keeps what those activations made. Wait-free.
    void remember(std::int64_t tick, int activations) noexcept {
        for (int i = 0; i < activations; ++i)
            std::memcpy(place(tick + i), source->data + i * source->stride, type->size);
    }

private:
    std::byte* place(std::int64_t tick) { return history.data() + static_cast<std::size_t>(tick % count) * type->size; }
};

/// What every call touches of a node; 32 bytes, so that a long chain runs through few cache lines.
struct Step {
    void (*process)(void*, const Tick&) noexcept = nullptr;
    void* node = nullptr;
    std::uint32_t first_output = 0, output_count = 0;  ///< in the program's `published`
    bool driven = false;  ///< numbers of this group, or gliding ones, drive its parameters
    bool one_at_a_time = false;  ///< in an audio group: called once per activation
};

/// The rest of it, at the same index.
struct StepWires {
    std::vector<Drive> drives;
    std::vector<Input*> inputs;
    observe::NodeTelemetry* time = nullptr;
};

/// An output and the hash over all it gave. The values of a signal are there only until its last reader has run (see
/// graph/compile/layout.hpp), so each is hashed and recorded right after its step.
struct PublishedOutput {
    Output* port = nullptr;
    bool is_signal = false;
    Hash hash;
    SignalHash samples;
    /// Where every value is recorded, or null: the control thread may set another while the group runs.
    alignas(std::atomic_ref<RecordStream*>::required_alignment) RecordStream* take = nullptr;
    observe::ObservedPort* seen = nullptr;  ///< where an observer finds it, or null
    std::string name;  ///< "node.port"
    int before = -1;  ///< the same output in the program before, whose hash goes on

    static_assert(std::atomic_ref<RecordStream*>::is_always_lock_free);
    void record_into(RecordStream* stream) noexcept { std::atomic_ref(take).store(stream, std::memory_order_release); }
    RecordStream* recorded_into() noexcept { return std::atomic_ref(take).load(std::memory_order_acquire); }

    /// After `ran` activations of the group.
    std::uint64_t value(std::int64_t ran) const {
        return is_signal ? samples.value(static_cast<std::uint64_t>(ran)) : hash.value();
    }
};

/// An output of a node that goes on, and where its values lie from now on.
struct MovedOutput {
    Output* port = nullptr;
    std::byte* to = nullptr;
    std::size_t bytes = 0;
};

/// A device of one group; see graph/node/setup.hpp for how nodes see it.
struct DeviceSlot {
    std::string name;
    std::unique_ptr<HapticDevice> device;
    DevicePort port;
    int group = -1;
    int id = 0;  ///< within its group
    Flicks period = 0;  ///< of that group
    io::DeviceGuard guard;  ///< live runs
    Wrench committed;  ///< of the last tick
};

/// A parameter of a node that goes on, and its value from now on.
struct NewValue {
    Param* param = nullptr;
    double value = 0.0;
    run::ParamRamp* ramp = nullptr;  ///< how it gets there, or null: at once
};

/// Live: closed until every hand that a plan reaches is without force. Shared by the programs of the plan.
struct SwitchGate {
    std::atomic<int> closed_by{0};  ///< groups whose hands still feel a force
};

struct GroupProgram {
    std::int64_t plan_number = 0;
    Flicks switch_time = 0;  ///< logical time from which on it runs
    int backlog = 0;  ///< activations that may run late
    bool changes_force = false;  ///< forces on a hand may jump when this takes over
    Flicks fade_time = 0;  ///< forces are faded from here to the switch; equal to it: they are not
    SwitchGate* gate = nullptr;  ///< it takes over only when that is open; null: nothing is asked
    std::vector<Step> steps;
    std::vector<StepWires> wires;
    std::vector<PublishedOutput> published;  ///< every output, in the order of the steps
    bool hashes_outputs = true, records_outputs = false;
    std::int64_t ran = 0;  ///< activations of the group when the next program took over
    std::vector<run::Link*> inputs, outputs;  ///< links into and out of this group
    std::vector<const run::GroupRuntime*> producers;  ///< of each input link
    std::vector<run::Link*> new_inputs, new_outputs;  ///< those that begin with this program
    std::vector<run::Link*> ended;  ///< links of the program before that are read no more
    std::vector<std::unique_ptr<DelayLine>> delays;
    std::vector<DeviceSlot*> devices;
    std::vector<DeviceSlot*> driven;  ///< those that a node gives a force
    std::vector<SnapshotOutput*> snapshots;
    // What to do when taking over:
    std::vector<std::pair<Input*, const Input*>> wiring;  ///< inputs of nodes that go on, and how they are wired now
    std::vector<NewValue> params;
    std::vector<MovedOutput> moved;
};

}  // namespace tactus::build
