// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/arrangement/step_tree.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cstring>
#include <vector>

using namespace tactus;

namespace {

constexpr int fragments = 5;

bool same(const fit::Arrangement& a, const fit::Arrangement& b) {
    for (int n = 0; n < fragments; ++n) {
        if (std::memcmp(&a.pose(n), &b.pose(n), sizeof(Pose)) != 0) return false;
        if (a.is_locked(n) != b.is_locked(n) || a.is_hidden(n) != b.is_hidden(n) || a.fitted_to(n) != b.fitted_to(n))
            return false;
        for (int m = 0; m < fragments; ++m)
            if (a.move_together(n, m) != b.move_together(n, m)) return false;
    }
    return true;
}

/// Something that a hand may do.
void change(fit::Arrangement& a, std::uint64_t n) {
    const Random random{n};
    const int one = static_cast<int>(random.uniform(1) * fragments),
              other = static_cast<int>(random.uniform(2) * fragments);
    const int both[] = {one, other};
    switch (n % 6) {
        case 0: a.join(both); break;
        case 1: a.remove(one); break;
        case 2: a.lock(one, !a.is_locked(one)); break;
        case 3: a.hide(one, !a.is_hidden(one)); break;
        default: {
            const double zero = n % 4 == 0 ? -0.0 : 0.0;
            a.move(one, {Vec3(random.normal(3), zero, random.normal(4)), {1.0, 0.0, 0.0, 0.0}});
            a.fit(one, other);
        }
    }
}

}  // namespace

TEST_CASE("a tree of steps takes an arrangement back and on to the bit, along any number of steps") {
    fit::StepTree tree(fragments, 0, 4000);
    fit::Arrangement now(fragments);
    std::vector<fit::Arrangement> way{now};
    for (std::uint64_t n = 0; n < 3000; ++n) {
        const fit::Arrangement before = now;
        change(now, n);
        tree.add(before, now);
        way.push_back(now);
    }
    REQUIRE(tree.count() == 3000);
    for (std::size_t n = way.size() - 1; n-- > 0;) {
        REQUIRE(tree.undo(now));
        REQUIRE(same(now, way[n]));
        REQUIRE(tree.done() == static_cast<int>(n));
    }
    CHECK_FALSE(tree.undo(now));
    for (std::size_t n = 1; n < way.size(); ++n) {
        REQUIRE(tree.redo(now));
        REQUIRE(same(now, way[n]));
    }
    CHECK_FALSE(tree.redo(now));
    // A new step leaves what could be redone aside.
    for (int n = 0; n < 10; ++n) tree.undo(now);
    const fit::Arrangement before = now;
    change(now, 4);
    tree.add(before, now);
    CHECK(tree.head() == 3000);
    CHECK(tree.done() == 2991);
    CHECK_FALSE(tree.redo(now));
    REQUIRE(tree.undo(now));
    CHECK(same(now, before));
    CHECK(tree.head() == 2989);
}

TEST_CASE("a tree that is full forgets the way back, not the count, and takes no memory") {
    fit::StepTree tree(fragments, 0, 20);
    fit::Arrangement now(fragments);
    for (int n = 0; n < 1000; ++n) {
        const fit::Arrangement before = now;
        now.place(n % fragments, {Vec3(n, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}});
        const int head = tree.head();
        CHECK(head == n - 1);
        tree.add(before, now);
        CHECK(tree.done() == n + 1);
    }
    int undone = 0;
    while (tree.undo(now)) ++undone;
    CHECK(undone >= 1);
    CHECK(undone <= 20);
    CHECK(tree.done() == 1000 - undone);
    CHECK(tree.head() == 999 - undone);
}

TEST_CASE("steps that are known from before are undone like others, on whichever branch they stand") {
    std::array<fit::Arrangement, 4> at{fit::Arrangement(fragments), fit::Arrangement(fragments),
                                       fit::Arrangement(fragments), fit::Arrangement(fragments)};
    for (int n = 1; n < 4; ++n)
        for (int m = n; m < 4; ++m) at[static_cast<std::size_t>(m)].place(n, {Vec3(n), {1.0, 0.0, 0.0, 0.0}});
    fit::StepTree tree(fragments, 3, 10);
    // 0 - 1 and 0 - 2, told out of order.
    tree.put(0, -1, at[0], at[1]);
    tree.put(2, 0, at[1], at[3]);
    tree.put(1, 0, at[1], at[2]);
    tree.stand({1, 1});
    CHECK(tree.done() == 2);
    fit::Arrangement now = at[2];
    REQUIRE(tree.undo(now));
    CHECK(same(now, at[1]));
    REQUIRE(tree.redo(now));
    CHECK(same(now, at[2]));
    tree.add(at[2], at[3]);
    CHECK(tree.head() == 3);
    CHECK(tree.done() == 3);
}

TEST_CASE("a tree goes to any place of any branch to the bit, and no further than what it stores") {
    fit::StepTree tree(fragments, 0, 500);
    fit::Arrangement now(fragments);
    std::vector<fit::Arrangement> at;
    std::vector<fit::HistoryPlace> places;
    for (std::uint64_t n = 0; n < 400; ++n) {
        // A third of the steps begins a branch.
        if (n % 3 == 2)
            for (std::uint64_t back = 0; back < n % 7; ++back) tree.undo(now);
        const fit::Arrangement before = now;
        change(now, n);
        tree.add(before, now);
        at.push_back(now);
        places.push_back(tree.place());
    }
    for (std::uint64_t n = 0; n < 1000; ++n) {
        const auto to = static_cast<std::size_t>(Random{n}.uniform(1) * 400.0);
        REQUIRE(tree.go(places[to], now));
        CHECK(same(now, at[to]));
        CHECK(tree.head() == static_cast<int>(to));
        CHECK(tree.place().tip == places[to].tip);
    }
    // To the root, and half way to a tip; what is not a step stays away.
    REQUIRE(tree.go({-1, 399}, now));
    CHECK(same(now, fit::Arrangement(fragments)));
    CHECK(tree.done() == 0);
    CHECK_FALSE(tree.go({400, 400}, now));
    CHECK_FALSE(tree.go({-2, -2}, now));
    CHECK_FALSE(tree.go({399, 0}, now));
    CHECK(tree.head() == -1);
    REQUIRE(tree.redo(now));
}
