// SPDX-License-Identifier: Apache-2.0
// The saw beside published measurements, and what its front costs beside a blade without one.
#include "assets/bone/bone.hpp"
#include "assets/file/json.hpp"
#include "assets/library/mandible.hpp"
#include "dsp/contact/blade.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/saw/heat_partition.hpp"
#include "dsp/saw/kerf_heat.hpp"
#include "dsp/saw/published.hpp"
#include "tools/analysis/saw/bone_trial.hpp"
#include "tools/analysis/saw/burr_trial.hpp"
#include "tools/analysis/saw/device_trial.hpp"
#include "tools/analysis/saw/grid_study.hpp"
#include "tools/analysis/saw/saw_trial.hpp"
#include "tools/analysis/saw/solid_sweep.hpp"
#include "tools/bench/bench.hpp"
#include "tools/report/figures/figure_file.hpp"
#include "tools/report/figures/saw_figure.hpp"

#include <fmt/format.h>

#include <ctime>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

struct SawBenchChoice : BenchChoice {
    std::string figure;
    std::vector<std::string> bones;
    bool devices = false, grid = false, rates = false;
    int poses = 0;
};

struct Row {
    std::string what, published, tactus, how_far;
};

struct Comparison {
    std::vector<Row> rows;
    report::SawFigure figure;
};

/// Highest temperature rise of bone, K, at that distance from the middle of a cut at constant feed (mm/min), 6 mm below
/// its start, in cortical bone. Each place is cut twice a cycle by one tooth per length of the stroke.
double warming(double cycles_per_minute, double feed_mm_per_min, bool irrigated, double distance) {
    const double rate = cycles_per_minute / 60.0, feed = feed_mm_per_min * 1e-3 / 60.0, step = 0.02;
    const saw::CuttingLaw law;
    saw::KerfHeat bone;
    // The study does not state its stroke: that of the library's saw.
    const double share = saw::share_into_bone(saw::SawShape{}.stroke, feed, saw::tangent_of_shear(law),
                                              saw::KerfMaterial{}.diffusivity());
    const double heat = share * 2.0 * rate * law.along(law.thrust(feed / (2.0 * rate)));  // W/m
    double most = 0.0;
    for (double depth = 0.0; depth < 12e-3; depth += feed * step) {
        bone.advance(step, depth, heat, irrigated);
        most = std::max(most, bone.at(6e-3, distance));
    }
    return most;
}

Comparison compare() {
    namespace j = saw::james_2013;
    namespace p = saw::pearlman_2012;
    const saw::CuttingLaw law;
    Comparison made;
    const auto row = [&](const char* what, double published, double ours, const char* unit) {
        made.rows.push_back({what, fmt::format("{:.3g} {}", published, unit), fmt::format("{:.3g} {}", ours, unit),
                             fmt::format("{:+.1f} %", 100.0 * (ours / published - 1.0))});
    };
    const auto resultant = [&](double depth) { return std::hypot(law.thrust(depth), law.cutting); };
    row("fitted: thrust at 10 µm over 2 µm (James 2013)", j::thrust_rise, law.thrust(j::deep) / law.thrust(j::shallow),
        "");
    row("fitted: thrust over cutting force, 2 µm", j::ratio_shallow, law.thrust(j::shallow) / law.cutting, "");
    row("fitted: thrust over cutting force, 10 µm", j::ratio_deep, law.thrust(j::deep) / law.cutting, "");
    row("fitted: resultant at 2.5 µm (Pearlman 2012)", p::resultant_low, resultant(p::depth_low), "N");
    row("fitted: resultant at 10 µm (Pearlman 2012)", p::resultant_high, resultant(p::depth_high), "N");

    // Lannin 2011: 7 N, 3 mm, 18 TPI; bone of 4 mm so that few teeth bear, and of 12 mm.
    for (const double width : {0.004, 0.012}) {
        std::vector<double> rates{100.0, 140.0, 190.0, 250.0}, removal;
        for (const double rate : rates)
            removal.push_back(
                width * 1e-3 *
                analysis::run_saw_trial({.thrust = saw::lannin_2011::thrust, .blade_rate = rate, .width = width}).feed);
        const double exponent = std::log(removal.back() / removal.front()) / std::log(rates.back() / rates.front());
        made.rows.push_back(
            {fmt::format("predicted: cutting rate ∝ speed^n, bone {:.0f} mm (Lannin 2011)", width * 1e3),
             "n a little above 1", fmt::format("n = {:.2f}, {:.2f} mm³/s at 250 Hz", exponent, removal.back() * 1e9),
             "no number published"});
    }
    // Yu 2023: the feed is given, the force is measured.
    double least = HUGE_VAL, min_at = 0.0, at_yu = 0.0;
    for (const double rate : {120.0, 150.0, 180.0, 205.0, 228.0, 250.0, 285.0}) {
        const double thrust =
            analysis::run_saw_trial({.feed = saw::yu_2023::feed, .blade_rate = rate, .settle = 3.0}).thrust;
        made.figure.thrust.push_back({rate, thrust});
        if (thrust < least) {
            least = thrust;
            min_at = rate;
        }
        if (rate == 228.0) at_yu = thrust;
    }
    made.rows.push_back({"predicted: rate of least force at 0.67 mm/s, 120 to 285 Hz (Yu 2023)", "228 Hz",
                         fmt::format("{:.0f} Hz ({:.1f} N; {:.1f} N at 228 Hz)", min_at, least, at_yu),
                         fmt::format("{:+.0f} %, no minimum inside", 100.0 * (min_at / saw::yu_2023::rate - 1.0))});
    for (const auto& [cycles, feed, wet] : {std::tuple{10e3, 30.0, false}, std::tuple{10e3, 10.0, false},
                                            std::tuple{18e3, 30.0, false}, std::tuple{18e3, 20.0, true}})
        made.rows.push_back({fmt::format("predicted: warming, sagittal, {:.0f} cpm, {:.0f} mm/min{}", cycles, feed,
                                         wet ? ", irrigated" : ""),
                             wet                              ? "hardly above 10 K"
                             : cycles == 10e3 && feed == 30.0 ? "65 K, the least of 15"
                                                              : "more than 65 K",
                             fmt::format("{:.0f} K at the wall, {:.0f} K at 1 mm", warming(cycles, feed, wet, 0.5e-3),
                                         warming(cycles, feed, wet, 1e-3)),
                             "distance not known"});
    for (const double thrust : {3.0, 5.0, 7.5, 10.0, 12.5, 15.0, 20.0, 25.0, 30.0})
        made.figure.feed.push_back({thrust, analysis::run_saw_trial({.thrust = thrust}).feed * 1e3});
    return made;
}

