// SPDX-License-Identifier: Apache-2.0
#include "engine/take/timing_log.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "engine/take/sound_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <type_traits>

namespace tactus::take {

namespace {

constexpr char magic[8] = {'T', 'A', 'C', 'T', 'L', 'O', 'G', '6'};

struct Header {
    char magic[8];
    std::uint64_t plan_hash;
    double seconds;
};
static_assert(std::is_trivially_copyable_v<Header> && std::is_trivially_copyable_v<TimingRecord>);

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

// A byte of a damaged file may be neither 0 nor 1, so it must not be read as a bool.
bool is_flag(const bool& flag) {
    unsigned char byte = 0;
    std::memcpy(&byte, &flag, sizeof byte);
    return byte <= 1;
}

bool has_flags(const DeviceSample& sample) {
    return is_flag(sample.valid) && is_flag(sample.taken) && is_flag(sample.late) && is_flag(sample.sound_lost);
}

}  // namespace

TimingLogWriter::TimingLogWriter(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds, Name name)
    : path_(path),
      part_(name == Name::when_whole ? path.string() + ".part" : path.string()),
      file_(std::make_unique<file::GrowingFile>(part_, path_)) {
    Header header{{}, plan_hash, seconds};
    std::memcpy(header.magic, magic, sizeof magic);
    file_->append({reinterpret_cast<const char*>(&header), sizeof header});
}

TimingLogWriter::~TimingLogWriter() {
    if (!file_) return;
    file_.reset();
    std::error_code ignored;
    if (part_ != path_) std::filesystem::remove(part_, ignored);
}

void TimingLogWriter::write(const TimingRecord& record) {
    // Padding bytes would make two logs of one run differ.
    alignas(TimingRecord) unsigned char bytes[sizeof(TimingRecord)] = {};
    TimingRecord* clean = new (bytes) TimingRecord;
    *clean = record;
    file_->append({reinterpret_cast<const char*>(bytes), sizeof bytes});
    bytes_ += sizeof bytes;
}

void TimingLogWriter::flush() { file_->flush(); }

void TimingLogWriter::finish() {
    const auto end = [this] {
        file_.reset();
        std::error_code failure;
        if (part_ != path_) std::filesystem::rename(part_, path_, failure);
        return failure;
    };
    TimingRecord last;
    last.kind = TimingKind::whole;
    last.value = records() + 1;
    try {
        write(last);
        file_->close();
    } catch (const Error&) {
        end();
        throw;
    }
    if (const std::error_code failure = end())
        throw Error(fmt::format("{}: cannot be renamed to {}: {}", part_.string(), path_.string(), failure.message()));
}

TimingLog TimingLog::load(const std::filesystem::path& path, bool may_be_cut) {
    if (std::filesystem::exists(path)) file::require_file(path);
    const std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "rb"));
    const auto fail = [&path](const std::string& what) { throw Error(fmt::format("{}: {}", path.string(), what)); };
    if (!file) fail(fmt::format("cannot read the timing log: {}", std::strerror(errno)));
    Header header;
    if (std::fread(&header, sizeof header, 1, file.get()) != 1 || std::memcmp(header.magic, magic, sizeof magic) != 0)
        fail("not a timing log of this version; make one with 'tactus run PATCH --log FILE'");
    TimingLog log;
    log.is_whole = false;
    log.plan_hash = header.plan_hash;
    log.seconds = header.seconds;
    TimingRecord record;
    while (std::fread(&record, sizeof record, 1, file.get()) == 1) {
        const bool has_samples = record.kind != TimingKind::heard ||
                                 (record.value >= 1 && record.value <= std::min(record.count, sound_record_samples));
        if (record.kind > TimingKind::overdue || record.tick < 0 || record.count < 0 || !has_flags(record.sample) ||
            !has_samples)
            fail("a record of the timing log is damaged");
        ++log.records;
        if (record.kind == TimingKind::whole) {
            log.written = record.value;
            log.is_whole = record.value == log.records;
            break;
        }
        if (log.groups.size() <= record.group) log.groups.resize(record.group + std::size_t{1});
        log.groups[record.group].push_back(record);
    }
    if (log.is_whole) return log;
    if (!may_be_cut && log.written)
        fail(fmt::format("the timing log holds {} records, but {} were written; it cannot be replayed to the bit",
                         log.records, *log.written));
    if (!may_be_cut) fail("the timing log stops before the end of the run; it cannot be replayed to the bit");
    // Each round of progress records names all groups; the last complete round says what they had reached.
    log.cut = std::numeric_limits<Flicks>::max();
    for (const auto& group : log.groups) {
        Flicks reached = 0;
        for (const TimingRecord& entry : group)
            if (entry.kind == TimingKind::progress) reached = entry.value;
            else if (entry.kind == TimingKind::end) reached = std::numeric_limits<Flicks>::max();
        log.cut = std::min(log.cut, reached);
    }
    if (log.groups.empty()) log.cut = 0;
    return log;
}

std::int64_t TimingLog::end_of(std::size_t group, Flicks period) const {
    std::int64_t end = is_whole ? std::numeric_limits<std::int64_t>::max() : ceil_div(cut, period);
    if (group >= groups.size()) return is_whole ? 0 : end;
    for (const TimingRecord& record : groups[group])
        if (record.kind == TimingKind::end) end = std::min(end, record.tick);
    return end;
}

}  // namespace tactus::take
