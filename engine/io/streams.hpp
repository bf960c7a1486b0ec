// SPDX-License-Identifier: Apache-2.0
// Streams that leave a run: values go through a ring to a file or a sound card, drained outside of the ticks.
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

/// Where the values of a stream go. Called by one thread at a time, never in a tick.
class Sink {
public:
    virtual ~Sink() = default;
    /// Values of activations first, first + 1, …; activations that never ran are missing. Throws Error when they cannot be
    /// kept; then only `finish` is called.
    virtual void take(std::int64_t first, const std::byte* values, std::size_t count) = 0;
    /// Completes the file, as far as it goes when `take` had failed; throws Error.
    virtual void finish() = 0;
    /// What the user should know, once; mostly nothing.
    virtual std::string take_message() { return {}; }
};

/// A sound file: one float channel, silence where activations are missing. Its comment states the unit of the values.
std::unique_ptr<Sink> make_sound_file_sink(const std::filesystem::path& path, const StreamFormat& format);
/// Keeps nothing.
std::unique_ptr<Sink> make_null_sink();
/// A CSV file: a line of column names with units, then time in s and the values.
std::unique_ptr<Sink> make_csv_sink(const std::filesystem::path& path, const StreamFormat& format);

class Stream : public RecordStream {
public:
    Stream(StreamFormat format, std::unique_ptr<Sink> sink);
    /// Values of `size` bytes, at most `longest` of them in one write, `bytes` of them in all until they are drained.
    struct Room {
        std::size_t size, longest, bytes;
    };
    Stream(StreamFormat format, std::unique_ptr<Sink> sink, const Room& room);

    /// Keeps activations from … until − 1 of those that are written. Before anybody writes.
    void begin_at(std::int64_t from) { from_ = from; }
    /// Any thread.
    void end_at(std::int64_t until) noexcept { until_.store(until, std::memory_order_relaxed); }
    std::int64_t until() const noexcept { return until_.load(std::memory_order_relaxed); }
    bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept override;

    /// Moves what has gathered to the sink. Any thread outside of a tick. A sink that fails is completed as far as it goes
    /// and gets nothing more.
    void drain();
    /// True when less than half of the ring is left.
    bool wants_drain() const noexcept { return ring_ && ring_->size() * 2 > ring_->capacity(); }
    /// Completes the file and gives back all memory. Nobody writes any more; again: nothing.
    void finish();
    bool is_finished() const { return !sink_; }
    /// Why the rest of this stream is not kept; empty: it is.
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
    std::vector<std::byte> packed_, drained_;  // of the writer, of the drainer
    std::mutex draining_;
    std::string loss_;  // under it
    std::int64_t from_ = 0;
    std::atomic<std::int64_t> until_{std::numeric_limits<std::int64_t>::max()};
    std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace tactus::io