/// Least CPU time and 99th percentile of wall time of a call, s, over `rounds` of 2000.
struct Cost {
    double cpu = HUGE_VAL, wall_p99 = 0.0;
};

template <class Call>
Cost cost_of(int rounds, Call&& call) {
    constexpr int calls = 2000;
    Cost cost;
    std::vector<double> walls;
    for (int round = 0; round < rounds; ++round) {
        const double before = thread_seconds();
        for (int n = 0; n < calls; ++n) {
            const auto start = std::chrono::steady_clock::now();
            call(n);
            walls.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        cost.cpu = std::min(cost.cpu, (thread_seconds() - before) / calls);
    }
    std::ranges::sort(walls);
    cost.wall_p99 = walls[walls.size() * 99 / 100];
    return cost;
}

/// CPU seconds of carving a second of sawing 44 mm of bone to the same depth.
double carve_cost(bool fronts, int rounds) {
    double best = HUGE_VAL;
    // The front follows the hand, so that both remove the same.
    const saw::CuttingLaw easy{
        .cutting = 0.0, .thrust_shallow = 1e-4, .thrust_deep = 2e-4, .rub = 0.0, .deepest = 1e-3};
    for (int round = 0; round < rounds; ++round) {
        const analysis::SawTrial trial{.width = 0.046};
        const auto bone = analysis::saw_block(trial);
        carve::Carver carver;
        carve::CarveSettings settings;
        if (fronts) settings = analysis::carve_settings_for(trial.shape);
        settings.tooth_pitch = trial.shape.pitch;
        carver.prepare(*bone, settings);
        saw::SawBlade blade(trial.shape, trial.stiffness);
        const Quat down = glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0));
        std::vector<carve::CarveSample> samples;
        std::vector<carve::CutFront> path;
        double spent = 0.0;
        for (int n = 0; n < 1020; ++n) {
            const Pose pose{Vec3(0.0, 0.0, 0.0001 - 0.0006e-3 * n), down};
            if (fronts) {
                blade.step(bone->current(), pose, {true, 228.0, 0.001}, easy);
                blade.teeth().fill(path.emplace_back(), pose, true);
            } else {
                samples.push_back({pose, 0.001, 7.0, 228.0, true});
            }
            if (n % 17 != 16) continue;
            const double before = thread_seconds();
            if (fronts) carver.update(*bone, path);
            else carver.update(*bone, samples);
            bone->reclaim(bone->publish().version);
            spent += thread_seconds() - before;
            path.clear();
            samples.clear();
        }
        best = std::min(best, spent);
    }
    return best;
}

