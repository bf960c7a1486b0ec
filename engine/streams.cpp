// SPDX-License-Identifier: Apache-2.0
#include "engine/streams.hpp"

#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace tactus {

namespace {

constexpr std::size_t ring_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_piece = 4096;  // values of one write

class SoundEnd : public StreamEnd {
public:
    SoundEnd(const std::filesystem::path& path, const StreamFormat& format)
        : writer_(path, 1, static_cast<int>(std::lround(rate_of(format.period)))) {}

    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        static constexpr float silence[1024] = {};
        for (; next_ < first; next_ += std::min<std::int64_t>(first - next_, 1024))
            writer_.write(silence, static_cast<std::size_t>(std::min<std::int64_t>(first - next_, 1024)));
        writer_.write(reinterpret_cast<const float*>(values), count);
        next_ += static_cast<std::int64_t>(count);
    }
    void finish() override { writer_.finish(); }

private:
    SoundWriter writer_;
    std::int64_t next_ = 0;
};

class CsvEnd : public StreamEnd {
public:
    CsvEnd(std::filesystem::path path, const StreamFormat& format)
        : path_(std::move(path)),
          part_(path_.string() + ".part"),
          file_(std::fopen(part_.c_str(), "w")),
          type_(*format.type),
          period_(format.period) {
        if (!file_) fail();
        std::string header = "t_s";
        for (const std::string_view column : type_.columns)
            header += fmt::format(",{}{}{}", column, format.unit.empty() ? "" : "_", format.unit);
        put(header + "\n");
    }
    ~CsvEnd() override {
        if (!file_) return;
        std::fclose(file_);
        std::error_code ignored;
        std::filesystem::remove(part_, ignored);
    }
    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        std::string lines;
        std::vector<double> row(type_.columns.size());
        for (std::size_t i = 0; i < count; ++i) {
            type_.to_columns(values + i * type_.size, row.data());
            fmt::format_to(std::back_inserter(lines), "{:.6f}",
                           seconds((first + static_cast<std::int64_t>(i)) * period_));
            for (const double number : row) fmt::format_to(std::back_inserter(lines), ",{}", number);
            lines += '\n';
        }
        put(lines);
    }
    void finish() override {
        const bool written = std::fclose(file_) == 0;
        file_ = nullptr;
        if (!written) fail();
        std::filesystem::rename(part_, path_);
    }

private:
    void put(const std::string& text) {
        if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
    }
    [[noreturn]] void fail() const {
        throw Error(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
    }

    std::filesystem::path path_, part_;
    std::FILE* file_;
    const ValueType& type_;
    Flicks period_;
};

}  // namespace

std::unique_ptr<StreamEnd> make_sound_end(const std::filesystem::path& path, const StreamFormat& format) {
    return std::make_unique<SoundEnd>(path, format);
}
std::unique_ptr<StreamEnd> make_csv_end(const std::filesystem::path& path, const StreamFormat& format) {
    return std::make_unique<CsvEnd>(path, format);
}

Stream::Stream(StreamFormat format, std::unique_ptr<StreamEnd> end)
    : format_(std::move(format)),
      end_(std::move(end)),
      ring_(std::make_unique<Ring<std::byte>>(ring_bytes)),
      packed_(sizeof(Piece) + longest_piece * format_.type->size),
      drained_(longest_piece * format_.type->size) {}

bool Stream::write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept {
    const std::size_t size = format_.type->size;
    const std::int64_t begin = std::max(first, from_),
                       end = std::min(first + static_cast<std::int64_t>(count), until());
    // Past its end it may have been completed already.
    if (begin >= end) return true;
    values = static_cast<const std::byte*>(values) + static_cast<std::ptrdiff_t>(begin - first) * stride;
    count = static_cast<std::size_t>(end - begin);
    const Piece piece{begin, count};
    const std::size_t bytes = sizeof piece + count * size;
    if (count > longest_piece || ring_->space() < bytes) {
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
        ring_->pop(drained_.data(), piece.count * format_.type->size);
        end_->take(piece.first, drained_.data(), piece.count);
    }
}

void Stream::finish() {
    drain();
    const std::lock_guard lock(draining_);
    if (!end_) return;
    end_->finish();
    end_.reset();
    ring_.reset();
    packed_ = std::vector<std::byte>();
    drained_ = std::vector<std::byte>();
}

}  // namespace tactus
