// SPDX-License-Identifier: Apache-2.0
// Orders of conditions. An order is a list of condition indices, 0 to count − 1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::statistics {

using Order = std::vector<std::size_t>;

/// Cyclic Latin square: `count` rows, each condition once in each row and each column. Neighbours are not balanced: in it
/// condition i always follows i − 1.
std::vector<Order> latin_square(std::size_t count);

/// Williams design (1949): a Latin square in which each condition follows each other one equally often: `count` rows for
/// even counts, 2 `count` for odd ones.
std::vector<Order> williams(std::size_t count);

/// All count! orders, in lexical order. count ≤ 6.
std::vector<Order> all_orders(std::size_t count);

/// `blocks` shuffles of all conditions one after another: each condition once in each block (Fisher and Yates). Same seed,
/// same order.
Order block_random(std::size_t count, std::size_t blocks, std::uint64_t seed);

/// What a subject of the co-location study does (Olsson 2015, 6.4.1): the display that begins, the mode that begins on it,
/// whether the second display repeats the order of the modes, and an order of the three tasks.
struct CoLocationRow {
    std::size_t first_display = 0, first_mode = 0;
    bool reverses = false;
    std::size_t task_order = 0;  ///< index into all_orders(3)

    /// Display and mode of the four periods.
    std::array<std::array<std::size_t, 2>, 4> periods() const;
};
/// Row of subject `index`, from 0. Each eight subjects have all eight sequences; the thesis does not state task orders:
/// these rotate (assumed), so that each of the six occurs equally often up to one. Every two displays, modes and ways to
/// continue meet each task order of even and of odd index equally often in 8 subjects.
CoLocationRow co_location_row(std::size_t index);

}  // namespace tactus::statistics