Json costs(int rounds) {
    const analysis::SawTrial trial{.width = 0.046};
    const auto bone = analysis::saw_block(trial);
    const contact::BladePoints points({trial.shape.length, trial.shape.height, trial.shape.thickness});
    const Quat down = glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0));
    // Teeth 0.5 mm deep, a hand that moves 4 mm along the blade.
    const auto pose = [&](int n) { return Pose{Vec3(0.002 * std::sin(0.01 * n), 0.0, -0.5e-3), down}; };
    const volume::BoneSnapshot now = bone->current();
    volatile double sink = 0.0;
    const Cost plain = cost_of(rounds, [&](int n) {
        const Pose at = pose(n);
        sink = sink + contact::blade_contact(now, points, at, at.position, 3000.0).load;
    });
    saw::SawBlade blade(trial.shape, trial.stiffness);
    carve::CutFront front;
    const auto step = [&](int n, bool running) {
        sink = sink + blade.step(now, pose(n), {running, 228.0, 0.001}, {}).thrust;
        blade.teeth().fill(front, pose(n), running);
    };
    for (double z = 0.002; z > -0.5e-3; z -= 0.1e-3) {  // onto the bone
        blade.step(now, {Vec3(0.0, 0.0, z), down}, {false, 228.0, 0.001}, {});
    }
    const Cost resting = cost_of(rounds, [&](int n) { step(n, false); });
    const Cost cutting = cost_of(rounds, [&](int n) { step(n, true); });
    const double samples = carve_cost(false, rounds), fronts = carve_cost(true, rounds);
    return {{"blade_pass_us", plain.cpu * 1e6},
            {"front_us", cutting.cpu * 1e6},
            {"front_standing_us", resting.cpu * 1e6},
            {"front_over_blade_pass", cutting.cpu / plain.cpu},
            {"front_wall_p99_us", cutting.wall_p99 * 1e6},
            {"blade_pass_wall_p99_us", plain.wall_p99 * 1e6},
            {"carve_samples_ms_per_s", samples * 1e3},
            {"carve_fronts_ms_per_s", fronts * 1e3},
            {"carve_fronts_over_samples", fronts / samples}};
}

/// Feed and removed volume over thrust on bones that were imported.
int bench_bones(const SawBenchChoice& choice) {
    constexpr double thrusts[] = {2.0, 4.0, 7.5, 12.0, 20.0};  // N
    Json all = Json::array();
    for (const std::string& file : choice.bones) {
        const analysis::BoneTrial trial = analysis::run_bone_trial(bone::load_bone(file), thrusts);
        Json rows = Json::array();
        if (!choice.json)
            fmt::print("{}: {:.1f} mm thick, {:.1f} mm wide, voxels of {:.2f} mm\n", file, trial.site.thickness * 1e3,
                       trial.site.width * 1e3, trial.voxel * 1e3);
        for (const analysis::BoneTrialRow& row : trial.rows) {
            rows.push_back({{"thrust_N", row.thrust},
                            {"feed_mm_per_s", row.feed * 1e3},
                            {"removed_mm3_per_s", row.removal * 1e9},
                            {"seconds", row.seconds}});
            if (!choice.json)
                fmt::print("  {:4.1f} N: feed {:6.3f} mm/s, {:6.2f} mm³/s over {:.2f} s\n", row.thrust, row.feed * 1e3,
                           row.removal * 1e9, row.seconds);
        }
        all.push_back({{"bone", file}, {"thickness_mm", trial.site.thickness * 1e3}, {"rows", rows}});
    }
    if (choice.json) fmt::print("{}\n", all.dump(2));
    return done;
}

/// The same cut on devices of different strength.
int bench_devices(const SawBenchChoice& choice) {
    Json rows = Json::array();
    double ideal = 0.0;
    if (!choice.json)
        fmt::print("{:<8} {:>6} {:>18} {:>16} {:>8} {:>10} {:>16} {:>9}\n", "device", "scale", "stiffness, tool",
                   "thrust of tool", "rubbing", "removed", "per N s above", "to ideal");
    for (const analysis::DeviceTrial& trial : analysis::device_trials()) {
        const analysis::DeviceTrialResult r = analysis::run_device_trial(trial);
        if (ideal == 0.0) ideal = r.per_thrust;
        const double off = r.per_thrust / ideal - 1.0;
        rows.push_back({{"device", std::string(trial.model)},
                        {"device_scale", trial.scale},
                        {"stiffness_N_per_m", trial.stiffness},
                        {"thrust_N", r.thrust},
                        {"rubbing_N", r.rubbing},
                        {"removed_mm3_per_s", r.removal * 1e9},
                        {"removed_mm3_per_Ns", r.per_thrust * 1e9},
                        {"limited", r.limited},
                        {"off", off}});
        if (!choice.json)
            fmt::print(
                "{:<8} {:>6.2f} {:>12.1f} N/mm {:>14.2f} N {:>6.2f} N {:>5.2f} mm³/s {:>7.3f} mm³/(N s) {:>+7.1f} %\n",
                trial.model, trial.scale, trial.stiffness * 1e-3, r.thrust, r.rubbing, r.removal * 1e9,
                r.per_thrust * 1e9, 100.0 * off);
    }
    if (choice.json) fmt::print("{}\n", Json{{"devices", rows}}.dump(2));
    return done;
}

