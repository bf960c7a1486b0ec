// SPDX-License-Identifier: Apache-2.0
// The vessel tracker on phantoms with known truth, in noise and on real scans, beside a plain ridge tracker.
#include "assets/file/json.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/random.hpp"
#include "dsp/simulate/vessel_cases.hpp"
#include "dsp/vessel/tracker.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/vessel/narrowing_search.hpp"
#include "tools/bench/vessel/ridge_tracker.hpp"
#include "tools/bench/vessel/vessel_real.hpp"
#include "tools/report/figures/straightened_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

namespace tactus::bench {

namespace {

using file::Json;
using simulate::VesselCase;

struct VesselBenchChoice {
    std::vector<std::string> cases;
    int repeats = 3, volumes = 100, draws = 300;
    std::filesystem::path data, pictures;
    bool json = false;
};

double seconds_of(const std::function<void()>& work) {
    const std::int64_t begin = thread_ns();
    work();
    return 1e-9 * static_cast<double>(thread_ns() - begin);
}

/// A ridge as a track of one branch, to be compared in the same way.
vessel::Track track_of(const std::vector<Vec3>& line, double radius) {
    vessel::Track track;
    if (line.empty()) return track;
    track.branches.emplace_back();
    for (const Vec3& place : line) {
        vessel::Node node;
        node.position = place;
        node.radius = radius;
        track.branches[0].nodes.push_back(node);
    }
    return track;
}

/// The worst of several noises.
Json row_of(const std::string& group, const std::function<VesselCase(std::uint64_t)>& make, int repeats) {
    simulate::TrackError worst, peer;
    double seconds = 0.0, length = 0.0, radius = 0.0, true_radius = 0.0;
    Json narrowed = Json::array();
    int uncertain = 0, missed = 0;
    bool says_lost = true;
    int found = 0;
    std::string name;
    worst.covered = peer.covered = 1.0;
    for (int n = 0; n < repeats; ++n) {
        const VesselCase one = make(static_cast<std::uint64_t>(101 + n));
        name = one.name;
        true_radius = one.radius * 1e3;
        vessel::Followed result;
        seconds += seconds_of([&] { result = vessel::follow(one.scan, one.seed); });
        length += result.track.length() * 1e3;
        const simulate::TrackError error = simulate::compared(result.track, one);
        found += !result.track.branches.empty();
        worst.rms = std::max(worst.rms, error.rms);
        worst.overshoot = std::max(worst.overshoot, error.overshoot);
        worst.covered = std::min(worst.covered, error.covered);
        if (std::isfinite(error.joint)) worst.joint = std::max(worst.joint, error.joint);
        else ++missed;
        radius += error.mean_radius / repeats;
        if (!result.track.branches.empty()) {
            says_lost = says_lost && !result.track.branches[0].lost().empty();
            if (const auto& at = result.track.branches[0].stenosis) {
                narrowed.push_back(at->percent);
                uncertain += at->is_uncertain;
            }
        }
        const simulate::TrackError ridge =
            simulate::compared(track_of(follow_ridge(one.scan, one.seed, one.radius), one.radius), one);
        peer.rms = std::max(peer.rms, ridge.rms);
        peer.overshoot = std::max(peer.overshoot, ridge.overshoot);
        peer.covered = std::min(peer.covered, ridge.covered);
    }
    Json row{{"case", name},
             {"found", found},
             {"of", repeats},
             {"rms_voxels", worst.rms},
             {"covered", worst.covered},
             {"overshoot_radii", worst.overshoot},
             {"radius_voxels", radius},
             {"true_radius_voxels", true_radius},
             {"seconds_per_200_mm", length > 0.0 ? 200.0 * seconds / length : 0.0},
             {"ridge_rms_voxels", peer.rms},
             {"ridge_covered", peer.covered},
             {"ridge_overshoot_radii", peer.overshoot}};
    if (group == "y") {
        row["joint_radii"] = worst.joint;
        row["branches_missed"] = missed;
    }
    if (group == "stenosis") {
        row["stenosis_percent"] = narrowed;
        row["stenosis_uncertain"] = uncertain;
    }
    if (group == "gap") row["says_lost"] = says_lost;
    return row;
}

void print(const Json& row) {
    fmt::print("{:34} {}/{} rms {:.2f} covered {:3.0f} % overshoot {:.1f} R, radius {:.2f} of {:.1f}, {:.2f} s/200 mm",
               row["case"].as_text(), row["found"].get<int>(), row["of"].get<int>(), row["rms_voxels"].get<double>(),
               100.0 * row["covered"].get<double>(), row["overshoot_radii"].get<double>(),
               row["radius_voxels"].get<double>(), row["true_radius_voxels"].get<double>(),
               row["seconds_per_200_mm"].get<double>());
    if (row.contains("joint_radii"))
        fmt::print(", joint {:.2f} R, branch missed in {} of {}", row["joint_radii"].get<double>(),
                   row["branches_missed"].get<int>(), row["of"].get<int>());
    if (row.contains("stenosis_percent")) {
        fmt::print(", narrowed");
        for (const Json& percent : row["stenosis_percent"]) fmt::print(" {:.0f}", percent.get<double>());
        fmt::print(" %, {} called uncertain", row["stenosis_uncertain"].get<int>());
    }
    if (row.contains("says_lost")) fmt::print(", {}", row["says_lost"].get<bool>() ? "said" : "NOT said");
    fmt::print(" | ridge: rms {:.2f} covered {:3.0f} % overshoot {:.1f} R\n", row["ridge_rms_voxels"].get<double>(),
               100.0 * row["ridge_covered"].get<double>(), row["ridge_overshoot_radii"].get<double>());
    std::fflush(stdout);
}

/// Ten seeds in each volume of noise; every second one with a correlation of 0.5 to 1.2 samples.
Json noise_row(int volumes) {
    int tracks = 0;
    const double seconds = seconds_of([&] {
        for (int n = 0; n < volumes; ++n) {
            const double correlation = n % 2 == 0 ? 0.0 : 0.5 + 0.7 * (n % 20) / 20.0;
            const volume::Grid grid = simulate::noise_case(correlation, static_cast<std::uint64_t>(5000 + n));
            const Random random{static_cast<std::uint64_t>(n)};
            for (std::uint64_t k = 0; k < 10; ++k) {
                const auto place = [&](std::uint64_t a) { return 1e-3 * (8.0 + 31.0 * random.uniform(3 * k + a)); };
                tracks += !vessel::follow(grid, Vec3(place(0), place(1), place(2))).track.branches.empty();
            }
        }
    });
    return {{"case", "noise"}, {"volumes", volumes}, {"seeds", 10 * volumes}, {"tracks", tracks}, {"seconds", seconds}};
}

int bench_vessel(const VesselBenchChoice& choice) {
    const auto is_chosen = [&](const char* group) {
        return choice.cases.empty() || std::ranges::count(choice.cases, group) > 0;
    };
    Json rows = Json::array();
    const auto add = [&](Json row) {
        if (!choice.json) print(row);
        rows.push_back(std::move(row));
    };
    const auto each = [&](const char* group, const std::vector<double>& radii, auto make) {
        if (!is_chosen(group)) return;
        for (const double radius : radii)
            add(row_of(group, [&](std::uint64_t seed) { return make(radius, seed); }, choice.repeats));
    };
    each("helix", {1.0, 1.5, 2.0, 3.0, 4.0}, [](double r, std::uint64_t s) { return simulate::helix_case(r, 0.2, s); });
    each("ends", {1.5, 2.5, 4.0}, [](double r, std::uint64_t s) { return simulate::ends_case(r, 0.4, s); });
    for (const double ratio : {1.0, 0.5})
        for (const double angle : {30.0, 60.0, 90.0})
            each("y", {2.0, 4.0}, [&](double r, std::uint64_t s) { return simulate::branch_case(r, angle, ratio, s); });
    for (const double length : {2.0, 4.0})
        for (const double percent : {50.0, 70.0, 90.0})
            each("stenosis", {2.0, 3.0, 4.0}, [&](double r, std::uint64_t s) {
                return simulate::stenosis_case({.radius = r, .percent = percent, .length = length}, s);
            });
    each("gap", {1.5, 3.0}, simulate::gap_case);
    each("bone", {1.5, 2.0, 3.0}, simulate::bone_case);
    if (is_chosen("stenosis") && !choice.pictures.empty()) {
        std::filesystem::create_directories(choice.pictures);
        const VesselCase one = simulate::stenosis_case({}, 101);
        const vessel::Track track = vessel::follow(one.scan, one.seed).track;
        report::write_picture(vessel::straightened(one.scan, track.branches.at(0), 2.5 * one.radius), track.background,
                              track.contrast, choice.pictures / "stenosis.png");
    }
    if (is_chosen("search")) {
        rows.push_back(narrowing_search(choice.draws));
        if (!choice.json) print_search(rows.back());
    }
    if (is_chosen("noise")) {
        Json row = noise_row(choice.volumes);
        if (!choice.json)
            fmt::print("noise: {} volumes, {} seeds, {} tracks, {:.0f} s\n", row["volumes"].get<int>(),
                       row["seeds"].get<int>(), row["tracks"].get<int>(), row["seconds"].get<double>());
        rows.push_back(std::move(row));
    }
    if (is_chosen("real")) {
        std::filesystem::path folder = choice.data;
        if (const char* const shared = std::getenv("TACTUS_SHARED_DATA"); folder.empty() && shared) folder = shared;
        for (Json& row : real_vessels(folder, choice.pictures)) {
            if (!choice.json) print_real(row);
            rows.push_back(std::move(row));
        }
    }
    if (choice.json) fmt::print("{}\n", rows.dump(2));
    return done;
}

Action add_options(VerbOptions& verb) {
    const auto choice = std::make_shared<VesselBenchChoice>();
    verb.add("--case", choice->cases,
             "only these: helix, ends, y, stenosis, search, gap, bone, noise, real; separated by commas")
        .separated_by(',');
    verb.add("--repeats", choice->repeats, "noises per phantom; the worst counts").shows_default().range(1, 1000);
    verb.add("--volumes", choice->volumes, "volumes of noise").shows_default().range(1, 100000);
    verb.add("--draws", choice->draws, "narrowings of the search").shows_default().range(1, 1000000);
    verb.add("--data", choice->data, "folder with vessels/*.nrrd (default: TACTUS_SHARED_DATA)");
    verb.add("--pictures", choice->pictures,
             "folder for pictures: a stenosis pulled straight, region and track of the real scans");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return bench_vessel(*choice); };
}

}  // namespace

Verb vessel_verb() {
    return {"vessel", "the vessel tracker on phantoms, noise and real scans, beside a plain ridge tracker",
            add_options};
}

}  // namespace tactus::bench
