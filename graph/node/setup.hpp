// SPDX-License-Identifier: Apache-2.0
// Arguments that the engine passes to a node: `Setup` to `prepare`, `Tick` to `process`, `Report` after the run.
#pragma once

#include "dsp/control/force_limiter.hpp"
#include "dsp/control/force_state.hpp"
#include "dsp/control/late_return.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/time.hpp"
#include "graph/node/device.hpp"

#include <algorithm>
#include <any>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus {

struct ValueType;

/// One call of `process`: activations index … index + frames − 1 of the node's group.
struct Tick {
    std::int64_t index = 0;
    Flicks period = 0;   ///< logical time from one activation to the next
    Flicks elapsed = 0;  ///< logical time since the previous activation; more than one period after skipped ticks
    int frames = 1;      ///< always 1 outside audio groups

    double rate() const { return rate_of(period); }  ///< Hz
    double elapsed_seconds() const { return seconds(elapsed); }
    double time_seconds() const { return seconds(index * period); }
};

/// A device, shared by the nodes of one group. The engine fills `sample` before the nodes run and sends `wrench` and
/// `motors` to the driver after them. It outlives its nodes. `prepare` must not write here, because it may run in
/// parallel with the ticks of the node that is being replaced.
struct DevicePort {
    DeviceInfo info;
    DeviceSample sample;
    Wrench wrench;  ///< on the hand, in the device frame about the origin of the pose: N, N·m
    MotorDrive motors;
    control::Fault fault = control::Fault::none;  ///< reason why the node that writes `wrench` sends no force
    control::ForceState state = control::ForceState::unknown;  ///< of the node that writes `wrench`
    /// True before the plan changes: fade the force to zero, and ramp it in when this is false again.
    bool hold_off = false;
    /// Fault::late_value, old_world or unusable_value while a value on which the force depends is overdue or not
    /// finite: fade the force to zero.
    control::Fault overdue = control::Fault::none;
    /// Number of recoveries after late ticks. Kept here so that it survives an edit that replaces the node.
    control::LateReturn late;
};

enum class DeviceUse : std::uint8_t {
    read,  ///< the node reads the sample
    drive,  ///< the node writes the wrench; at most one node per device
};

/// A queue of values from a node to a file or a sound card. Another thread empties it.
class RecordStream {
public:
    virtual ~RecordStream() = default;
    /// Adds `count` values of the stream's type, `stride` bytes apart, for the activations first, first + 1, … Returns
    /// false if the queue is full; the values are then lost. Wait-free.
    virtual bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept = 0;
};

/// Writes a stream to a file in its own format. One thread calls it, never in a tick; it may wait for the disk.
class StreamKeeper {
public:
    virtual ~StreamKeeper() = default;
    /// Opens the stream's file, before the run. Throws Error.
    virtual void open(const std::string& path) = 0;
    /// Adds `count` adjacent values of the stream's type for the activations first, first + 1, …
    virtual void take(std::int64_t first, const std::byte* values, std::size_t count) = 0;
    /// Writes all values received so far to the file. Throws Error; the caller then tries again later.
    virtual void save() = 0;
    /// Closes the file, after the run. Throws Error.
    virtual void finish() = 0;
};

/// Content of a recorded stream. Signals are written as sound files, other types as CSV with the time as first column.
struct StreamFormat {
    std::string file;  ///< name in the run's folder: "haptuator.wav", "force.csv"
    std::string unit;  ///< of one full value, "m/s^2"
    const ValueType* type = nullptr;
    Flicks period = 0;
    std::shared_ptr<StreamKeeper> keeper{};  ///< writes the file; null: the engine writes it
};

/// Destination of a sound in a live run.
struct SoundPlace {
    std::string card;  ///< substring of a card's name; "": the card that the run chooses
    /// From 1: a channel of the stream that is common to all nodes on that card, synchronous to the sample. 0: a
    /// separate stream with one channel.
    int channel = 0;
    std::string name;  ///< of the channel, shown by other programs
    int max_frames = 1;  ///< most samples per write
    SourceLocation where;
};

/// Access to resources outside the patch during `prepare`: devices, recordings, sound. `where` is the location of the
/// node in the patch, for errors.
class Host {
public:
    virtual ~Host() = default;
    /// The haptic device with that name ("": the only one). Opens it on first use. Throws Error.
    virtual DevicePort& device(const std::string& name, DeviceUse use, const SourceLocation& where) = 0;
    /// A file in the run's folder. Throws Error.
    virtual RecordStream& record(const StreamFormat& format, const SourceLocation& where) = 0;
    /// An output for a listener or an actuator: the sound card in a live run with a card, otherwise the format's file.
    /// Throws Error.
    virtual RecordStream& audio(const StreamFormat& format, const SoundPlace& place) = 0;
    /// A stream to another program in a live run, sent by the format's keeper; in other runs the values are discarded.
    /// Throws Error.
    virtual RecordStream& send(const StreamFormat& format, const SourceLocation& where) = 0;
};

/// Arguments of `prepare`.
struct Setup {
    std::string name;  ///< of the node, as in the patch
    SourceLocation where;  ///< of the node in the patch
    Flicks period = 0;  ///< of the node's group
    int max_frames = 1;  ///< most activations of one call; size buffers for it
    std::uint64_t seed = 0;  ///< for the node's random numbers; differs from node to node
    Host* host = nullptr;

    double rate() const { return rate_of(period); }
    /// Throws Error with the node's location in the patch.
    [[noreturn]] void fail(const std::string& message) const { throw Error(where, message); }
};

/// Results of the nodes of a finished run, by section and key. They are written to summary.json.
struct Report {
    using Value = std::variant<double, std::string, std::vector<double>>;
    std::map<std::string, std::map<std::string, Value>> sections;
    /// Large results for the caller, such as the cut bone; not in summary.json.
    std::map<std::string, std::any> results;

    void set(const std::string& section, const std::string& key, Value value) {
        sections[section][key] = std::move(value);
    }
    /// Sections that several nodes share: the larger of the values; their sum; the first text that is not `nothing`.
    void raise(const std::string& section, const std::string& key, double value) {
        set(section, key, std::max(value, number(section, key).value_or(value)));
    }
    void add(const std::string& section, const std::string& key, double value) {
        set(section, key, value + number(section, key).value_or(0.0));
    }
    void set_unless(const std::string& nothing, const std::string& section, const std::string& key, std::string text) {
        const auto& values = sections[section];
        const auto found = values.find(key);
        if (found == values.end() || std::get<std::string>(found->second) == nothing)
            set(section, key, std::move(text));
    }
    std::optional<double> number(const std::string& section, const std::string& key) const {
        const auto values = sections.find(section);
        if (values == sections.end()) return std::nullopt;
        const auto found = values->second.find(key);
        return found == values->second.end() ? std::nullopt : std::optional(std::get<double>(found->second));
    }
};

}  // namespace tactus
