// SPDX-License-Identifier: Apache-2.0
#include "assets/table/packed_column.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace tactus::table {

namespace {

// Exact as double; the quotient of two exact numbers is rounded once, as a parser rounds the decimal number.
constexpr std::array<double, 16> powers{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                        1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
constexpr double max_whole = 9007199254740992.0;  // 2^53

/// The values as whole multiples of 10^-exponent; false if one of them is none.
bool scale_to_whole(std::span<const double> values, int exponent, std::span<std::int64_t> whole) {
    const double power = powers[static_cast<std::size_t>(exponent)];
    bool fits = true;
    for (std::size_t n = 0; n < values.size(); ++n) {
        const double scaled = std::nearbyint(values[n] * power);
        // Also false for NaN.
        fits = fits && std::abs(scaled) < max_whole &&
               std::bit_cast<std::uint64_t>(scaled / power) == std::bit_cast<std::uint64_t>(values[n]);
        whole[n] = fits ? static_cast<std::int64_t>(scaled) : 0;
    }
    return fits;
}

template <class T>
void put(std::span<const std::int64_t> whole, std::int64_t base, std::vector<unsigned char>& bytes) {
    bytes.resize(whole.size() * sizeof(T));
    for (std::size_t n = 0; n < whole.size(); ++n) {
        const auto offset = static_cast<T>(whole[n] - base);
        std::memcpy(bytes.data() + n * sizeof(T), &offset, sizeof(T));
    }
}

template <class T>
void take(const std::vector<unsigned char>& bytes, std::size_t first, std::int64_t base, double power,
          std::span<double> values) {
    for (std::size_t n = 0; n < values.size(); ++n) {
        T offset;
        std::memcpy(&offset, bytes.data() + (first + n) * sizeof(T), sizeof(T));
        values[n] = static_cast<double>(base + static_cast<std::int64_t>(offset)) / power;
    }
}

}  // namespace

PackedColumn::Block PackedColumn::pack(std::span<const double> values) {
    std::array<std::int64_t, block_size> space;
    const std::span<std::int64_t> whole = std::span(space).first(values.size());
    std::optional<int> exponent;
    if (scale_to_whole(values, exponent_, whole)) exponent = exponent_;
    // Most values do not pass a single test, so that the search stops at the first of them.
    for (int e = 0; e < static_cast<int>(powers.size()) && !exponent; ++e)
        if (scale_to_whole(values.first(1), e, whole) && scale_to_whole(values, e, whole)) exponent = e;
    Block block;
    if (!exponent) {
        block.exponent = -1;
        block.bytes.resize(values.size_bytes());
        std::memcpy(block.bytes.data(), values.data(), values.size_bytes());
        return block;
    }
    exponent_ = *exponent;
    block.exponent = static_cast<signed char>(*exponent);
    const auto [low, high] = std::ranges::minmax(whole);
    const std::int64_t step = whole.size() > 1 ? whole[1] - whole[0] : 0;
    bool is_even = true;
    for (std::size_t n = 1; n < whole.size() && is_even; ++n) is_even = whole[n] - whole[n - 1] == step;
    block.base = is_even ? whole[0] : low;
    if (is_even) {
        block.step = step;
        return block;
    }
    const auto range = static_cast<std::uint64_t>(high - low);
    block.width = range < 0x100 ? 1 : range < 0x10000 ? 2 : range < 0x100000000 ? 4 : 8;
    if (block.width == 1) put<std::uint8_t>(whole, low, block.bytes);
    else if (block.width == 2) put<std::uint16_t>(whole, low, block.bytes);
    else if (block.width == 4) put<std::uint32_t>(whole, low, block.bytes);
    else put<std::uint64_t>(whole, low, block.bytes);
    return block;
}

void PackedColumn::unpack(const Block& block, std::size_t first, std::span<double> values) {
    if (block.exponent < 0) {
        std::memcpy(values.data(), block.bytes.data() + first * sizeof(double), values.size_bytes());
        return;
    }
    const double power = powers[static_cast<std::size_t>(block.exponent)];
    switch (block.width) {
        case 1: return take<std::uint8_t>(block.bytes, first, block.base, power, values);
        case 2: return take<std::uint16_t>(block.bytes, first, block.base, power, values);
        case 4: return take<std::uint32_t>(block.bytes, first, block.base, power, values);
        case 8: return take<std::uint64_t>(block.bytes, first, block.base, power, values);
        default:
            for (std::size_t n = 0; n < values.size(); ++n)
                values[n] = static_cast<double>(block.base + block.step * static_cast<std::int64_t>(first + n)) / power;
    }
}

void PackedColumn::push_back(double value) {
    // Minus zero, as "-0.00" is read, has no whole number.
    open_.push_back(value + 0.0);
    ++size_;
    if (open_.size() < block_size) return;
    blocks_.push_back(pack(open_));
    bytes_ += sizeof(Block) + blocks_.back().bytes.size();
    open_.clear();
}

double PackedColumn::operator[](std::size_t index) const {
    double value = 0.0;
    read(index, {&value, 1});
    return value;
}

void PackedColumn::read(std::size_t first, std::span<double> values) const {
    std::size_t at = first_ + first;
    for (std::span<double> rest = values; !rest.empty();) {
        const std::size_t block = at / block_size, in_block = at % block_size;
        const std::span<double> part = rest.first(std::min(rest.size(), block_size - in_block));
        if (block < blocks_.size()) unpack(blocks_[block], in_block, part);
        else std::copy_n(open_.begin() + static_cast<std::ptrdiff_t>(in_block), part.size(), part.begin());
        at += part.size();
        rest = rest.subspan(part.size());
    }
    if (factor_ != 1.0)
        for (double& value : values) value *= factor_;
    if (divisor_ != 1.0)
        for (double& value : values) value /= divisor_;
}

std::vector<double> PackedColumn::values() const {
    std::vector<double> all(size_);
    read(0, all);
    return all;
}

}  // namespace tactus::table
