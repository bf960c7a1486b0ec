// SPDX-License-Identifier: Apache-2.0
#include "engine/take/timing_log.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "engine/take/sound_record.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <type_traits>

namespace tactus::take {

namespace {

constexpr char magic[8] = {'T', 'A', 'C', 'T', 'L', 'O', 'G', '6'};
constexpr std::size_t chunk_bytes = 1 << 14;  // from here on a chunk is written
constexpr std::uint32_t longest_chunk = 1 << 16;

struct Header {
    char magic[8];
    std::uint64_t plan_hash;
    double seconds;
};
static_assert(std::is_trivially_copyable_v<Header>);

struct ChunkHeader {
    std::uint32_t length = 0;
    std::uint16_t group = 0;
    std::uint16_t unused = 0;
};
static_assert(sizeof(ChunkHeader) == 8);

/// How many bytes there were.
std::size_t read_at(int file, std::uint64_t offset, char* to, std::size_t size) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t got = ::pread(file, to + done, size - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

bool is_sound(const TimingRecord& record) {
    return record.kind != TimingKind::heard ||
           (record.value >= 1 && record.value <= std::min(record.count, sound_record_samples));
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
    Packed& packed = groups_[record.group];
    packed.packer.pack(record, packed.chunk);
    ++records_;
    if (packed.chunk.size() >= chunk_bytes) write_chunk(record.group, packed);
}

void TimingLogWriter::write_chunk(std::uint16_t group, Packed& packed) {
    if (packed.chunk.empty()) return;
    const ChunkHeader header{static_cast<std::uint32_t>(packed.chunk.size()), group, 0};
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    bytes += packed.chunk;
    packed.chunk.clear();
    bytes_ += bytes.size();
    file_->append(bytes);
}

void TimingLogWriter::flush() {
    for (auto& [group, packed] : groups_) write_chunk(group, packed);
    file_->flush();
}

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
        flush();
        write(last);
        flush();
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
    const auto fail = [&path](const std::string& what) { throw Error(fmt::format("{}: {}", path.string(), what)); };
    const int opened = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (opened < 0) fail(fmt::format("cannot read the timing log: {}", std::strerror(errno)));
    TimingLog log;
    log.file = std::shared_ptr<const int>(new int(opened), [](const int* file) {
        ::close(*file);
        delete file;
    });
    Header header;
    if (read_at(opened, 0, reinterpret_cast<char*>(&header), sizeof header) != sizeof header ||
        std::memcmp(header.magic, magic, sizeof magic) != 0)
        fail("not a timing log of this version; make one with 'tactus run PATCH --log FILE'");
    log.is_whole = false;
    log.plan_hash = header.plan_hash;
    log.seconds = header.seconds;
    std::vector<Flicks> reached;  // by each group
    std::vector<RecordUnpacker> unpackers;
    std::string bytes;
    std::uint64_t at = sizeof header;
    for (ChunkHeader chunk; !log.written; at += sizeof chunk + chunk.length) {
        if (read_at(opened, at, reinterpret_cast<char*>(&chunk), sizeof chunk) != sizeof chunk) break;
        if (chunk.length == 0 || chunk.length > longest_chunk || chunk.unused != 0)
            fail("a chunk of the timing log is damaged");
        bytes.resize(chunk.length);
        bytes.resize(read_at(opened, at + sizeof chunk, bytes.data(), chunk.length));
        if (log.groups.size() <= chunk.group) {
            log.groups.resize(chunk.group + std::size_t{1});
            unpackers.resize(log.groups.size());
            reached.resize(log.groups.size(), 0);
        }
        Group& group = log.groups[chunk.group];
        group.chunks.push_back({at + sizeof chunk, static_cast<std::uint32_t>(bytes.size())});
        TimingRecord record;
        for (std::string_view left = bytes; !left.empty();) {
            const auto result = unpackers[chunk.group].unpack(left, record);
            // A run that was cut off ends anywhere; what is complete counts.
            if (result == RecordUnpacker::Result::incomplete && bytes.size() < chunk.length) break;
            if (result != RecordUnpacker::Result::record || !is_sound(record))
                fail("a record of the timing log is damaged");
            ++log.records;
            if (record.kind == TimingKind::whole) {
                log.written = record.value;
                log.is_whole = record.value == log.records;
                break;
            }
            ++group.records;
            Flicks& so_far = reached[chunk.group];
            if (record.kind == TimingKind::progress) so_far = record.value;
            if (record.kind != TimingKind::end) continue;
            so_far = std::numeric_limits<Flicks>::max();
            group.end = std::min(group.end.value_or(record.tick), record.tick);
        }
    }
    if (log.is_whole) return log;
    if (!may_be_cut && log.written)
        fail(fmt::format("the timing log holds {} records, but {} were written; it cannot be replayed to the bit",
                         log.records, *log.written));
    if (!may_be_cut) fail("the timing log stops before the end of the run; it cannot be replayed to the bit");
    // Each round of progress records names all groups; the last complete round is their final progress.
    log.cut = reached.empty() ? 0 : *std::ranges::min_element(reached);
    return log;
}

std::int64_t TimingLog::end_of(std::size_t group, Flicks period) const {
    const std::int64_t end = is_whole ? std::numeric_limits<std::int64_t>::max() : ceil_div(cut, period);
    if (group >= groups.size()) return is_whole ? 0 : end;
    return std::min(end, groups[group].end.value_or(end));
}

GroupRecords::GroupRecords(const TimingLog& log, std::size_t group) {
    if (group >= log.groups.size()) return;
    file_ = log.file;
    chunks_ = log.groups[group].chunks;
    left_ = log.groups[group].records;
}

bool GroupRecords::read_chunk() {
    if (left_ == 0 || next_chunk_ == chunks_.size()) return false;
    const TimingLog::Chunk& chunk = chunks_[next_chunk_++];
    std::string bytes(chunk.length, '\0');
    bytes.resize(read_at(*file_, chunk.offset, bytes.data(), bytes.size()));
    TimingRecord record;
    // `load` has read these bytes: what cannot be read now ends the log here.
    for (std::string_view unread = bytes; left_ > 0 && !unread.empty(); --left_) {
        if (unpacker_.unpack(unread, record) != RecordUnpacker::Result::record) return false;
        window_.push_back(record);
    }
    return true;
}

const TimingRecord* GroupRecords::at(std::size_t i) noexcept {
    while (i >= first_ + window_.size())
        if (!read_chunk()) return nullptr;
    return &window_[i - first_];
}

void GroupRecords::read_ahead(std::int64_t tick) noexcept {
    while (window_.empty() || window_.back().tick < tick)
        if (!read_chunk()) return;
}

void GroupRecords::forget_before(std::size_t i) noexcept {
    for (; first_ < i && !window_.empty(); ++first_) window_.pop_front();
}

}  // namespace tactus::take
