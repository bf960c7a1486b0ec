// SPDX-License-Identifier: Apache-2.0
#include "engine/io/streams.hpp"

#include "assets/file/growing_file.hpp"
#include "assets/sound/calibration.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>

namespace tactus::io {

namespace {

constexpr std::size_t ring_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_piece = 4096;  // values of one write

class SoundFileSink : public Sink {
public:
    SoundFileSink(const std::filesystem::path& path, const StreamFormat& format)
        : writer_(path, 1, static_cast<int>(std::lround(rate_of(format.period))), sound::SoundFormat::float_wav,
                  format.unit.empty() ? std::string() : sound::calibration_comment(format.unit)) {}

    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        static constexpr float silence[1024] = {};
        for (; next_ < first; next_ += std::min<std::int64_t>(first - next_, 1024))
            writer_.write(silence, static_cast<std::size_t>(std::min<std::int64_t>(first - next_, 1024)));
        writer_.write(reinterpret_cast<const float*>(values), count);
        next_ += static_cast<std::int64_t>(count);
    }
    void finish() override { writer_.finish(); }

private:
    sound::SoundWriter writer_;
    std::int64_t next_ = 0;
};

/// "N, N m" is the unit of three columns, then that of the others. A name of a column holds no comma and no blank. A
/// quaternion has no unit.
std::string unit_of_column(const std::string& units, std::size_t column, const ValueType& type) {
    const std::size_t comma = units.find(',');
    if (&type == &value::pose && column >= 3 && comma == std::string::npos) return {};
    std::string unit = column < 3 || comma == std::string::npos ? units.substr(0, comma) : units.substr(comma + 1);
    unit.erase(0, unit.find_first_not_of(' '));
    std::ranges::replace_if(unit, [](char letter) { return letter == ' ' || letter == ','; }, '_');
    return unit;
}

class CsvSink : public Sink {
public:
    CsvSink(std::filesystem::path path, const StreamFormat& format)
        : path_(std::move(path)),
          part_(path_.string() + ".part"),
          file_(std::make_unique<file::GrowingFile>(part_, path_)),
          type_(*format.type),
          period_(format.period) {
        std::string header = "t_s";
        for (std::size_t i = 0; i < type_.columns.size(); ++i) {
            const std::string unit = unit_of_column(format.unit, i, type_);
            header += fmt::format(",{}{}{}", type_.columns[i], unit.empty() ? "" : "_", unit);
        }
        file_->append(header + "\n");
        row_.resize(type_.columns.size());
    }
    ~CsvSink() override {
        if (!file_) return;
        file_.reset();
        std::error_code ignored;
        std::filesystem::remove(part_, ignored);
    }
    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        for (std::size_t i = 0; i < count; ++i) {
            type_.to_columns(values + i * type_.size, row_.data());
            line_.clear();
            fmt::format_to(std::back_inserter(line_), "{:.6f}",
                           seconds((first + static_cast<std::int64_t>(i)) * period_));
            // The sum is 0 for a negative zero, which other programs show as "-0".
            for (const double number : row_) fmt::format_to(std::back_inserter(line_), ",{}", number + 0.0);
            line_ += '\n';
            file_->append(line_);
        }
    }
    void finish() override {
        const std::unique_ptr<file::GrowingFile> file = std::move(file_);
        std::exception_ptr full;
        try {
            file->close();
        } catch (const Error&) {
            full = std::current_exception();
        }
        std::error_code failure;
        const bool is_empty = std::filesystem::file_size(part_, failure) == 0;  // not even the names of the columns
        if (is_empty) std::filesystem::remove(part_, failure);
        else std::filesystem::rename(part_, path_, failure);
        if (full) std::rethrow_exception(full);
        if (failure)
            throw Error(
                fmt::format("{}: cannot be renamed to {}: {}", part_.string(), path_.string(), failure.message()));
    }

private:
    std::filesystem::path path_, part_;
    std::unique_ptr<file::GrowingFile> file_;
    const ValueType& type_;
    Flicks period_;
    std::vector<double> row_;
    std::string line_;
};

}  // namespace

