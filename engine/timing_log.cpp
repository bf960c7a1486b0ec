// SPDX-License-Identifier: Apache-2.0
#include "engine/timing_log.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <type_traits>

namespace tactus {

namespace {

constexpr char magic[8] = {'T', 'A', 'C', 'T', 'L', 'O', 'G', '1'};

struct Header {
    char magic[8];
    std::uint64_t plan_hash;
    double seconds;
    std::uint64_t groups;
};
static_assert(std::is_trivially_copyable_v<Header> && std::is_trivially_copyable_v<TimingRecord>);

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

TimingLogWriter::TimingLogWriter(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds,
                                 std::size_t groups)
    : path_(path), part_(path.string() + ".part"), file_(std::fopen(part_.c_str(), "wb")) {
    if (!file_) throw Error(fmt::format("{}: cannot write the timing log: {}", path.string(), std::strerror(errno)));
    Header header{{}, plan_hash, seconds, groups};
    std::memcpy(header.magic, magic, sizeof magic);
    std::fwrite(&header, sizeof header, 1, file_);
}

TimingLogWriter::~TimingLogWriter() {
    if (!file_) return;
    std::fclose(file_);
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void TimingLogWriter::write(const TimingRecord& record) {
    // Padding bytes would make two logs of one run differ.
    alignas(TimingRecord) unsigned char bytes[sizeof(TimingRecord)] = {};
    TimingRecord* clean = new (bytes) TimingRecord;
    *clean = record;
    if (std::fwrite(bytes, sizeof bytes, 1, file_) != 1)
        throw Error(fmt::format("{}: cannot write the timing log: {}", path_.string(), std::strerror(errno)));
}

void TimingLogWriter::finish() {
    const bool written = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!written) throw Error(fmt::format("{}: cannot write the timing log: {}", path_.string(), std::strerror(errno)));
    std::filesystem::rename(part_, path_);
}

TimingLog TimingLog::load(const std::filesystem::path& path) {
    const std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "rb"));
    const auto fail = [&path](const std::string& what) { throw Error(fmt::format("{}: {}", path.string(), what)); };
    if (!file) fail(fmt::format("cannot read the timing log: {}", std::strerror(errno)));
    Header header;
    if (std::fread(&header, sizeof header, 1, file.get()) != 1 || std::memcmp(header.magic, magic, sizeof magic) != 0)
        fail("not a timing log of this version; make one with 'tactus run PATCH --log FILE'");
    if (header.groups == 0 || header.groups > 256) fail("the header of the timing log is damaged");
    TimingLog log{header.plan_hash, header.seconds, {}};
    log.groups.resize(header.groups);
    std::size_t ended = 0;
    TimingRecord record;
    while (std::fread(&record, sizeof record, 1, file.get()) == 1) {
        if (record.group >= header.groups || record.kind > TimingKind::end || record.tick < 0 || record.count < 0)
            fail("a record of the timing log is damaged");
        log.groups[record.group].push_back(record);
        ended += record.kind == TimingKind::end;
    }
    if (ended != header.groups)
        fail("the timing log stops before the end of the run; it cannot be replayed to the bit");
    return log;
}

}  // namespace tactus
