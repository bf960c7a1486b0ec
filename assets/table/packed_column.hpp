// SPDX-License-Identifier: Apache-2.0
// A long column of numbers that were read from text, in a fraction of their size as double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::table {

/// Text holds decimal numbers of few digits: in blocks of 4096 they are stored as whole multiples of a power of ten, in 1, 2 or
/// 4 bytes each, or as a line if they are even (times). Numbers with more digits are stored as they are. What is read back is
/// equal to the last bit, but minus zero is zero; a general compressor would take longer than the parser.
class PackedColumn {
public:
    void push_back(double value);
    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    double operator[](std::size_t index) const;
    double front() const { return (*this)[0]; }
    double back() const { return (*this)[size_ - 1]; }
    /// Fills `values` with those from `first` on, which must exist.
    void read(std::size_t first, std::span<double> values) const;
    std::vector<double> values() const;

    /// Multiplies all values by `factor` and divides them by `divisor`, when they are read.
    void scale(double factor, double divisor = 1.0) noexcept { factor_ = factor, divisor_ = divisor; }
    /// Keeps the values [first, end).
    void cut(std::size_t first, std::size_t end) noexcept { first_ += first, size_ = end - first; }
    /// Memory of the numbers, bytes.
    std::size_t bytes() const noexcept { return bytes_ + open_.capacity() * sizeof(double); }

    friend bool operator==(const PackedColumn& a, const std::vector<double>& b) { return a.values() == b; }

private:
    static constexpr std::size_t block_size = 4096;

    struct Block {
        std::int64_t base = 0, step = 0;  // of the whole numbers
        signed char exponent = 0;  // of ten; -1: the values as they are
        signed char width = 0;  // bytes of an offset from base; 0: base + step * index
        std::vector<unsigned char> bytes;
    };

    Block pack(std::span<const double> values);
    static void unpack(const Block& block, std::size_t first, std::span<double> values);

    std::vector<Block> blocks_;
    std::vector<double> open_;  // of the last block, not yet full
    std::size_t first_ = 0, size_ = 0, bytes_ = 0;
    int exponent_ = 0;  // of the last block
    double factor_ = 1.0, divisor_ = 1.0;
};

}  // namespace tactus::table
