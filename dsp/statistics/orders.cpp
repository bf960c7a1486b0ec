// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/orders.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tactus::statistics {

std::vector<Order> latin_square(std::size_t count) {
    std::vector<Order> rows(count, Order(count));
    for (std::size_t row = 0; row < count; ++row)
        for (std::size_t column = 0; column < count; ++column) rows[row][column] = (row + column) % count;
    return rows;
}

std::vector<Order> williams(std::size_t count) {
    // The first row zigzags (0, 1, n−1, 2, n−2, …): its neighbours differ by each number once, up to the sign for odd n,
    // which the mirrored rows supply.
    Order first;
    for (std::size_t low = 0, high = count; first.size() < count;) {
        first.push_back(low++);
        if (first.size() < count) first.push_back(--high);
    }
    std::vector<Order> rows;
    for (std::size_t row = 0; row < count; ++row) {
        Order shifted;
        for (const std::size_t condition : first) shifted.push_back((condition + row) % count);
        rows.push_back(std::move(shifted));
    }
    if (count % 2 == 1 && count > 1)
        for (std::size_t row = 0; row < count; ++row) rows.emplace_back(rows[row].rbegin(), rows[row].rend());
    return rows;
}

std::vector<Order> all_orders(std::size_t count) {
    if (count > 6) throw Error("all orders are listed for at most 6 conditions");
    Order order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<Order> all;
    do all.push_back(order);
    while (std::ranges::next_permutation(order).found);
    return all;
}

Order block_random(std::size_t count, std::size_t blocks, std::uint64_t seed) {
    const Random random{seed};
    Order order;
    std::uint64_t index = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::size_t begin = order.size();
        for (std::size_t condition = 0; condition < count; ++condition) order.push_back(condition);
        for (std::size_t left = count; left > 1; --left) {
            const auto other = static_cast<std::size_t>(random.uniform(index++) * static_cast<double>(left));
            std::swap(order[begin + left - 1], order[begin + other]);
        }
    }
    return order;
}

std::array<std::array<std::size_t, 2>, 4> CoLocationRow::periods() const {
    const std::size_t second_first = reverses ? 1 - first_mode : first_mode;
    return {{{first_display, first_mode},
             {first_display, 1 - first_mode},
             {1 - first_display, second_first},
             {1 - first_display, 1 - second_first}}};
}

CoLocationRow co_location_row(std::size_t index) {
    // The task order alternates between even and odd indices. In this arrangement of the eight sequences those at even
    // places have each bit set as often as those at odd places.
    constexpr std::array<unsigned, 8> sequences{0, 1, 7, 6, 3, 2, 4, 5};
    const unsigned sequence = sequences[index % 8];
    return {sequence & 1U, sequence >> 1 & 1U, (sequence >> 2 & 1U) != 0, index % 6};
}

}  // namespace tactus::statistics