/// Saw and burr under the same thrusts, by the force per width of their edges.
int bench_rates(const SawBenchChoice& choice) {
    Json rows = Json::array();
    const auto row = [&](const char* tool, double thrust, double width, double depth, double along, double removal) {
        const double energy = along / (width * depth);  // J/m³
        rows.push_back({{"tool", tool},
                        {"thrust_N", thrust},
                        {"edge_in_bone_mm", width * 1e3},
                        {"force_per_width_N_per_mm", thrust / width * 1e-3},
                        {"depth_per_pass_um", depth * 1e6},
                        {"energy_J_per_mm3", energy * 1e-9},
                        {"removed_mm3_per_s", removal * 1e9}});
        if (!choice.json)
            fmt::print(
                "{:<5} {:>5.1f} N on {:>5.2f} mm of edge: {:>5.2f} N/mm, {:>6.3f} µm a pass, {:>5.1f} J/mm³; {:>7.2f} "
                "mm³/s\n",
                tool, thrust, width * 1e3, thrust / width * 1e-3, depth * 1e6, energy * 1e-9, removal * 1e9);
    };
    for (const double thrust : {4.0, 5.0, 7.5, 10.0, 15.0}) {
        const analysis::SawTrial saw{.thrust = thrust};
        const analysis::SawTrialResult sawn = analysis::run_saw_trial(saw);
        row("saw", sawn.thrust, sawn.teeth * saw.shape.kerf, sawn.feed / (2.0 * saw.blade_rate), sawn.along,
            sawn.removal);
        const analysis::BurrTrial burr{.thrust = thrust, .settle = 0.5, .seconds = 0.5};
        const analysis::BurrTrialResult milled = analysis::run_burr_trial(burr);
        row("burr", milled.thrust, milled.width, milled.feed / (burr.shape.flutes * burr.turn_rate), milled.along,
            milled.removal);
    }
    if (choice.json) fmt::print("{}\n", Json{{"rates", rows}}.dump(2));
    return done;
}

/// One box in voxels of several sizes.
int bench_grid(const SawBenchChoice& choice) {
    constexpr double voxels[] = {0.2e-3, 0.3e-3, 0.5e-3, 1e-3};
    Json rows = Json::array();
    const std::vector<analysis::GridStudyRow> study = analysis::run_grid_study(voxels);
    double mean = 0.0;
    for (const analysis::GridStudyRow& row : study) mean += row.removed / static_cast<double>(study.size());
    for (const analysis::GridStudyRow& row : study) {
        rows.push_back({{"voxel_mm", row.voxel * 1e3},
                        {"cut_in_mm", row.cut_in * 1e3},
                        {"removed_mm3", row.removed * 1e9},
                        {"feed_mm_per_s", row.feed * 1e3},
                        {"off_mean", row.removed / mean - 1.0}});
        if (!choice.json)
            fmt::print(
                "voxels of {:.1f} mm, cut in {:.3f} mm: {:6.2f} mm³ removed in 10 s, feed {:.3f} mm/s, {:+.1f} % off "
                "the "
                "mean\n",
                row.voxel * 1e3, row.cut_in * 1e3, row.removed * 1e9, row.feed * 1e3,
                100.0 * (row.removed / mean - 1.0));
    }
    if (choice.json) fmt::print("{}\n", Json{{"grid", rows}}.dump(2));
    return done;
}

