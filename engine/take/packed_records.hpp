// SPDX-License-Identifier: Apache-2.0
// The packed records of one group of a timing log: each record is stored as its difference from a prediction. A device
// at rest takes 2 bytes per sample, a moving one about 60 instead of 208.
#pragma once

#include "engine/take/timing_record.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace tactus::take {

/// The predictor, whose state is equal in the writer and the reader. A number of a sample is predicted from the last
/// four by the polynomial of degree 0 to 3 with the lowest recent cost, the scalar of a quaternion by its vector, an
/// integer by its last value, a counter by its last step. The coding is lossless, and a smooth motion leaves few bits
/// that are not predicted.
class RecordPrediction {
public:
    static constexpr std::size_t words = 21;  ///< of a sample
    using Words = std::array<std::uint64_t, words>;

    static Words words_of(const DeviceSample& sample) noexcept;
    /// Returns false if the words are not a valid sample: a flag is neither 0 nor 1.
    static bool read_words(const Words& words, DeviceSample& sample) noexcept;

    /// State for one kind of record from one source.
    struct Stream {
        std::int64_t tick = 0, value = 0, step = 0;
        std::int32_t count = 0;
        std::array<Words, 4> before{};  ///< newest first
        std::array<std::array<std::uint16_t, 4>, words> cost{};  ///< of each degree, bits; running mean

        Words predicted(TimingKind kind) const noexcept;
        /// Predicts the scalar of the unit quaternion whose vector part is in `sample`.
        std::uint64_t predicted_scalar(const Words& sample) const noexcept;
        std::int64_t next_tick() const noexcept;
        std::int64_t next_value() const noexcept;
        void add(const TimingRecord& record, const Words& sample) noexcept;
    };
    Stream& stream(TimingKind kind, std::uint32_t source) { return streams_[{kind, has_streams(kind) ? source : 0u}]; }
    std::uint32_t& last_source(TimingKind kind) { return sources_[static_cast<std::size_t>(kind)]; }

private:
    static bool has_streams(TimingKind kind) noexcept;

    std::map<std::pair<TimingKind, std::uint32_t>, Stream> streams_;
    std::array<std::uint32_t, 16> sources_{};
};

class RecordPacker {
public:
    void pack(const TimingRecord& record, std::string& out);

private:
    RecordPrediction known_;
};

class RecordUnpacker {
public:
    enum class Result : std::uint8_t {
        record,
        incomplete,  ///< the bytes end within a record
        damaged,
    };
    /// Removes one record from the front of `bytes`.
    Result unpack(std::string_view& bytes, TimingRecord& record);

private:
    RecordPrediction known_;
};

}  // namespace tactus::take