std::unique_ptr<Sink> make_sound_file_sink(const std::filesystem::path& path, const StreamFormat& format) {
    return std::make_unique<SoundFileSink>(path, format);
}
std::unique_ptr<Sink> make_null_sink() {
    class NullSink : public Sink {
    public:
        void take(std::int64_t, const std::byte*, std::size_t) override {}
        void finish() override {}
    };
    return std::make_unique<NullSink>();
}
std::unique_ptr<Sink> both_sinks(std::unique_ptr<Sink> first, std::unique_ptr<Sink> second) {
    class BothSinks : public Sink {
    public:
        BothSinks(std::unique_ptr<Sink> first, std::unique_ptr<Sink> second)
            : first_(std::move(first)), second_(std::move(second)) {}

        void take(std::int64_t at, const std::byte* values, std::size_t count) override {
            first_->take(at, values, count);
            second_->take(at, values, count);
        }
        void finish() override {
            first_->finish();
            second_->finish();
        }
        std::string take_message() override { return first_->take_message(); }

    private:
        std::unique_ptr<Sink> first_, second_;
    };
    if (!first || !second) return first ? std::move(first) : std::move(second);
    return std::make_unique<BothSinks>(std::move(first), std::move(second));
}
std::unique_ptr<Sink> make_csv_sink(const std::filesystem::path& path, const StreamFormat& format) {
    return std::make_unique<CsvSink>(path, format);
}

Stream::Stream(StreamFormat format, std::unique_ptr<Sink> sink)
    : Stream(format, std::move(sink), {format.type->size, longest_piece, ring_bytes}) {}

Stream::Stream(StreamFormat format, std::unique_ptr<Sink> sink, const Room& room)
    : format_(std::move(format)),
      size_(room.size),
      longest_(room.longest),
      sink_(std::move(sink)),
      ring_(std::make_unique<Ring<std::byte>>(room.bytes)),
      packed_(sizeof(Piece) + longest_ * size_),
      drained_(longest_ * size_) {}

bool Stream::write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept {
    const std::size_t size = size_;
    const std::int64_t begin = std::max(first, from_),
                       end = std::min(first + static_cast<std::int64_t>(count), until());
    // Past its end it may have been completed already.
    if (begin >= end) return true;
    values = static_cast<const std::byte*>(values) + static_cast<std::ptrdiff_t>(begin - first) * stride;
    count = static_cast<std::size_t>(end - begin);
    const Piece piece{begin, count};
    const std::size_t bytes = sizeof piece + count * size;
    if (count > longest_ || ring_->space() < bytes) {
        dropped_.fetch_add(count, std::memory_order_relaxed);
        return false;
    }
    std::memcpy(packed_.data(), &piece, sizeof piece);
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(packed_.data() + sizeof piece + i * size,
                    static_cast<const std::byte*>(values) + static_cast<std::ptrdiff_t>(i) * stride, size);
    return ring_->push(packed_.data(), bytes) == bytes;
}

void Stream::drain() {
    const std::lock_guard lock(draining_);
    if (!ring_) return;
    Piece piece;
    // A piece is pushed whole, so once its head is there the rest is too.
    while (ring_->pop(reinterpret_cast<std::byte*>(&piece), sizeof piece) == sizeof piece) {
        ring_->pop(drained_.data(), piece.count * size_);
        if (!loss_.empty()) continue;
        try {
            sink_->take(piece.first, drained_.data(), piece.count);
        } catch (const Error& error) {
            lose(error);
        }
    }
}

/// Keeps what there is; the run goes on without this stream.
void Stream::lose(const Error& error) {
    loss_ = error.message();
    try {
        sink_->finish();
    } catch (const Error& another) {
        if (another.message() != loss_) loss_ += fmt::format("; {}", another.message());
    }
}

std::string Stream::loss() {
    const std::lock_guard lock(draining_);
    return loss_;
}

void Stream::finish() {
    drain();
    const std::lock_guard lock(draining_);
    if (!sink_) return;
    if (loss_.empty()) {
        try {
            sink_->finish();
        } catch (const Error& error) {
            loss_ = error.message();
        }
    }
    sink_.reset();
    ring_.reset();
    packed_ = std::vector<std::byte>();
    drained_ = std::vector<std::byte>();
}

}  // namespace tactus::io
