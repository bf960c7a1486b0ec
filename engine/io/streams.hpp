// SPDX-License-Identifier: Apache-2.0
// Streams that leave a run: values pass through a ring to a file or a sound card, and are drained outside of the ticks.
#pragma once

#include "dsp/core/error.hpp"
#include "dsp/core/ring.hpp"
#include "graph/node/setup.hpp"
#include "graph/node/value.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tactus::io {

/// Destination of the values of a stream. Called by one thread at a time, never in a tick.
class Sink {
public:
    virtual ~Sink() = default;
    /// Adds values of the activations first, first + 1, …; activations that never ran are missing. Throws Error if they
    /// cannot be stored; then only `finish` is called.
    virtual void take(std::int64_t first, const std::byte* values, std::size_t count) = 0;
    /// Completes the file, or its valid part if `take` has failed. Throws Error.
    virtual void finish() = 0;
    /// Returns a message for the user, once; usually empty.
    virtual std::string take_message() { return {}; }
};

/// A sound file with one float channel, silent where activations are missing. Its comment states the unit of the
/// values.
std::unique_ptr<Sink> make_sound_file_sink(const std::filesystem::path& path, const StreamFormat& format);
/// Discards all values.
std::unique_ptr<Sink> make_null_sink();
/// Passes values to `first`, then to `second`, with the messages of `first`; either may be null.
std::unique_ptr<Sink> both_sinks(std::unique_ptr<Sink> first, std::unique_ptr<Sink> second);
/// A CSV file: a header with column names and units, then lines of time in s and values.
std::unique_ptr<Sink> make_csv_sink(const std::filesystem::path& path, const StreamFormat& format);

class Stream : public RecordStream {
public:
    Stream(StreamFormat format, std::unique_ptr<Sink> sink);
    /// Size of the buffer: `size` bytes per value, at most `longest` values per write, `bytes` in total until they are
    /// drained.
    struct Room {
        std::size_t size, longest, bytes;
    };
    Stream(StreamFormat format, std::unique_ptr<Sink> sink, const Room& room);

    /// Drops values before activation `from`. Call before the first write.
    void begin_at(std::int64_t from) { from_ = from; }
    /// Drops values from activation `until` on. Any thread.
    void end_at(std::int64_t until) noexcept { until_.store(until, std::memory_order_relaxed); }
    std::int64_t until() const noexcept { return until_.load(std::memory_order_relaxed); }
    bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept override;

    /// Moves the buffered values to the sink. Any thread outside of a tick. A sink that fails is completed and receives
    /// no further values.
    void drain();
    /// True if less than half of the ring is free.
    bool wants_drain() const noexcept { return ring_ && ring_->size() * 2 > ring_->capacity(); }
    /// Completes the file and frees all memory. No thread may write any more. A second call does nothing.
    void finish();
    bool is_finished() const { return !sink_; }
    /// Returns the reason why the rest of this stream is missing; empty if it is complete.
    std::string loss();
    std::string take_message() const { return sink_ ? sink_->take_message() : std::string(); }

    const StreamFormat& format() const { return format_; }
    std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    // A piece: the index of its first activation, its count, then the values, all as bytes.
    struct Piece {
        std::int64_t first;
        std::uint64_t count;
    };

    void lose(const Error& error);

    StreamFormat format_;
    std::size_t size_, longest_;
    std::unique_ptr<Sink> sink_;
    std::unique_ptr<Ring<std::byte>> ring_;
    std::vector<std::byte> packed_, drained_;  // used by the writer, by the drainer
    std::mutex draining_;
    std::string loss_;  // under it
    std::int64_t from_ = 0;
    std::atomic<std::int64_t> until_{std::numeric_limits<std::int64_t>::max()};
    std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace tactus::io
