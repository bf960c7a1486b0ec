// SPDX-License-Identifier: Apache-2.0
#include "engine/take/packed_records.hpp"

#include "engine/take/sound_record.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace tactus::take {

namespace {

// Words of a sample in the order of detail::each_word, then buttons and flags.
constexpr std::size_t scalar_word = 3, counter_word = 13, flags_word = 20;
/// The vector of the quaternion comes before its scalar, which is predicted by it.
constexpr std::array<std::size_t, RecordPrediction::words> coding_order{0,  1,  2,  4,  5,  6,  3,  7,  8,  9, 10,
                                                                        11, 12, 13, 14, 15, 16, 17, 18, 19, 20};

constexpr bool is_number(std::size_t word) {
    return word < counter_word || word == 14 || word == 15 || word == 17 || word == 18;
}

// Bits of the first byte, beside the kind.
constexpr unsigned char other_source = 0x10, other_place = 0x20, other_sample = 0x40;

/// An integer that grows with the number.
std::uint64_t ordered(std::uint64_t bits) noexcept { return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63; }
std::uint64_t unordered(std::uint64_t order) noexcept {
    return order >> 63 ? order & ~(std::uint64_t{1} << 63) : ~order;
}

std::uint64_t folded(std::uint64_t difference) noexcept {
    return difference << 1 ^ (difference >> 63 ? ~std::uint64_t{0} : 0);
}
std::uint64_t unfolded(std::uint64_t value) noexcept { return value >> 1 ^ (value & 1 ? ~std::uint64_t{0} : 0); }

/// The next number by a polynomial of that degree through the last ones.
double extrapolated(int degree, double a, double b, double c, double d) noexcept {
    switch (degree) {
        case 0: return a;
        case 1: return 2.0 * a - b;
        case 2: return 3.0 * (a - b) + c;
        default: return 4.0 * (a + c) - 6.0 * b - d;
    }
}

std::uint64_t extrapolated_bits(int degree, const std::array<RecordPrediction::Words, 4>& before,
                                std::size_t word) noexcept {
    if (degree == 0) return before[0][word];
    const auto number = [&](std::size_t i) { return std::bit_cast<double>(before[i][word]); };
    const double next = extrapolated(degree, number(0), number(1), number(2), number(3));
    // Which NaN an operation gives is not specified.
    return std::isfinite(next) ? std::bit_cast<std::uint64_t>(next) : 0;
}

void put_varint(std::uint64_t value, std::string& out) {
    for (; value >= 0x80; value >>= 7) out += static_cast<char>(value | 0x80);
    out += static_cast<char>(value);
}

/// 0: read; 1: the bytes end; 2: longer than 64 bits.
int take_varint(std::string_view& bytes, std::uint64_t& value) {
    value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
        if (bytes.empty()) return 1;
        const auto byte = static_cast<unsigned char>(bytes.front());
        bytes.remove_prefix(1);
        value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
        if (byte < 0x80) return 0;
    }
    return 2;
}

std::uint64_t difference(std::int64_t a, std::int64_t b) noexcept {
    return folded(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
std::int64_t sum(std::int64_t a, std::uint64_t difference) noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + unfolded(difference));
}

std::uint64_t word_difference(std::size_t word, std::uint64_t is, std::uint64_t expected) noexcept {
    return is_number(word) ? folded(ordered(is) - ordered(expected)) : folded(is - expected);
}
std::uint64_t word_from(std::size_t word, std::uint64_t expected, std::uint64_t difference) noexcept {
    return is_number(word) ? unordered(ordered(expected) + unfolded(difference)) : expected + unfolded(difference);
}

}  // namespace

RecordPrediction::Words RecordPrediction::words_of(const DeviceSample& sample) noexcept {
    Words all{};
    std::size_t at = 0;
    detail::each_word(sample, [&](const auto& word) { std::memcpy(&all[at++], &word, sizeof word); });
    all[flags_word] = sample.buttons | static_cast<std::uint64_t>(sample.valid) << 32 |
                      static_cast<std::uint64_t>(sample.taken) << 33 |
                      static_cast<std::uint64_t>(sample.sound_lost) << 34 |
                      static_cast<std::uint64_t>(sample.late) << 35;
    return all;
}

