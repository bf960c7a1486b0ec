// SPDX-License-Identifier: Apache-2.0
// What a node sees: `Setup` while it prepares, `Tick` while it runs, `Report` when the run is over.
#pragma once

#include "dsp/control/force_limiter.hpp"
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

/// One call: activations index … index + frames − 1 of the node's group.
struct Tick {
    std::int64_t index = 0;
    Flicks period = 0;
    Flicks elapsed = 0;  ///< logical time since the previous activation; more than one period after skipped ticks
    int frames = 1;      ///< always 1 outside audio groups

    double rate() const { return rate_of(period); }
    double elapsed_seconds() const { return seconds(elapsed); }
    double time_seconds() const { return seconds(index * period); }
};

/// A device as the nodes of one group share it: the engine fills `sample` before the steps of an activation and hands
/// `wrench` and `motors` to the driver after them.
struct DevicePort {
    DeviceInfo info;
    DeviceSample sample;
    Wrench wrench;
    MotorDrive motors;
    control::Fault fault = control::Fault::none;  ///< why the node that writes `wrench` gives no force
    bool hold_off = false;  ///< the engine is about to change the plan: fade the force to zero, ramp in when this ends
};

enum class DeviceUse : std::uint8_t {
    read,
    drive,  ///< the node writes the port's wrench; one node per device may
};

/// Values that leave the graph for a file or a sound card. Whoever drains it is not in the tick.
class RecordStream {
public:
    virtual ~RecordStream() = default;
    /// `count` values of the stream's type, those of activations first, first + 1, …, `stride` bytes apart; false when
    /// there was no room and they were dropped. Wait-free.
    virtual bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept = 0;
};

/// Puts a stream's values where they are safe, in a form of its own. Called by one thread, never in a tick: it may wait
/// for a disk.
class StreamKeeper {
public:
    virtual ~StreamKeeper() = default;
    /// Before the run, with the stream's file. Throws Error.
    virtual void open(const std::string& path) = 0;
    /// Values of activations first, first + 1, …
    virtual void take(std::int64_t first, const std::byte* values, std::size_t count) = 0;
    /// All that was taken is safe when it returns. Throws Error; it is called again then.
    virtual void save() = 0;
    /// After the run. Throws Error.
    virtual void finish() = 0;
};

/// What a recorded stream holds. Signals become sound files, all else CSV with the time in front.
struct StreamFormat {
    std::string file;  ///< name within the run's folder: "haptuator.wav", "force.csv"
    std::string unit;  ///< of one full value, "m/s^2"
    const ValueType* type = nullptr;
    Flicks period = 0;
    std::shared_ptr<StreamKeeper> keeper{};  ///< who writes the file; none: the engine does
};

/// What `prepare` asks for from outside of the patch: devices, recordings, sound.
class Host {
public:
    virtual ~Host() = default;
    /// The haptic device of that name ("" = the only one), opened on first use. Throws Error.
    virtual DevicePort& device(const std::string& name, DeviceUse use, const SourceLocation& where) = 0;
    virtual RecordStream& record(const StreamFormat& format, const SourceLocation& where) = 0;
    /// Sound for a listener or an actuator: the card when the run is live and there is one, else the format's file.
    virtual RecordStream& audio(const StreamFormat& format, const SourceLocation& where) = 0;
};

struct Setup {
    std::string name;  ///< of the node, as in the patch
    SourceLocation where;  ///< of the node in the patch
    Flicks period = 0;  ///< of its group
    int max_frames = 1;  ///< most activations one call may run
    std::uint64_t seed = 0;  ///< for its random numbers; differs per node
    Host* host = nullptr;

    double rate() const { return rate_of(period); }
    [[noreturn]] void fail(const std::string& message) const { throw Error(where, message); }
};

/// What the nodes have to say about a finished run, by section and key. Becomes summary.json.
struct Report {
    using Value = std::variant<double, std::string, std::vector<double>>;
    std::map<std::string, std::map<std::string, Value>> sections;
    std::map<std::string, std::any> results;  ///< large things to look at afterwards, such as the cut bone

    void set(const std::string& section, const std::string& key, Value value) {
        sections[section][key] = std::move(value);
    }
};

}  // namespace tactus
