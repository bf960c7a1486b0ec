// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/fundamental.hpp"
#include "assets/file/json.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/vibration/machine_cases.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <string>

namespace tactus::bench {

namespace {

struct FundamentalChoice {
    int machines = 2000, first = 3000;
    bool json = false;
};

struct FundamentalStratum {
    std::string name;
    std::function<bool(const MachineCase&)> holds;
    int count = 0, certain = 0, wrong = 0, told = 0, told_certain = 0;
};

/// Upper 95 % limit of a probability of which `wrong` of `count` are a sample (Clopper and Pearson 1934), by bisection.
double upper_limit(int wrong, int count) {
    if (count == 0) return 1.0;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double p = 0.5 * (low + high);
        double term = std::pow(1.0 - p, count), sum = term;
        for (int k = 1; k <= wrong; ++k) {
            term *= p / (1.0 - p) * (count - k + 1) / k;
            sum += term;
        }
        (sum > 0.05 ? low : high) = p;
    }
    return high;
}

int bench_fundamental(const FundamentalChoice& choice) {
    std::vector<FundamentalStratum> strata;
    const auto add = [&](const char* name, std::function<bool(const MachineCase&)> holds) {
        strata.push_back({name, std::move(holds)});
    };
    add("all", [](const MachineCase&) { return true; });
    add("5 to 20 Hz", [](const MachineCase& m) { return m.frequency < 20.0; });
    add("20 to 100 Hz", [](const MachineCase& m) { return m.frequency >= 20.0 && m.frequency < 100.0; });
    add("100 Hz to 1 kHz", [](const MachineCase& m) { return m.frequency >= 100.0; });
    add("0.5 to 2 s", [](const MachineCase& m) { return m.seconds < 2.0; });
    add("2 to 10 s", [](const MachineCase& m) { return m.seconds >= 2.0 && m.seconds < 10.0; });
    add("10 to 60 s", [](const MachineCase& m) { return m.seconds >= 10.0; });
    add("SNR below 10 dB", [](const MachineCase& m) { return m.snr_db < 10.0; });
    add("SNR from 10 dB", [](const MachineCase& m) { return m.snr_db >= 10.0; });
    add("no first order", [](const MachineCase& m) { return !m.has_first; });
    add("with hum", [](const MachineCase& m) { return m.has_hum; });
    add("steady", [](const MachineCase& m) { return m.wander == 0.0; });
    add("wander to 0.3 %", [](const MachineCase& m) { return m.wander > 0.0 && m.wander < 0.003; });
    add("wander to 3 %", [](const MachineCase& m) { return m.wander >= 0.003; });
    for (int i = 0; i < choice.machines; ++i) {
        const MachineCase machine(static_cast<std::uint64_t>(choice.first + i));
        const signal::FundamentalEstimate found =
            signal::find_fundamental(std::span<const double>(machine.samples), machine.rate, 5.0, 1000.0);
        const bool certain = found.is_certain(), wrong = certain && !machine.is_right(found.frequency);
        for (FundamentalStratum& one : strata) {
            if (!one.holds(machine)) continue;
            ++one.count;
            one.certain += certain;
            one.wrong += wrong;
            one.told += machine.oracle_tells();
            one.told_certain += certain && machine.oracle_tells();
        }
        if (wrong && !choice.json)
            fmt::print("seed {}: {:.3f} Hz, certain of {:.3f} Hz; {:.2f} s at {:g} Hz, wander {:.2g}, {} orders\n",
                       choice.first + i, machine.frequency, found.frequency, machine.seconds, machine.rate,
                       machine.wander, machine.orders.size());
    }
    if (choice.json) {
        file::Json json = file::Json::array();
        for (const FundamentalStratum& one : strata)
            json.push_back({{"stratum", one.name},
                            {"machines", one.count},
                            {"certain", one.certain},
                            {"wrong", one.wrong},
                            {"upper_limit", upper_limit(one.wrong, one.certain)},
                            {"oracle", one.told},
                            {"certain_of_oracle", one.told_certain}});
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print("{:<18} {:>8} {:>8} {:>6} {:>12} {:>7} {:>16}\n", "stratum", "machines", "certain", "wrong",
               "95 % limit", "oracle", "certain of these");
    for (const FundamentalStratum& one : strata)
        fmt::print("{:<18} {:>8} {:>8} {:>6} {:>10.2f} % {:>7} {:>14.1f} %\n", one.name, one.count, one.certain,
                   one.wrong, 100.0 * upper_limit(one.wrong, one.certain), one.told,
                   100.0 * one.told_certain / std::max(1, one.told));
    return done;
}

}  // namespace

Verb fundamental_verb() {
    return {"fundamental",
            "synthetic machines of known rate: how often a certain fundamental is wrong, and how many are certain of "
            "those that an oracle tells, which knows the orders",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<FundamentalChoice>();
                verb.add("--machines", choice->machines, "number of machines").shows_default().range(1, 1000000);
                verb.add("--first", choice->first,
                         "seed of the first; below 9000 and 20000 to 31499 set the thresholds")
                    .shows_default()
                    .range(0, 1000000000);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_fundamental(*choice); };
            }};
}

}  // namespace tactus::bench