bool RecordPrediction::read_words(const Words& words, DeviceSample& sample) noexcept {
    std::size_t at = 0;
    detail::each_word(sample, [&](auto& word) { std::memcpy(&word, &words[at++], sizeof word); });
    const std::uint64_t flags = words[flags_word];
    sample.buttons = static_cast<std::uint32_t>(flags);
    sample.valid = flags >> 32 & 1;
    sample.taken = flags >> 33 & 1;
    sample.sound_lost = flags >> 34 & 1;
    sample.late = flags >> 35 & 1;
    return flags >> 36 == 0;
}

RecordPrediction::Words RecordPrediction::Stream::predicted(TimingKind kind) const noexcept {
    Words next = before[0];
    if (kind != TimingKind::device_sample) return next;
    for (std::size_t w = 0; w < words; ++w)
        if (is_number(w)) {
            const auto best = std::ranges::min_element(cost[w]) - cost[w].begin();
            next[w] = extrapolated_bits(static_cast<int>(best), before, w);
        }
    next[counter_word] = 2 * before[0][counter_word] - before[1][counter_word];
    return next;
}

std::uint64_t RecordPrediction::Stream::predicted_scalar(const Words& sample) const noexcept {
    const Words& last = before[0];
    if (std::equal(&sample[scalar_word + 1], &sample[scalar_word + 4], &last[scalar_word + 1]))
        return last[scalar_word];
    const auto number = [&](std::size_t i) { return std::bit_cast<double>(sample[scalar_word + i]); };
    const double square = 1.0 - number(1) * number(1) - number(2) * number(2) - number(3) * number(3);
    if (!(square > 0.0)) return last[scalar_word];
    return std::bit_cast<std::uint64_t>(std::copysign(std::sqrt(square), std::bit_cast<double>(last[scalar_word])));
}

std::int64_t RecordPrediction::Stream::next_tick() const noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(tick) +
                                     static_cast<std::uint64_t>(std::max(count, std::int32_t{1})));
}

std::int64_t RecordPrediction::Stream::next_value() const noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(value) + static_cast<std::uint64_t>(step));
}

void RecordPrediction::Stream::add(const TimingRecord& record, const Words& sample) noexcept {
    if (record.kind == TimingKind::device_sample)
        for (std::size_t w = 0; w < words; ++w) {
            if (!is_number(w)) continue;
            for (int degree = 0; degree < 4; ++degree) {
                const auto bits = static_cast<std::uint16_t>(
                    std::bit_width(word_difference(w, sample[w], extrapolated_bits(degree, before, w))));
                std::uint16_t& mean = cost[w][static_cast<std::size_t>(degree)];
                mean = static_cast<std::uint16_t>(mean - mean / 8 + 8 * bits);
            }
        }
    step = static_cast<std::int64_t>(static_cast<std::uint64_t>(record.value) - static_cast<std::uint64_t>(value));
    tick = record.tick;
    count = record.count;
    value = record.value;
    std::shift_right(before.begin(), before.end(), 1);
    before[0] = sample;
}

bool RecordPrediction::has_streams(TimingKind kind) noexcept {
    return kind == TimingKind::device_sample || kind == TimingKind::held_read || kind == TimingKind::dropped ||
           kind == TimingKind::heard;
}

void RecordPacker::pack(const TimingRecord& record, std::string& out) {
    std::uint32_t& source = known_.last_source(record.kind);
    RecordPrediction::Stream& stream = known_.stream(record.kind, record.source);
    const bool is_in_place =
        record.tick == stream.next_tick() && record.count == stream.count && record.value == stream.next_value();
    const RecordPrediction::Words sample = RecordPrediction::words_of(record.sample);
    RecordPrediction::Words expected = stream.predicted(record.kind);
    if (record.kind == TimingKind::device_sample) expected[scalar_word] = stream.predicted_scalar(sample);
    out += static_cast<char>(static_cast<unsigned char>(record.kind) | (record.source != source ? other_source : 0) |
                             (is_in_place ? 0 : other_place) | (sample != expected ? other_sample : 0));
    if (record.source != source) put_varint(record.source, out);
    source = record.source;
    if (!is_in_place) {
        put_varint(difference(record.tick, stream.next_tick()), out);
        put_varint(difference(record.count, stream.count), out);
        put_varint(difference(record.value, stream.next_value()), out);
    }
    if (sample != expected) {
        // Which words differ; of each the number of its bytes, two in a byte; then the bytes.
        std::uint64_t differs = 0;
        std::string lengths, bytes;
        int filled = 0;
        for (const std::size_t w : coding_order) {
            std::uint64_t rest = word_difference(w, sample[w], expected[w]);
            if (rest == 0) continue;
            differs |= std::uint64_t{1} << w;
            int length = 0;
            for (; rest != 0; rest >>= 8, ++length) bytes += static_cast<char>(rest);
            if (filled++ % 2 == 0) lengths += static_cast<char>(length);
            else lengths.back() = static_cast<char>(lengths.back() | length << 4);
        }
        put_varint(differs, out);
        out += lengths;
        out += bytes;
    }
    stream.add(record, sample);
}