/// Random attitudes of each tool on a box and on the jaw of the library.
int bench_poses(const SawBenchChoice& choice) {
    Json rows = Json::array();
    bool is_solid = true;
    const std::pair<const char*, bone::Bone> bones[] = {{"box", analysis::box_of_voxels(0.4e-3)},
                                                        {"jaw", library::make_mandible()}};
    constexpr std::pair<const char*, analysis::SolidTool> tools[] = {{"blade", analysis::SolidTool::blade},
                                                                     {"sagittal blade", analysis::SolidTool::sagittal},
                                                                     {"burr", analysis::SolidTool::burr}};
    for (const auto& [bone_name, bone] : bones)
        for (const auto& [name, tool] : tools) {
            const analysis::SolidSweepResult r = analysis::run_solid_sweep(tool, bone, (choice.poses + 5) / 6);
            is_solid = is_solid && r.silent == 0;
            rows.push_back({{"bone", bone_name},
                            {"tool", name},
                            {"poses", r.poses},
                            {"pressed_steps", r.pressed},
                            {"silent_steps", r.silent},
                            {"greatest_silent_mm", r.greatest_silent * 1e3},
                            {"median_step_N", r.median_step},
                            {"greatest_step_N", r.greatest_step},
                            {"active", r.active},
                            {"held", r.held}});
            if (!choice.json)
                fmt::print(
                    "{}, {}: {} attitudes, {} steps with a part deeper than 0.5 mm, {} without force{}; force changes "
                    "by "
                    "{:.3f} N per 0.1 mm (median), at most {:.2f} N; {} ways gave energy, {} left a force\n",
                    bone_name, name, r.poses, r.pressed, r.silent,
                    r.silent > 0 ? fmt::format(" (to {:.2f} mm)", r.greatest_silent * 1e3) : "", r.median_step,
                    r.greatest_step, r.active, r.held);
        }
    if (choice.json) fmt::print("{}\n", Json{{"poses", rows}}.dump(2));
    return is_solid ? done : answer_is_no;
}

int bench_saw(const SawBenchChoice& choice) {
    if (!choice.bones.empty()) return bench_bones(choice);
    if (choice.devices) return bench_devices(choice);
    if (choice.grid) return bench_grid(choice);
    if (choice.rates) return bench_rates(choice);
    if (choice.poses > 0) return bench_poses(choice);
    const Comparison made = compare();
    const Json cost = costs(choice.rounds);
    if (!choice.figure.empty()) report::write_figure(report::draw_saw_law(made.figure), choice.figure);
    if (choice.json) {
        Json rows = Json::array();
        for (const Row& r : made.rows)
            rows.push_back({{"what", r.what}, {"published", r.published}, {"tactus", r.tactus}, {"off", r.how_far}});
        fmt::print("{}\n", Json{{"published", rows}, {"cost", cost}}.dump(2));
        return done;
    }
    fmt::print("{:<72} {:<20} {:<34} {}\n", "", "published", "Tactus", "off");
    for (const Row& r : made.rows) fmt::print("{:<72} {:<20} {:<34} {}\n", r.what, r.published, r.tactus, r.how_far);
    fmt::print(
        "\nfront and forces, 32 teeth and the body of the blade, all teeth in bone: {:.1f} µs of CPU time, {:.2g} "
        "times the {:.1f} µs of blade_pass; wall p99 {:.1f} µs\n",
        cost["front_us"].get<double>(), cost["front_over_blade_pass"].get<double>(),
        cost["blade_pass_us"].get<double>(), cost["front_wall_p99_us"].get<double>());
    fmt::print("carving a second of a 46 mm cut: {:.1f} ms of CPU time from fronts, {:.1f} ms from poses\n",
               cost["carve_fronts_ms_per_s"].get<double>(), cost["carve_samples_ms_per_s"].get<double>());
    return done;
}

}  // namespace

Verb saw_verb() {
    return {"saw", "the cutting law beside published measurements, and the cost of the cutting front",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<SawBenchChoice>();
                verb.add("--rounds", choice->rounds, "repetitions of each timing; the best counts")
                    .shows_default()
                    .range(1, 100);
                verb.add("--figure", choice->figure, "draw the law and the measurements to this .svg, .png or .pdf");
                verb.add("--bone", choice->bones,
                         "instead: feed and removed volume over thrust on this imported bone; may be given again")
                    .one_each();
                verb.flag("--devices", choice->devices,
                          "instead: the same cut on simulated devices of different strength");
                verb.flag("--rates", choice->rates, "instead: saw and burr under the same thrusts");
                verb.flag("--grid", choice->grid, "instead: the same cut in voxels of 0.2, 0.3, 0.5 and 1 mm");
                verb.add("--poses", choice->poses,
                         "instead: presses each tool into a box and a jaw at so many random attitudes in all, and "
                         "fails when a "
                         "part sinks in without force")
                    .range(6, 100'000);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_saw(*choice); };
            }};
}

}  // namespace tactus::bench
