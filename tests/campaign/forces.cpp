// SPDX-License-Identifier: Apache-2.0
// The sweep over every force: defaults, pairwise corners and random settings of every node type that outputs a wrench.
//     forces [SETTINGS [NODE ...]]
// prints a line for each node and each setting that fails. Exit code 1: one failed, or a node gave no force.
#include "tests/nodes/forces/force_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

namespace {

using namespace tactus;

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Number of failures; a node without any force counts as one.
int sweep(const NodeType& type, std::uint64_t random_count) {
    const std::vector<test::NodeSetting> settings = test::bench_settings(type, random_count);
    const double begin = processor_time();
    int failed = 0, engaged = 0, refused = 0;
    double force = 0.0, gained = -1.0;
    std::vector<std::string> lines;
    for (std::uint64_t n = 0; n < settings.size(); ++n) {
        const test::ForceOutcome outcome = test::run_trial({&type, settings[n], test::random_hand(n), n});
        engaged += outcome.is_engaged();
        refused += !outcome.refusal.empty();
        if (n < 5 && !outcome.refusal.empty()) lines.push_back("    " + outcome.refusal);
        force = std::max(force, outcome.largest_N);
        gained = std::max(gained, outcome.gained_J);
        failed += !outcome.failures.empty();
        for (const std::string& failure : outcome.failures) {
            const test::SweptHand hand = test::random_hand(n);
            lines.push_back(fmt::format("    {}: {} ({}; {:.3g} N, {:.3g} m/s, {:.4g} Hz)", n, failure,
                                        settings[n].text(), hand.force, hand.speed, hand.rate));
        }
    }
    fmt::print("{:<24} {:>8} {:>8} {:>8} {:>10.3g} {:>12.3g} {:>7} {:>7.1f}\n", type.name, settings.size(), engaged,
               refused, force, gained * 1e3, failed, processor_time() - begin);
    for (const std::string& line : lines) fmt::print("{}\n", line);
    if (engaged == 0) fmt::print("    no setting gave a force\n");
    std::fflush(stdout);
    return failed + (engaged == 0);
}

}  // namespace

int main(int argc, char** argv) try {
    const std::uint64_t count = argc > 1 ? std::stoull(argv[1]) : 200;
    const std::vector<std::string> wanted(argv + std::min(argc, 2), argv + argc);
    fmt::print("{:<24} {:>8} {:>8} {:>8} {:>10} {:>12} {:>7} {:>7}\n", "node", "settings", "forces", "refused",
               "largest N", "gain-cap mJ", "failed", "s");
    int failed = 0;
    for (const NodeType* type : test::force_types())
        if (wanted.empty() || std::ranges::find(wanted, type->name) != wanted.end()) failed += sweep(*type, count);
    fmt::print("{} failed, {:.0f} s of processor time\n", failed, processor_time());
    return failed > 0 ? 1 : 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "forces: {}\n", error.what());
    return 2;
}