RecordUnpacker::Result RecordUnpacker::unpack(std::string_view& bytes, TimingRecord& record) {
    if (bytes.empty()) return Result::incomplete;
    std::string_view left = bytes;
    const auto head = static_cast<unsigned char>(left.front());
    left.remove_prefix(1);
    record = {};
    record.kind = static_cast<TimingKind>(head & 0x0f);
    if (record.kind > TimingKind::overdue || head >= 0x80) return Result::damaged;
    std::uint64_t number = 0;
    std::uint32_t source = known_.last_source(record.kind);
    if (head & other_source) {
        if (const int failed = take_varint(left, number)) return failed == 1 ? Result::incomplete : Result::damaged;
        if (number > std::numeric_limits<std::uint32_t>::max()) return Result::damaged;
        source = static_cast<std::uint32_t>(number);
    }
    record.source = source;
    RecordPrediction::Stream& stream = known_.stream(record.kind, source);
    record.tick = stream.next_tick();
    record.count = stream.count;
    record.value = stream.next_value();
    if (head & other_place) {
        std::uint64_t differences[3];
        for (std::uint64_t& one : differences)
            if (const int failed = take_varint(left, one)) return failed == 1 ? Result::incomplete : Result::damaged;
        record.tick = sum(record.tick, differences[0]);
        const std::int64_t count = sum(record.count, differences[1]);
        if (count < 0 || count > std::numeric_limits<std::int32_t>::max()) return Result::damaged;
        record.count = static_cast<std::int32_t>(count);
        record.value = sum(record.value, differences[2]);
    }
    const bool is_device = record.kind == TimingKind::device_sample;
    RecordPrediction::Words sample = stream.predicted(record.kind);
    if (is_device && !(head & other_sample)) sample[scalar_word] = stream.predicted_scalar(sample);
    if (head & other_sample) {
        std::uint64_t differs = 0;
        if (const int failed = take_varint(left, differs)) return failed == 1 ? Result::incomplete : Result::damaged;
        if (differs >> RecordPrediction::words) return Result::damaged;
        const auto how_many = static_cast<std::size_t>(std::popcount(differs));
        if (left.size() < (how_many + 1) / 2) return Result::incomplete;
        const std::string_view lengths = left.substr(0, (how_many + 1) / 2);
        left.remove_prefix(lengths.size());
        std::size_t k = 0;
        for (const std::size_t w : coding_order) {
            if (w == scalar_word && is_device) sample[w] = stream.predicted_scalar(sample);
            if (!(differs >> w & 1)) continue;
            const std::size_t length = static_cast<unsigned char>(lengths[k / 2]) >> (k % 2 * 4) & 0x0f;
            ++k;
            if (length > 8) return Result::damaged;
            if (left.size() < length) return Result::incomplete;
            std::uint64_t rest = 0;
            for (std::size_t i = 0; i < length; ++i)
                rest |= static_cast<std::uint64_t>(static_cast<unsigned char>(left[i])) << (8 * i);
            left.remove_prefix(length);
            sample[w] = word_from(w, sample[w], rest);
        }
    }
    if (!RecordPrediction::read_words(sample, record.sample) || record.tick < 0 || record.count < 0)
        return Result::damaged;
    known_.last_source(record.kind) = source;
    stream.add(record, sample);
    bytes = left;
    return Result::record;
}

}  // namespace tactus::take
