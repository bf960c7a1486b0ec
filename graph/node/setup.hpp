// SPDX-License-Identifier: Apache-2.0
// What a node is given: `Setup` in `prepare`, `Tick` in `process`, `Report` after the run.
#pragma once

#include "dsp/control/force_limiter.hpp"
#include "dsp/control/force_state.hpp"
#include "dsp/control/late_return.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/time.hpp"
#include "graph/node/device.hpp"

#include <any>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
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
/// `motors` to the driver after them. It outlives its nodes; `prepare` writes nothing here, as it may run beside the ticks
/// of the node that it replaces.
struct DevicePort {
    DeviceInfo info;
    DeviceSample sample;
    Wrench wrench;  ///< on the hand, in the device frame about the origin of the pose: N, N·m
    MotorDrive motors;
    control::Fault fault = control::Fault::none;  ///< why the node that writes `wrench` sends no force
    control::ForceState state = control::ForceState::unknown;  ///< of the node that writes `wrench`
    /// True before the plan changes: fade the force to zero. Ramp it in when this is false again.
    bool hold_off = false;
    /// Fault::late_value, old_world or unusable_value while a value on which the force depends is overdue or not finite: fade
    /// the force to zero.
    control::Fault overdue = control::Fault::none;
    /// How often forces came back after late ticks: an edit that replaces the node does not forget it.
    control::LateReturn late;
};

enum class DeviceUse : std::uint8_t {
    read,  ///< the node reads the sample
    drive,  ///< the node writes the port's wrench; one node per device may
};

/// A queue of values from a node to a file or a sound card. Another thread empties it.
class RecordStream {
public:
    virtual ~RecordStream() = default;
    /// Adds `count` values of the stream's type, `stride` bytes apart: those of activations first, first + 1, … Returns
    /// false when there is no room; the values are then lost. Wait-free.
    virtual bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept = 0;
};

/// Writes a stream to a file in a format of its own. One thread calls it, never in a tick; it may wait for the disk.
class StreamKeeper {
public:
    virtual ~StreamKeeper() = default;
    /// Opens the stream's file, before the run. Throws Error.
    virtual void open(const std::string& path) = 0;
    /// Adds `count` values of the stream's type, adjacent: those of activations first, first + 1, …
    virtual void take(std::int64_t first, const std::byte* values, std::size_t count) = 0;
    /// Writes all values taken so far to the file. Throws Error; the caller then tries again later.
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
    std::shared_ptr<StreamKeeper> keeper{};  ///< writes the file; null: the engine does
};

/// Where a sound goes in a live run.
struct SoundPlace {
    std::string card;  ///< part of a card's name; "": the one that the run chooses
    /// From 1: that channel of a stream that all nodes with a channel of the card share, sample by sample. 0: a stream of
    /// its own with one channel.
    int channel = 0;
    std::string name;  ///< of the channel, for programs that show it
    int max_frames = 1;  ///< most samples per write
    SourceLocation where;
};

/// Gives `prepare` what lies outside the patch: devices, recordings, sound. `where` is the place of the node in the
/// patch, for errors.
class Host {
public:
    virtual ~Host() = default;
    /// The haptic device of that name ("": the only one). Opens it on first use. Throws Error.
    virtual DevicePort& device(const std::string& name, DeviceUse use, const SourceLocation& where) = 0;
    /// A file in the run's folder. Throws Error.
    virtual RecordStream& record(const StreamFormat& format, const SourceLocation& where) = 0;
    /// Sound for a listener or an actuator: to the sound card in a live run with a card, otherwise to the format's
    /// file. Throws Error.
    virtual RecordStream& audio(const StreamFormat& format, const SoundPlace& place) = 0;
    /// Values for another program, which the format's keeper sends, in a live run; otherwise they go nowhere. Throws Error.
    virtual RecordStream& send(const StreamFormat& format, const SourceLocation& where) = 0;
};

/// What `prepare` is given.
struct Setup {
    std::string name;  ///< of the node, as in the patch
    SourceLocation where;  ///< of the node in the patch
    Flicks period = 0;  ///< of the node's group
    int max_frames = 1;  ///< most activations of one call; size buffers for it
    std::uint64_t seed = 0;  ///< for the node's random numbers; differs from node to node
    Host* host = nullptr;

    double rate() const { return rate_of(period); }
    /// Throws Error at the node's place in the patch.
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
};

}  // namespace tactus
