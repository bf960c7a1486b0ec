// SPDX-License-Identifier: Apache-2.0
// All timing decisions of a live run, in one kind of record. An offline run with the log reproduces the bits of the
// live run, whatever was late in it.
#pragma once

#include "assets/file/growing_file.hpp"
#include "dsp/core/ring.hpp"
#include "dsp/core/time.hpp"
#include "engine/take/packed_records.hpp"
#include "engine/take/timing_record.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::take {

/// An index of a log file. The records themselves are read on demand (GroupRecords).
struct TimingLog {
    std::uint64_t plan_hash = 0;
    double seconds = 0.0;  ///< requested duration
    /// False if the run was interrupted or records are missing. The log then ends at the last time that all groups had
    /// reached.
    bool is_whole = true;
    std::int64_t records = 0;  ///< in the file
    std::optional<std::int64_t> written;  ///< number of records, as stated by the last one
    Flicks cut = 0;  ///< for an incomplete log: logical time up to which the run can be repeated

    /// Consecutive packed records of a group in the file.
    struct Chunk {
        std::uint64_t offset = 0;
        std::uint32_t length = 0;
    };
    struct Group {
        std::vector<Chunk> chunks;
        std::int64_t records = 0;
        std::optional<std::int64_t> end;  ///< one past its last activation
    };
    std::vector<Group> groups;
    std::shared_ptr<const int> file;  ///< descriptor, closed with the last copy

    /// `may_be_cut` accepts an incomplete log, as after a crash. Reads the whole file once to check it, and keeps an
    /// index. Throws Error if the file is missing, is not a log, or is incomplete without `may_be_cut`.
    static TimingLog load(const std::filesystem::path& path, bool may_be_cut = false);

    /// Number of activations of a group that can be repeated.
    std::int64_t end_of(std::size_t group, Flicks period) const;
};

/// The records of a group in order, read in pieces, so that memory does not grow with the log.
class GroupRecords {
public:
    /// Empty if the log has no such group.
    GroupRecords(const TimingLog& log, std::size_t group);
    explicit GroupRecords(std::vector<TimingRecord> all) : window_(all.begin(), all.end()) {}

    /// Returns record `i`, counted from 0, or null after the last one. `i` must not precede a forget_before.
    const TimingRecord* at(std::size_t i) noexcept;
    /// Reads up to the first record of that activation or a later one.
    void read_ahead(std::int64_t tick) noexcept;
    /// Releases the records before record `i`.
    void forget_before(std::size_t i) noexcept;

private:
    bool read_chunk();

    std::shared_ptr<const int> file_;
    std::vector<TimingLog::Chunk> chunks_;
    std::int64_t left_ = 0;  // number of records not read yet
    std::size_t next_chunk_ = 0;
    RecordUnpacker unpacker_;
    std::deque<TimingRecord> window_;
    std::size_t first_ = 0;  // number of the first record in the window
};

/// Writes a log outside of the ticks. The records of each group are packed separately and written in chunks.
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

    /// Throws Error once if the disk is full; the log then ends with the last whole chunk.
    void write(const TimingRecord& record);
    /// Flushes to the operating system: a crash of the program does not lose the data.
    void flush();
    /// Writes the last record. If the disk is full, the log keeps its name and counts as incomplete. Throws Error.
    void finish();
    std::uint64_t size() const { return bytes_; }  ///< of all chunks so far
    std::int64_t records() const { return records_; }

private:
    struct Packed {
        RecordPacker packer;
        std::string chunk;  // not yet written
    };
    void write_chunk(std::uint16_t group, Packed& packed);

    std::filesystem::path path_, part_;
    std::unique_ptr<file::GrowingFile> file_;
    std::map<std::uint16_t, Packed> groups_;
    std::uint64_t bytes_ = 0;
    std::int64_t records_ = 0;
};

}  // namespace tactus::take
