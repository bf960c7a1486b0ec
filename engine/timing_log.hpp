// SPDX-License-Identifier: Apache-2.0
// Everything that timing decided in a live run, as one kind of record. An offline run fed with the log computes the
// bits of the live run, however bad it was.
#pragma once

#include "dsp/core/ring.hpp"
#include "graph/device.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus {

enum class TimingKind : std::uint8_t {
    device_sample,  ///< `source` is the device
    held_read,      ///< activations tick … tick + count − 1 read index `value` of link `source`
    skipped,        ///< activations tick … tick + count − 1 never ran
    dropped,        ///< publications tick … tick + count − 1 towards link `source` found no room
    end,            ///< the group ran up to tick − 1
};

/// Written by the group that decides, in its own order.
struct TimingRecord {
    TimingKind kind = TimingKind::end;
    std::uint8_t group = 0;
    std::uint16_t source = 0;
    std::int32_t count = 0;
    std::int64_t tick = 0;
    std::int64_t value = 0;
    DeviceSample sample;
};

/// A log read back: the records of each group, in order.
struct TimingLog {
    std::uint64_t plan_hash = 0;
    double seconds = 0.0;  ///< as asked for
    std::vector<std::vector<TimingRecord>> groups;

    /// Throws Error when the file is missing, not a log, or was not written to its end.
    static TimingLog load(const std::filesystem::path& path);
};

/// Writes a log outside of the ticks; renamed from PATH.part when complete.
class TimingLogWriter {
public:
    TimingLogWriter(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds, std::size_t groups);
    ~TimingLogWriter();
    TimingLogWriter(const TimingLogWriter&) = delete;
    TimingLogWriter& operator=(const TimingLogWriter&) = delete;

    void write(const TimingRecord& record);
    void finish();

private:
    std::filesystem::path path_, part_;
    std::FILE* file_ = nullptr;
};

}  // namespace tactus
