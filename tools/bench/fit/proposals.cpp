// SPDX-License-Identifier: Apache-2.0
// How much of a fracture the proposal from roughness finds, and how much intact surface it takes, with known truth.
#include "assets/file/json.hpp"
#include "assets/library/fibula.hpp"
#include "assets/library/mandible.hpp"
#include "assets/plan/propose_paint.hpp"
#include "tools/analysis/bone/fracture.hpp"
#include "tools/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

struct ProposalsChoice {
    int first = 0, count = 6;
    double chips = 0.1, voxel = 0.35;  // share, mm
    std::vector<double> roughness{0.3, 0.5, 0.8, 1.2};  // mm
    bool json = false;
};

/// m², over all fragments of one broken bone.
struct Proposed {
    double fracture = 0.0, found = 0.0, intact = 0.0, taken = 0.0;

    void add(const Proposed& other) {
        fracture += other.fracture;
        found += other.found;
        intact += other.intact;
        taken += other.taken;
    }
};

Proposed propose(bool is_jaw, std::uint64_t seed, double roughness, const ProposalsChoice& choice) {
    static const bone::Bone jaw = library::make_mandible(), fibula = library::make_fibula();
    analysis::FractureSettings settings;
    settings.pieces = is_jaw ? 4 : 3;
    settings.seed = seed;
    settings.chips = choice.chips;
    settings.roughness = roughness * 1e-3;
    settings.voxel = choice.voxel * 1e-3;
    settings.spacing = std::max(settings.spacing, settings.voxel);
    Proposed sum;
    analysis::break_and_scan(is_jaw ? jaw : fibula, settings, [&](const analysis::ScannedFragment& fragment) {
        const std::vector<contact::SurfacePoint>& truth = fragment.bone.points;
        std::vector<contact::SurfacePoint> points = truth;
        plan::propose_fracture(points);
        for (std::size_t n = 0; n < points.size(); ++n) {
            const bool is_fracture = truth[n].label == contact::surface_label::fracture;
            const bool is_proposed = points[n].label == contact::surface_label::fracture;
            const double area = truth[n].area;
            (is_fracture ? sum.fracture : sum.intact) += area;
            if (is_proposed) (is_fracture ? sum.found : sum.taken) += area;
        }
    });
    return sum;
}

int bench_proposals(const ProposalsChoice& choice) {
    Json rows = Json::array();
    for (const double roughness : choice.roughness)
        for (const bool is_jaw : {true, false}) {
            Proposed sum;
            for (int n = choice.first; n < choice.first + choice.count; ++n)
                sum.add(propose(is_jaw, 60'000 + static_cast<std::uint64_t>(n), roughness, choice));
            const double found = sum.found / std::max(sum.fracture, 1e-12),
                         taken = sum.taken / std::max(sum.intact, 1e-12);
            rows.push_back({{"roughness_mm", roughness},
                            {"bone", is_jaw ? "jaw" : "fibula"},
                            {"fracture_mm2", sum.fracture * 1e6},
                            {"found", found},
                            {"intact_mm2", sum.intact * 1e6},
                            {"taken", taken}});
            if (choice.json) continue;
            fmt::print(
                "{} of {:.1f} mm relief: {:.0f} % of {:.0f} mm² of fracture found, {:.1f} % of {:.0f} mm² of "
                "intact surface taken\n",
                is_jaw ? "jaw" : "fibula", roughness, 100.0 * found, sum.fracture * 1e6, 100.0 * taken,
                sum.intact * 1e6);
            std::fflush(stdout);
        }
    if (choice.json) fmt::print("{}\n", Json{{"version", 1}, {"rows", rows}}.dump(2));
    return done;
}

}  // namespace

Verb proposals_verb() {
    return {
        "proposals", "how much of a fracture is proposed from its roughness, and how much intact surface",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<ProposalsChoice>();
            verb.add("--first", choice->first, "number of the first broken bone").shows_default().range(0, 1'000'000);
            verb.add("--count", choice->count, "number of broken bones of each kind").shows_default().range(1, 1000);
            verb.add("--chips", choice->chips, "share of the faces that is chipped").shows_default().range(0.0, 0.9);
            verb.add("--voxel", choice->voxel, "mm, of the scans").shows_default().range(0.2, 2.0);
            verb.add("--roughness", choice->roughness, "mm rms of the faces' relief (default: 0.3 0.5 0.8 1.2)");
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_proposals(*choice); };
        }};
}

}  // namespace tactus::bench
