// SPDX-License-Identifier: Apache-2.0
// A fixed part of `tactus-bench fundamental` and `verdicts`.
#include "dsp/signal/spectrum/fundamental.hpp"
#include "tests/support/catch.hpp"
#include "tools/analysis/vibration/verdict.hpp"
#include "tools/bench/vibration/machine_cases.hpp"
#include "tools/bench/vibration/verdict_cases.hpp"

#include <span>

using namespace tactus;

TEST_CASE("no machine of a few is certain of a wrong fundamental, and most are certain", "[slow]") {
    int certain = 0, count = 0;
    for (std::uint64_t seed = 5000; count < 20; ++seed) {
        const bench::MachineCase machine(seed);
        if (machine.samples.size() > 200000) continue;
        ++count;
        const signal::FundamentalEstimate found =
            signal::find_fundamental(std::span<const double>(machine.samples), machine.rate, 5.0, 1000.0);
        CAPTURE(seed, machine.frequency, found.frequency);
        certain += found.is_certain();
        if (found.is_certain()) CHECK(machine.is_right(found.frequency));
    }
    CHECK(certain >= 14);
}

TEST_CASE("random phases and bursts with the spectrum of a vibration are not the same, by their time alone", "[slow]") {
    for (std::uint64_t seed = 2000; seed < 2003; ++seed)
        for (const auto kind : {bench::PairKind::copy, bench::PairKind::random_phase, bench::PairKind::burst}) {
            const bench::VerdictCase pair(seed, kind);
            const analysis::Verdict verdict = analysis::judge(
                signal::compare(signal::Take(std::span<const double>(pair.reference), bench::VerdictCase::rate),
                                signal::Take(std::span<const double>(pair.output), bench::VerdictCase::rate)),
                0.0, {});
            CAPTURE(seed, static_cast<int>(kind), verdict.words());
            CHECK(verdict.passed() == (kind == bench::PairKind::copy));
            if (kind == bench::PairKind::copy)
                CHECK(verdict.words() == "Same mean spectrum and course over time, 40 to 1000 Hz");
        }
}
