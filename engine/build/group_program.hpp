// SPDX-License-Identifier: Apache-2.0
// The program of one rate group in one plan: steps, links, and the settings to apply when the group takes it over. The
// control thread builds it; afterwards only the group's thread uses it.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/signal_hash.hpp"
#include "engine/build/delay_line.hpp"
#include "engine/build/event_merge.hpp"
#include "engine/io/device_slot.hpp"
#include "engine/io/frames.hpp"
#include "engine/io/sound_heard.hpp"
#include "engine/observe/telemetry.hpp"
#include "engine/run/link.hpp"
#include "graph/node/device.hpp"
#include "graph/node/setup.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
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

/// Numbers that drive a parameter before its node's step, one for each activation of a call. They come from the same
/// group, or from a wire that changes within calls.
struct Drive {
    Param* param = nullptr;
    const std::byte* values = nullptr;
    std::ptrdiff_t stride = 0;

    void apply(int activation) const noexcept {
        param->drive(*reinterpret_cast<const double*>(values + activation * stride));
    }
};

/// The part of a node that every call reads; 32 bytes, so that a long chain needs few cache lines.
struct Step {
    void (*process)(void*, const Tick&) noexcept = nullptr;
    void* node = nullptr;
    std::uint32_t first_output = 0, output_count = 0;  ///< in the program's `published`
    bool driven = false;  ///< has event inputs, or parameters driven by numbers that may change within a call
    bool one_at_a_time = false;  ///< in an audio group: called once per activation
};

/// The other data of a step, at the same index.
struct StepWires {
    std::vector<Drive> drives;
    std::vector<EventMerge*> events;  ///< for each of its event inputs
    std::vector<Input*> inputs;  ///< all except those of `batches` and `events`
    std::vector<const run::LinkWire*> batches;  ///< wires that may deliver values at any activation of a call
    observe::NodeTelemetry* time = nullptr;
    std::int64_t spent_ns = 0;  ///< processor time in this call, if in a cycle
};

/// Consecutive steps. Steps of a cycle run a few activations at a time, all others a whole call at a time.
struct Stretch {
    std::size_t first = 0, count = 0;
    int longest = 0;  ///< activations per pass, in a cycle; 0: not a cycle
    std::vector<DelayLine*> inner;  ///< delays within the cycle
    std::vector<DelayLine*> before;  ///< delays into one of the steps from an earlier stretch or an earlier call
};

/// An output and the hash of all its values. The values of a signal are valid only until its last reader has run (see
/// graph/compile/layout.hpp), so each is hashed and copied into the frames directly after its step.
struct PublishedOutput {
    Output* port = nullptr;
    bool is_signal = false;
    Hash hash;
    SignalHash samples;
    std::size_t offset = 0;  ///< in the frames of the group
    observe::ObservedPort* seen = nullptr;  ///< port by which an observer reads it, or null
    std::string name;  ///< "node.port"
    int before = -1;  ///< the same output in the previous program, whose hash continues

    /// Returns the hash after `ran` activations of the group.
    std::uint64_t value(std::int64_t ran) const {
        return is_signal ? samples.value(static_cast<std::uint64_t>(ran)) : hash.value();
    }
};

/// An output of snapshots, and the readers that may still use its versions.
struct PublishedSnapshot {
    SnapshotOutput* port = nullptr;
    std::vector<const run::Link*> links;
    std::vector<const DelayLine*> delays;
};

/// An output of a surviving node, and the new location of its values.
struct MovedOutput {
    Output* port = nullptr;
    std::byte* to = nullptr;
    std::size_t bytes = 0;
};

/// A source of a device's force: another group on whose values it depends, or wires between groups that lead to it.
struct ValueSource {
    const run::GroupRuntime* group = nullptr;
    Flicks latency = 0;  ///< time from an activation until its values must be available
    Flicks limit = 0;  ///< tolerated delay before the force fades
    control::Fault fault = control::Fault::late_value;
    std::string name;  ///< for messages: "node 'contact' of the group '500 Hz'"
    const run::Link* link = nullptr;  ///< for wires: its producer becomes unusable when a value is not finite
    std::uint64_t wires = 0;  ///< of the link, as a set of Link::bit_of
};

/// A parameter of a surviving node, and its new value.
struct NewValue {
    Param* param = nullptr;
    double value = 0.0;
    run::ParamRamp* ramp = nullptr;  ///< ramp to the value, or null: immediately
};

/// The new maximum of a parameter of a surviving node.
struct NewLimit {
    Param* param = nullptr;
    double most = 0.0;
    run::ParamRamp* ramp = nullptr;  ///< ramp down to the maximum, or null: immediately
};

/// In live runs: closed until every hand that a plan reaches is without force. Common to the programs of the plan.
struct SwitchGate {
    std::atomic<int> closed_by{0};  ///< number of groups whose hands still receive a force
};

struct GroupProgram {
    std::int64_t plan_number = 0;
    Flicks switch_time = 0;  ///< logical time from which it runs
    int backlog = 0;  ///< activations that may run late
    bool changes_force = false;  ///< forces on a hand may jump when this program takes over
    Flicks fade_time = 0;  ///< forces fade from this time to `switch_time`; equal: no fade
    SwitchGate* gate = nullptr;  ///< the program takes over only when the gate is open; null: immediately
    std::vector<Step> steps;
    std::vector<StepWires> wires;
    std::vector<Stretch> stretches;  ///< of the steps, in order
    std::vector<PublishedOutput> published;  ///< every output, in the order of the steps
    bool hashes_outputs = true, records_outputs = false;
    io::FrameLayout layout;  ///< of all outputs, if they are or may be recorded
    std::vector<std::byte> frames;  ///< of a call
    /// Destination of the frames, or null. The control thread may change it while the group runs.
    std::atomic<RecordStream*> recorded{nullptr};
    static_assert(std::atomic<RecordStream*>::is_always_lock_free);
    std::int64_t ran = 0;  ///< activations of the group when the next program took over
    std::vector<run::Link*> inputs, outputs;  ///< links into and out of this group
    std::vector<const run::GroupRuntime*> producers;  ///< of each input link
    std::vector<run::Link*> new_inputs, new_outputs;  ///< links that start with this program
    std::vector<run::Link*> ended;  ///< links of the previous program that are no longer read
    std::vector<std::unique_ptr<DelayLine>> delays;
    std::vector<std::unique_ptr<EventMerge>> merges;
    std::vector<Output*> event_outputs;  ///< emptied after each call
    std::vector<io::DeviceSlot*> devices;
    std::vector<io::DeviceSlot*> driven;  ///< the devices whose force a node sets
    std::vector<std::vector<ValueSource>> sources;  ///< of each of them: force values first, wires last
    std::vector<Flicks> warm_ups;  ///< of each of them, as build::warm_up_of
    std::vector<bool> is_new_path;  ///< for each of them: its force path differs from that of the previous program
    std::vector<io::SoundHeard*> heard;
    std::vector<PublishedSnapshot> snapshots;
    // Actions of a takeover:
    std::vector<std::pair<Input*, const Input*>> wiring;  ///< inputs of surviving nodes, and their new wiring
    std::vector<NewLimit> limits;
    std::vector<NewValue> params;
    std::vector<MovedOutput> moved;
};

}  // namespace tactus::build
