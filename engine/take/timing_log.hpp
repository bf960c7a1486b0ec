// SPDX-License-Identifier: Apache-2.0
// Everything that timing decided in a live run, as one kind of record. An offline run fed with the log computes the
// bits of the live run, whatever was late in it.
#pragma once

#include "assets/file/growing_file.hpp"
#include "dsp/core/ring.hpp"
#include "dsp/core/time.hpp"
#include "graph/node/device.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::take {

enum class TimingKind : std::uint8_t {
    device_sample,  ///< `source` is the device
    held_read,      ///< activations tick … tick + count − 1 read index `value` of link `source`
    skipped,        ///< activations tick … tick + count − 1 never ran
    dropped,        ///< publications tick … tick + count − 1 towards link `source` found no room
    parameter,  ///< from activation tick on, the parameter change numbered `value` holds; it comes in over `source`
    ///< activations, 0: at once
    fade,  ///< from activation tick on, forces fade: `source` 0, because the plan will change; 1, because of a
    ///< pause, which `value` 1 begins and 0 ends
    plan,  ///< from activation tick on, the plan numbered `value` runs; what it changes of parameters on which a force
    ///< depends comes in over `source` activations, 0: at once
    progress,  ///< all before tick is in the log; where a log that was cut off can be trusted to
    end,  ///< the group ran up to tick − 1
    whole,  ///< the last record of a log that was written to its end; `value` is the number of all records
    heard,  ///< samples of sound input `source`, in `sample` (take/sound_record.hpp): the last `value` ones of
    ///< activations tick … tick + count − 1
    overdue,  ///< from activation tick on, source `value` of the force on device `source` is overdue; −1: none is
};

/// Written by the group that decides, in its own order.
struct TimingRecord {
    TimingKind kind = TimingKind::end;
    std::uint16_t group = 0;
    std::uint32_t source = 0;
    std::int32_t count = 0;
    std::int64_t tick = 0;
    std::int64_t value = 0;
    DeviceSample sample;
};

/// A log read back: the records of each group, in order.
struct TimingLog {
    std::uint64_t plan_hash = 0;
    double seconds = 0.0;  ///< as asked for
    /// False: the run was cut off, or records are missing. The log then ends at the last time that all groups had reached.
    bool is_whole = true;
    std::int64_t records = 0;  ///< in the file
    std::optional<std::int64_t> written;  ///< number of records, as the last record states it
    std::vector<std::vector<TimingRecord>> groups;
    Flicks cut = 0;  ///< of a run that was cut off: logical time up to which it can be repeated

    /// `may_be_cut` accepts a log that stops anywhere, as after a crash. Throws Error when the file is missing, not a
    /// log, or was not written to its end.
    static TimingLog load(const std::filesystem::path& path, bool may_be_cut = false);

    /// Activations of a group that can be repeated.
    std::int64_t end_of(std::size_t group, Flicks period) const;
};

/// Writes a log outside of the ticks.
class TimingLogWriter {
public:
    enum class Name {
        when_whole,  ///< written as PATH.part and renamed when complete
        at_once,  ///< readable while it grows
    };
    TimingLogWriter(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds,
                    Name name = Name::when_whole);
    ~TimingLogWriter();
    TimingLogWriter(const TimingLogWriter&) = delete;
    TimingLogWriter& operator=(const TimingLogWriter&) = delete;

    /// Throws Error when there is no room, once; the log ends with the last whole record then.
    void write(const TimingRecord& record);
    /// Passes what was written to the operating system: a crash of the program does not lose it.
    void flush();
    /// Writes the last record. When the disk is full the log keeps its name and counts as cut off. Throws Error.
    void finish();
    std::uint64_t size() const { return bytes_; }
    std::int64_t records() const { return static_cast<std::int64_t>(bytes_ / sizeof(TimingRecord)); }

private:
    std::filesystem::path path_, part_;
    std::unique_ptr<file::GrowingFile> file_;
    std::uint64_t bytes_ = 0;
};

}  // namespace tactus::take
