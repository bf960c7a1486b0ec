// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "tools/analysis/passivity/bounces.hpp"
#include "tools/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::bench {

namespace {

struct PassivityChoice {
    analysis::BounceMatrix matrix;
    bool json = false;
};

int bench_passivity(const PassivityChoice& choice) {
    if (!choice.json)
        fmt::print("{:<22} {:<7} {:>10} {:>8} {:>6} {:>8} {:>9} {:>6}\n", "contact", "device", "stiffness", "speed",
                   "mass", "returned", "uncapped", "bound");
    const auto tell = [&](const analysis::BounceRow& row) {
        if (choice.json) return;
        fmt::print("{:<22} {:<7} {:>5.4g} N/mm {:>4.2g} m/s {:>3.2g} kg {:>8.3f} {:>9.3f} {:>6.2f}{}\n", row.node,
                   row.device, row.stiffness * 1e-3, row.speed, row.mass, row.energy_ratio, row.energy_ratio_without,
                   row.bound, row.ok() ? "" : "  BEYOND");
    };
    const std::vector<analysis::BounceRow> rows = analysis::throw_at_contacts(choice.matrix, tell);
    const bool all_ok = std::ranges::all_of(rows, &analysis::BounceRow::ok);
    if (choice.json) {
        file::Json json{{"ok", all_ok}, {"rows", file::Json::array()}};
        for (const analysis::BounceRow& row : rows)
            json["rows"].push_back({{"node", row.node},
                                    {"device", row.device},
                                    {"stiffness_N_per_mm", row.stiffness * 1e-3},
                                    {"speed_m_per_s", row.speed},
                                    {"mass_kg", row.mass},
                                    {"energy_ratio", row.energy_ratio},
                                    {"energy_ratio_without", row.energy_ratio_without},
                                    {"bound", row.bound}});
        fmt::print("{}\n", json.dump(2));
    } else {
        const auto most = std::ranges::max_element(rows, {}, &analysis::BounceRow::energy_ratio);
        if (most != rows.end()) fmt::print("{} bounces, most returned: {:.3f}\n", rows.size(), most->energy_ratio);
    }
    return all_ok ? done : answer_is_no;
}

}  // namespace

Verb passivity_verb() {
    return {"passivity",
            "masses thrown at every contact node on every simulated device: kinetic energy after over before, with and "
            "without the energy cap; exit code 1: one is beyond its bound",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<PassivityChoice>();
                verb.add("--node", choice->matrix.nodes, "contact node; all when left out");
                verb.add("--device", choice->matrix.devices, "ideal, touch, omega or falcon; all when left out");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_passivity(*choice); };
            }};
}

}  // namespace tactus::bench
