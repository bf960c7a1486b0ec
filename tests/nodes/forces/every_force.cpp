// SPDX-License-Identifier: Apache-2.0
// A fixed part of the sweep over every force; all of it is a bench: tests/campaign/forces.cpp.
#include "tests/nodes/forces/force_sweep.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

using namespace tactus;
using namespace tactus::test;

/// Types that only the bench sweeps, and why.
static const std::map<std::string_view, std::string_view>& only_in_bench() {
    static const std::map<std::string_view, std::string_view> all{
        {"dynamic_coupling",
         "a body of 100 kg without damping that goes through the middle of a wall is put back: 4 N"},
        {"tumour_margin", "needs a plan of a case: tests/nodes/plan"},
    };
    return all;
}

// Costly: every node that makes a force.
TEST_CASE("every force that a node makes is continuous, passive on closed paths and within the limit", "[slow]") {
    for (const NodeType* type : force_types()) {
        if (only_in_bench().contains(type->name)) continue;
        std::vector<NodeSetting> settings(3);
        const std::vector<NodeSetting> corners = pairwise_corners(*type);
        settings.insert(settings.end(), corners.begin(),
                        corners.begin() + std::min<std::ptrdiff_t>(3, std::ssize(corners)));
        for (std::uint64_t n = 0; n < 4; ++n) settings.push_back(random_setting(*type, n));
        int engaged = 0;
        for (std::uint64_t n = 0; n < settings.size(); ++n) {
            const ForceOutcome outcome = run_trial({type, settings[n], random_hand(n), n, 80});
            CAPTURE(type->name, n, settings[n].text());
            for (const std::string& failure : outcome.failures) FAIL_CHECK(failure);
            engaged += outcome.is_engaged();
        }
        CAPTURE(type->name);
        CHECK(engaged > 0);
    }
}

TEST_CASE("settings of the bench at which a force once jumped stay continuous", "[slow]") {
    const std::map<std::string_view, std::vector<std::uint64_t>> once{
        {"held_weight", {139}},        {"path_guide", {113, 266}},
        {"point_proxy", {24, 52, 53}}, {"saw_blade", {38, 54, 70, 132, 193}},
        {"sphere_contact", {100}},     {"sphere_proxy", {40, 41, 52}},
        {"wrench_sum", {168}},
    };
    for (const NodeType* type : force_types()) {
        const auto found = once.find(type->name);
        if (found == once.end()) continue;
        const std::vector<NodeSetting> settings = bench_settings(*type, 300);
        for (const std::uint64_t n : found->second) {
            const ForceOutcome outcome = run_trial({type, settings[n], random_hand(n), n});
            CAPTURE(type->name, n, settings[n].text());
            CHECK(outcome.refusal == "");
            CHECK(outcome.is_engaged());
            for (const std::string& failure : outcome.failures) FAIL_CHECK(failure);
        }
    }
}

TEST_CASE("a pairwise covering array has every pair of extremes") {
    for (const NodeType* type : force_types()) {
        const std::vector<NodeSetting> rows = pairwise_corners(*type);
        const auto numbers = rows.empty() ? std::map<std::string, double>{} : rows.front().numbers;
        for (auto a = numbers.begin(); a != numbers.end(); ++a)
            for (auto b = std::next(a); b != numbers.end(); ++b) {
                std::set<std::pair<double, double>> seen;
                for (const NodeSetting& row : rows) seen.emplace(row.numbers.at(a->first), row.numbers.at(b->first));
                CAPTURE(type->name, a->first, b->first);
                CHECK(seen.size() == 4);
            }
        CHECK(rows.size() < 40);
    }
}
