// SPDX-License-Identifier: Apache-2.0
// Commands of a plan: one function applies them, in a tick and to a plan file.
#include "assets/plan/plan_history.hpp"

#include "assets/plan/plan_file.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <bit>
#include <limits>
#include <set>

using namespace tactus;
using Outcome = plan::PlanHistory::Outcome;

namespace {

plan::CasePlan five() {
    plan::CasePlan plan;
    plan.title = "five";
    for (const char* name : {"a", "b", "c", "d", "e"}) plan.fragments.push_back({name, name, 1, Vec3(1.0)});
    return plan;
}

Pose at(double x, const Vec3& turn = Vec3(0.0)) { return {Vec3(x, 2.0 * x, -x), rotation_by(turn)}; }

bool is_same(const fit::Arrangement& a, const fit::Arrangement& b) {
    for (int n = 0; n < static_cast<int>(a.size()); ++n) {
        const Pose &p = a.pose(n), &q = b.pose(n);
        if (std::bit_cast<std::array<std::uint64_t, 7>>(p) != std::bit_cast<std::array<std::uint64_t, 7>>(q))
            return false;
        if (a.is_locked(n) != b.is_locked(n) || a.is_hidden(n) != b.is_hidden(n)) return false;
        if (a.was_fitted_to(n) != b.was_fitted_to(n) || a.fitted_to(n) != b.fitted_to(n)) return false;
        for (int m = 0; m < n; ++m)
            if (a.move_together(n, m) != b.move_together(n, m)) return false;
    }
    return true;
}

/// Any command, most of them possible.
plan::PlanCommand any(const Random& random, std::uint64_t n) {
    const auto below = [&](std::uint64_t k, double bound) {
        return static_cast<int>(random.uniform(16 * n + k) * bound);
    };
    const int a = below(1, 5.2), b = below(2, 5.0);
    const Pose pose = at(0.05 * random.uniform(16 * n + 3), Vec3(random.uniform(16 * n + 4), 0.3, -0.2));
    const plan::FragmentSet some = plan::set_of({a, b, below(8, 5.0)});
    switch (below(0, 15.0)) {
        case 0:
        case 1: return plan::PlaceFragment{a, pose};
        case 2: return plan::SettleFragment{a, b, pose, {0.9, 0.1, 1e-4, 2e-4, 3e-4, 4e-5}};
        case 3: return plan::JoinFragments{below(5, 2.0) == 0 ? some : plan::set_of({a, b})};
        case 4: return plan::AddFragments{below(5, 3.0), some};
        case 5: return plan::SplitFragments{some};
        case 6: return plan::DissolveGroup{below(5, 3.0)};
        case 7: return plan::LockFragments{plan::set_of({a}), below(5, 3.0) == 0};
        case 8: return plan::HideFragments{some, below(5, 2.0) == 0};
        case 9: return plan::UndoStep{};
        case 10: return plan::RedoStep{};
        case 11: return plan::GoToAlternative{below(6, 5.0)};
        case 12: return plan::DropAlternative{below(7, 4.0)};
        case 13: return plan::LockFragments{some, false};
        default: return plan::RestoreAlternative{};
    }
}

}  // namespace

TEST_CASE("the plan file of any commands has the state of the run to the bit after each of them") {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const Random random{seed};
        plan::PlanHistory run(five());
        plan::ChangedPlan file(five());
        std::set<Outcome> outcomes;
        for (std::uint64_t n = 0; n < 150; ++n) {
            const plan::PlanCommand command = any(random, n);
            const Outcome outcome = run.apply(command);
            outcomes.insert(outcome);
            INFO("seed " << seed << ", command " << n << " of kind " << command.index());
            REQUIRE(file.apply(command) == outcome);
            const plan::CasePlan read = plan::read_plan_text(plan::plan_text(file.plan()), "test");
            REQUIRE(is_same(plan::state_of(read).arrangement, run.now()));
            REQUIRE(read.place().head == run.place().head);
            REQUIRE(read.place().tip == run.place().tip);
            REQUIRE(read.alternatives.size() == run.alternatives());
            REQUIRE(static_cast<int>(read.steps.size()) == run.count());
        }
        CHECK(outcomes.size() >= 6);
        // A run that begins with this file goes on from the same state.
        plan::PlanHistory next(file.plan());
        CHECK(is_same(next.now(), run.now()));
        const Outcome undone = run.apply(plan::UndoStep{});
        CHECK(next.apply(plan::UndoStep{}) == undone);
        CHECK(is_same(next.now(), run.now()));
    }
}

