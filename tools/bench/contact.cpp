// SPDX-License-Identifier: Apache-2.0
// Cost per point of a pointshell against a voxmap, compared with OpenVDB sampling the same positions.
#include "assets/file/json.hpp"
#include "assets/file/part.hpp"
#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/contact/pointshell_kernel.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/contact_cases.hpp"
#include "tools/bench/contact_peer.hpp"
#include "tools/run/shell_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

constexpr int grid_size = 256;
const std::string grid_name = fmt::format("{0}x{0}x{0}", grid_size);

contact::Voxmap ball(double radius) {
    return contact::sample_voxmap(contact::centred_layout(grid_size, voxel),
                                  [=](const Vec3& p) { return contact::Ball{radius}.distance(p); });
}

// A shell just below the surface of the ball: every point is in contact, as between fitted fracture surfaces. The
// spacing is about one voxel; closer points add no information.
constexpr Case cases[] = {
    {"conforming", 5'000, 24.0, 0.0},
    {"conforming", 50'000, 76.0, 0.0},
    {"conforming", 200'000, 115.0, 0.0},
    {"conforming, quadratic", 50'000, 76.0, 0.0, contact::Interpolation::quadratic},
    {"conforming, budget 20000", 200'000, 115.0, 0.0, contact::Interpolation::trilinear, 20'000},
    {"light", 50'000, 60.0, 2.0},
    {"light", 1'000'000, 60.0, 2.0},
};
/// The shell in a hole of its own size: no point can be culled.
constexpr Case frames_of_coupling[] = {{"converged frame", 5'000, 24.0, 0.0}, {"converged frame", 50'000, 76.0, 0.0}};

Json measure(const Case& c, int rounds) {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(c.points, c.radius * voxel));
    const contact::Voxmap map = ball(c.ball());
    contact::ContactLaw law;
    law.interpolation = c.interpolation;
    contact::PointshellContact contact(shell.nodes.size());
    const ContactGridPeer peer(map.grid);
    const int frames = rounds * std::clamp(2'000'000 / c.points, 10, 200);
    // The peer samples single positions, so the comparison uses cases in which every point is sampled.
    const bool has_peer = c.distance == 0.0 && c.budget > static_cast<std::size_t>(c.points);
    std::vector<double> ours, theirs;
    contact::ContactSum sum;
    double checked = 0.0;
    for (int frame = -1; frame < frames; ++frame) {  // the first frame warms up
        const Pose pose = pose_of(c, static_cast<std::uint64_t>(frame + 1));
        const contact::ContactPair pair{&shell, pose, &map, {}, true};
        const double begin = thread_seconds();
        sum = contact({&pair, 1}, pose.position, law, c.budget);
        const double end = thread_seconds();
        if (frame >= 0) ours.push_back(end - begin);
        if (!has_peer || frame % 4 != 0) continue;
        const double peer_begin = thread_seconds();
        checked += peer.read(shell.position, pose);
        theirs.push_back(thread_seconds() - peer_begin);
    }
    const Pose pose = pose_of(c, 0);
    const contact::ContactPair pair{&shell, pose, &map, {}, true};
    const contact::ContactSum exact = contact::contact_reference({&pair, 1}, pose.position, law);
    const contact::ContactSum fast = contact({&pair, 1}, pose.position, law, c.budget);
    double error = 0.0;
    for (std::size_t i = 0; i < 6; ++i)
        error = std::max(error, std::abs(exact.gradient[i] - fast.gradient[i]) / (i < 3 ? 1.0 : shell.reach));
    const double p50 = percentile(ours, 0.5), per_point = 1e9 * p50 / c.points;
    Json row{{"name", c.name},
             {"points", c.points},
             {"in_contact", sum.in_contact},
             {"evaluated", sum.evaluated},
             {"grid", grid_name},
             {"ns_per_point", per_point},
             {"us_per_frame_p50", 1e6 * p50},
             {"us_per_frame_p99", 1e6 * percentile(ours, 0.99)},
             {"error", exact.total_force > 0.0 ? error / exact.total_force : 0.0}};
    if (has_peer && std::isfinite(checked)) {
        const double peer_ns = 1e9 * percentile(theirs, 0.5) / c.points;
        row.update({{"peer", "OpenVDB BoxStencil, value and gradient"},
                    {"peer_ns_per_point", peer_ns},
                    {"ratio", peer_ns / per_point}});
    } else {
        row.update({{"peer", nullptr}, {"peer_ns_per_point", nullptr}, {"ratio", nullptr}});
    }
    return row;
}

/// Results of the separate program that measures FCL and Bullet; empty without it.
Json contact_libraries(const Case& c, int rounds) {
    Json found = Json::array();
    std::error_code failure;
    const auto program = file::this_object().parent_path() / "bench_contact_libraries";
    if (!std::filesystem::exists(program, failure)) return found;
    const int frames = rounds * std::clamp(250'000 / c.points, 3, 50);
    const std::string command = fmt::format("{} {} {} {} {} {}", run::shell_word(program.string()), c.name, c.points,
                                            c.radius, c.distance, frames);
    std::FILE* rows = ::popen(command.c_str(), "r");
    if (!rows) return found;
    char line[512];
    while (std::fgets(line, sizeof line, rows)) found.push_back(Json::parse(line));
    ::pclose(rows);
    return found;
}

/// A hand moves the shell by 1 mm and a few degrees at up to 3 Hz in a tight hole; each frame solves the balance of
/// springs and contact.
Json measure_frames(const Case& c, int rounds) {
    const double radius = c.radius * voxel;
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(c.points, radius));
    const contact::Voxmap hole = contact::sample_voxmap(
        contact::centred_layout(grid_size, voxel), [=](const Vec3& p) { return radius + 0.02e-3 - glm::length(p); });
    coupling::Scene scene;
    scene.count = 2;
    scene.objects[0].body = {&shell, nullptr, nullptr, {}, 1, 1};
    scene.objects[1].body = {nullptr, &hole, nullptr, {}, 1, 2};
    coupling::HeldContact contact(static_cast<std::size_t>(c.points));
    contact.set(scene, 0, {}, contact::ContactLaw{}, false);
    coupling::QuasiStaticCoupling coupling;
    coupling.settings.iterations = 10;
    coupling.settings.reach = contact.reach();
    coupling.settings.gyration = contact.gyration();
    coupling.reset({});
    std::vector<double> seconds;
    double balanced = 0.0, evaluations = 0.0;
    const int frames = 300 * rounds;
    for (int frame = -20; frame < frames; ++frame) {  // the first 20 frames settle
        const double w = 6.283185307179586e-3 * frame;
        const Vec3 at =
            1e-3 * Vec3(std::sin(0.7 * w) + 0.2 * std::sin(2.9 * w), std::sin(0.9 * w + 1.0), std::sin(1.1 * w + 2.0));
        const Vec3 turn = 0.07 * Vec3(std::sin(0.8 * w), std::sin(1.2 * w), std::sin(0.6 * w));
        const double begin = thread_seconds();
        const coupling::QuasiStaticState& now = coupling.update({at, rotation_by(turn)}, contact);
        const double end = thread_seconds();
        if (frame < 0) continue;
        seconds.push_back(end - begin);
        balanced += now.balanced;
        evaluations += now.evaluations;
    }
    const contact::ContactSum& last = coupling.state().contact;
    const double p50 = percentile(seconds, 0.5);
    return {{"name", c.name},
            {"points", c.points},
            {"in_contact", last.in_contact},
            {"evaluated", last.evaluated},
            {"grid", grid_name},
            {"ns_per_point", 1e9 * p50 / c.points},
            {"us_per_frame_p50", 1e6 * p50},
            {"us_per_frame_p99", 1e6 * percentile(seconds, 0.99)},
            {"error", nullptr},
            {"peer", nullptr},
            {"peer_ns_per_point", nullptr},
            {"ratio", nullptr},
            {"balanced", balanced / frames},
            {"evaluations_mean", evaluations / frames}};
}

void print_row(const Json& row) {
    fmt::print("{:26} {:9} {:10} {:9.2f} {:9.1f} {:9.1f} {:>9}", row["name"].get<std::string>(),
               row["points"].get<int>(), row["in_contact"].get<std::size_t>(), row["ns_per_point"].get<double>(),
               row["us_per_frame_p50"].get<double>(), row["us_per_frame_p99"].get<double>(),
               row["error"].is_number() ? fmt::format("{:.1e}", row["error"].get<double>()) : "");
    if (row["ratio"].is_number())
        fmt::print(" {:9.1f} {:6.1f}", row["peer_ns_per_point"].get<double>(), row["ratio"].get<double>());
    if (row.contains("balanced"))
        fmt::print(" {:.0f} % balanced, {:.1f} evaluations", 100.0 * row["balanced"].get<double>(),
                   row["evaluations_mean"].get<double>());
    fmt::print("\n");
}

void print_libraries(const Json& rows) {
    bool any = false;
    for (const Json& row : rows)
        if (row.contains("libraries"))
            for (const Json& peer : row["libraries"]) {
                if (!any)
                    fmt::print(
                        "\nFCL and Bullet, closest equivalent: the same shell as a triangle mesh against an "
                        "analytic\nball, with all contacts. Comparable: shape, poses, and that every contact is found. "
                        "Not comparable: the libraries\nuse no distance field, and return depth and normal per "
                        "triangle but no energy, gradient or stiffness. The cost of a\nfield does not depend on its "
                        "shape; a mesh in place of the ball would cost the libraries more.\n{:8} {:26} {:>9} {:>10} "
                        "{:>9} "
                        "{:>9} {:>9} {:>6}\n",
                        "", "", "corners", "contacts", "ns/point", "p50 us", "p99 us", "ratio");
                any = true;
                fmt::print("{:8} {:26} {:9} {:10} {:9.1f} {:9.0f} {:9.0f} {:6.0f}\n", peer["peer"].get<std::string>(),
                           row["name"].get<std::string>(), peer["corners"].get<int>(), peer["contacts"].get<int>(),
                           peer["ns_per_point"].get<double>(), peer["us_per_frame_p50"].get<double>(),
                           peer["us_per_frame_p99"].get<double>(), peer["ratio"].get<double>());
            }
    if (!any) fmt::print("\nFCL and Bullet: not installed when this was built (libfcl-dev, libbullet-dev)\n");
}

}  // namespace

int bench_contact(const BenchChoice& choice) {
    Json rows = Json::array();
    if (!choice.json)
        fmt::print(
            "energy, gradient and 6x6 stiffness; kernel {}; voxels of {} mm; processor time of one thread\n"
            "{:26} {:>9} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6}\n",
            contact::kernel::variant_in_use(), 1e3 * voxel, "", "points", "in contact", "ns/point", "p50 us", "p99 us",
            "error", "OpenVDB", "ratio");
    for (const Case& c : cases) {
        rows.push_back(measure(c, choice.rounds));
        if (!choice.json) print_row(rows.back());
    }
    for (const Case& c : frames_of_coupling) {
        rows.push_back(measure_frames(c, choice.rounds));
        if (!choice.json) print_row(rows.back());
    }
    for (std::size_t i = 0; i < std::size(cases); ++i) {
        const Case& c = cases[i];
        // The peers depend neither on interpolation nor on a budget.
        if (c.points > 50'000 && c.distance == 0.0) continue;
        if (c.interpolation != contact::Interpolation::trilinear) continue;
        Json found = contact_libraries(c, choice.rounds);
        if (found.empty()) continue;
        for (Json& peer : found)
            peer["ratio"] = peer["ns_per_point"].get<double>() / rows[i]["ns_per_point"].get<double>();
        rows[i]["libraries"] = std::move(found);
    }
    if (choice.json) fmt::print("{}\n", Json{{"kernel", contact::kernel::variant_in_use()}, {"rows", rows}}.dump(2));
    else print_libraries(rows);
    return done;
}

Verb contact_verb() {
    return {"contact", "time per pointshell point against a voxmap, compared with OpenVDB",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<BenchChoice>();
                verb.add("--rounds", choice->rounds, "number of rounds; more rounds reduce scatter")
                    .shows_default()
                    .range(1, 1000);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_contact(*choice); };
            }};
}

}  // namespace tactus::bench
