// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/orders.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

using namespace tactus::statistics;

namespace {

bool is_permutation_of_all(const Order& order, std::size_t count) {
    return order.size() == count && std::set<std::size_t>(order.begin(), order.end()).size() == count &&
           *std::ranges::max_element(order) == count - 1;
}

}  // namespace

TEST_CASE("rows and columns of Latin squares have each condition once") {
    for (std::size_t count = 1; count <= 12; ++count)
        for (const bool is_williams : {false, true}) {
            const std::vector<Order> rows = is_williams ? williams(count) : latin_square(count);
            CHECK(rows.size() == (is_williams && count % 2 == 1 && count > 1 ? 2 * count : count));
            for (const Order& row : rows) CHECK(is_permutation_of_all(row, count));
            for (std::size_t column = 0; column < count; ++column) {
                std::map<std::size_t, std::size_t> seen;
                for (const Order& row : rows) ++seen[row[column]];
                CHECK(seen.size() == count);
                for (const auto& [condition, times] : seen) CHECK(times == rows.size() / count);
            }
        }
}

TEST_CASE("in a Williams design each condition follows each other one equally often") {
    for (std::size_t count = 2; count <= 12; ++count) {
        std::map<std::pair<std::size_t, std::size_t>, int> follows;
        for (const Order& row : williams(count))
            for (std::size_t i = 1; i < count; ++i) ++follows[{row[i - 1], row[i]}];
        CHECK(follows.size() == count * (count - 1));
        for (const auto& [pair, times] : follows) CHECK(times == (count % 2 == 0 ? 1 : 2));
    }
}

TEST_CASE("block random orders have each condition once a block and depend on the seed") {
    const Order order = block_random(5, 40, 7);
    for (std::size_t block = 0; block < 40; ++block)
        CHECK(is_permutation_of_all(Order(order.begin() + 5 * block, order.begin() + 5 * block + 5), 5));
    CHECK(order == block_random(5, 40, 7));
    CHECK(order != block_random(5, 40, 8));
    // Each condition stands at each place about equally often: 2000 blocks, 400 ± 4 standard deviations.
    const Order many = block_random(5, 2000, 3);
    for (std::size_t place = 0; place < 5; ++place) {
        std::map<std::size_t, int> seen;
        for (std::size_t block = 0; block < 2000; ++block) ++seen[many[5 * block + place]];
        for (const auto& [condition, times] : seen) CHECK(std::abs(times - 400) < 72);
    }
}

TEST_CASE("all orders of three conditions are six and in lexical order") {
    const std::vector<Order> all = all_orders(3);
    CHECK(all.size() == 6);
    CHECK(std::ranges::is_sorted(all));
    for (const Order& order : all) CHECK(is_permutation_of_all(order, 3));
    CHECK_THROWS_AS(all_orders(7), tactus::Error);
}

TEST_CASE("sixteen subjects of the co-location study are balanced as the thesis states") {
    std::map<std::size_t, int> display, mode, task;
    std::map<bool, int> reverses;
    std::map<std::tuple<std::size_t, std::size_t, bool>, int> sequences;
    for (std::size_t subject = 0; subject < 16; ++subject) {
        const CoLocationRow row = co_location_row(subject);
        ++display[row.first_display];
        ++mode[row.first_mode];
        ++reverses[row.reverses];
        ++sequences[{row.first_display, row.first_mode, row.reverses}];
        ++task[row.task_order];
    }
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(display[i] == 8);
        CHECK(mode[i] == 8);
        CHECK(reverses[i == 1] == 8);
    }
    CHECK(sequences.size() == 8);
    for (const auto& [sequence, times] : sequences) CHECK(times == 2);
    CHECK(task.size() == 6);
    for (const auto& [order, times] : task) CHECK((times == 2 || times == 3));
}

TEST_CASE("orders of the co-location study stay balanced from 8 to 48 subjects") {
    for (std::size_t subjects = 8; subjects <= 48; ++subjects) {
        std::map<std::tuple<std::size_t, std::size_t, bool>, int> sequences;
        std::map<std::size_t, int> task;
        for (std::size_t subject = 0; subject < subjects; ++subject) {
            const CoLocationRow row = co_location_row(subject);
            ++sequences[{row.first_display, row.first_mode, row.reverses}];
            ++task[row.task_order];
        }
        CHECK(sequences.size() == 8);
        const auto by_count = [](const auto& a, const auto& b) { return a.second < b.second; };
        const auto [few, many] = std::ranges::minmax_element(sequences, by_count);
        CHECK(many->second - few->second <= 1);
        const auto [rare, often] = std::ranges::minmax_element(task, by_count);
        CHECK(often->second - rare->second <= 1);
    }
}

TEST_CASE("parity of the task order is independent of display, mode and reversal") {
    std::map<std::pair<std::size_t, std::size_t>, int> display, mode, reversal;
    for (std::size_t subject = 0; subject < 8; ++subject) {
        const CoLocationRow row = co_location_row(subject);
        ++display[{row.task_order % 2, row.first_display}];
        ++mode[{row.task_order % 2, row.first_mode}];
        ++reversal[{row.task_order % 2, row.reverses ? 1 : 0}];
    }
    for (const auto* counts : {&display, &mode, &reversal}) {
        CHECK(counts->size() == 4);
        for (const auto& [pair, times] : *counts) CHECK(times == 2);
    }
}

TEST_CASE("the periods of a row visit both displays and both modes once") {
    for (std::size_t subject = 0; subject < 8; ++subject) {
        const CoLocationRow row = co_location_row(subject);
        const auto periods = row.periods();
        CHECK(periods[0][0] == row.first_display);
        CHECK(periods[0][1] == row.first_mode);
        CHECK(periods[0][0] == periods[1][0]);
        CHECK(periods[2][0] == periods[3][0]);
        CHECK(std::set<std::array<std::size_t, 2>>(periods.begin(), periods.end()).size() == 4);
        CHECK((periods[2][1] == periods[0][1]) == !row.reverses);
    }
}