TEST_CASE("a command that is refused changes nothing and says why") {
    plan::PlanHistory history(five());
    CHECK(history.apply(plan::UndoStep{}) == Outcome::nothing_to_undo);
    CHECK(history.apply(plan::RedoStep{}) == Outcome::nothing_to_redo);
    REQUIRE(history.apply(plan::JoinFragments{plan::set_of({0, 1})}) == Outcome::done);
    REQUIRE(history.apply(plan::LockFragments{plan::set_of({1}), true}) == Outcome::done);
    const fit::Arrangement before = history.now();
    CHECK(history.apply(plan::PlaceFragment{0, at(0.1)}) == Outcome::locked);
    CHECK(history.apply(plan::PlaceFragment{5, at(0.1)}) == Outcome::no_such_fragment);
    CHECK(history.apply(plan::PlaceFragment{2, at(1e-7)}) == Outcome::unchanged);
    CHECK(history.apply(plan::JoinFragments{plan::set_of({1, 0})}) == Outcome::unchanged);
    CHECK(history.apply(plan::LockFragments{plan::set_of({1}), true}) == Outcome::unchanged);
    CHECK(history.apply(plan::HideFragments{plan::set_of({0, 3}), false}) == Outcome::unchanged);
    CHECK(history.apply(plan::JoinFragments{plan::set_of({2})}) == Outcome::unchanged);
    CHECK(history.apply(plan::JoinFragments{}) == Outcome::no_such_fragment);
    CHECK(history.apply(plan::HideFragments{plan::set_of({2, 5})}) == Outcome::no_such_fragment);
    CHECK(history.apply(plan::AddFragments{3, plan::set_of({2})}) == Outcome::no_such_group);
    CHECK(history.apply(plan::DissolveGroup{3}) == Outcome::no_such_group);
    CHECK(history.apply(plan::PlaceFragment{2, at(60.0)}) == Outcome::too_far);
    CHECK(history.apply(plan::GoToAlternative{3}) == Outcome::no_such_alternative);
    CHECK(history.apply(plan::DropAlternative{0}) == Outcome::no_such_alternative);
    CHECK(history.apply(plan::SettleFragment{2, 2, at(0.1), {}}) == Outcome::no_such_fragment);
    CHECK(is_same(before, history.now()));
    CHECK(history.count() == 2);
    CHECK(plan::text_of(Outcome::locked).find("locked") != std::string_view::npos);
}

TEST_CASE("a command that passes as numbers is the same to the bit, and numbers that are none are refused") {
    const auto hash_of = [](const plan::PlanCommand& command) {
        Hash hash;
        plan::add_to(hash, command);
        return hash.value();
    };
    std::set<std::size_t> kinds;
    for (std::uint64_t n = 0; n < 300; ++n) {
        plan::PlanCommand command = any(Random{7}, n);
        if (auto* const settled = std::get_if<plan::SettleFragment>(&command))
            settled->basis = n % 2 == 0 ? plan::FitBasis::hand : plan::FitBasis::mirror;
        const auto read = plan::command_of(plan::numbers_of(command));
        REQUIRE(read);
        CHECK(hash_of(*read) == hash_of(command));
        kinds.insert(command.index());
    }
    CHECK(kinds.size() == std::variant_size_v<plan::PlanCommand>);
    for (const double kind : {0.0, -1.0, 0.5, 14.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        plan::PlanCommandNumbers numbers = plan::numbers_of(plan::PlaceFragment{1, at(0.1)});
        numbers[0] = kind;
        CHECK_FALSE(plan::command_of(numbers));
    }
    plan::PlanCommandNumbers numbers = plan::numbers_of(plan::PlaceFragment{1, at(0.1)});
    numbers[1] = 1.5;
    CHECK_FALSE(plan::command_of(numbers));
}

TEST_CASE("a decision of a surgeon is a step that names what it rests on") {
    plan::ChangedPlan changed(five());
    REQUIRE(changed.apply(plan::SettleFragment{1, 0, at(0.1), {}, plan::FitBasis::hand}) == Outcome::done);
    CHECK(changed.plan().steps.back().fit->verdict == "accepted by hand");
    CHECK(changed.plan().steps.back().by == "hand");
}

TEST_CASE("equal commands have equal hashes whatever lies between their fields, and others do not") {
    const auto hash_of = [](const plan::PlanCommand& command, unsigned char filling) {
        alignas(plan::PlanCommand) std::array<unsigned char, sizeof(plan::PlanCommand)> bytes;
        bytes.fill(filling);
        const auto* const copy = new (bytes.data()) plan::PlanCommand(command);
        Hash hash;
        plan::add_to(hash, *copy);
        return hash.value();
    };
    const plan::PlanCommand all[] = {plan::PlaceFragment{1, at(0.1)},
                                     plan::PlaceFragment{1, at(0.2)},
                                     plan::SettleFragment{1, 2, at(0.1), {}},
                                     plan::SettleFragment{1, 2, at(0.1), {0.5, 0, 0, 0, 0, 0}},
                                     plan::SettleFragment{1, 2, at(0.1), {}, plan::FitBasis::hand},
                                     plan::LockFragments{plan::set_of({1}), true},
                                     plan::LockFragments{plan::set_of({1}), false},
                                     plan::UndoStep{},
                                     plan::RedoStep{},
                                     plan::GoToAlternative{1},
                                     plan::DropAlternative{1}};
    std::set<std::uint64_t> hashes;
    for (const plan::PlanCommand& command : all) {
        CHECK(hash_of(command, 0x00) == hash_of(command, 0xff));
        hashes.insert(hash_of(command, 0));
    }
    CHECK(hashes.size() == std::size(all));
}
