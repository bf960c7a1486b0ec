// SPDX-License-Identifier: Apache-2.0
// What a point of a pointshell costs against a voxmap, beside OpenVDB reading the same places.
#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/contact/pointshell_kernel.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/core/random.hpp"
#include "tools/bench_contact_peer.hpp"
#include "tools/verbs.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <time.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

constexpr double voxel = 0.35e-3;
constexpr int grid_size = 256;

/// Processor time of this thread: other work on the machine counts only by what it takes from the caches.
double thread_seconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Voxmap ball(double radius) {
    return sample_voxmap(centred_layout(grid_size, voxel), [=](const Vec3& p) { return Ball{radius}.distance(p); });
}

struct Case {
    const char* name;
    int points;
    double radius;  ///< of the shell, in voxels
    double apart;   ///< of the centres, in radii: 0 for a shell within the ball, 2 for two balls that touch
    Interpolation interpolation = Interpolation::trilinear;
    std::size_t budget = std::numeric_limits<std::size_t>::max();
};

// A shell just below the surface of the ball: every point in contact, as between fitted fracture surfaces. The points
// stand about one voxel apart, which is as close as they are any use.
constexpr Case cases[] = {
    {"conforming", 5'000, 24.0, 0.0},
    {"conforming", 50'000, 76.0, 0.0},
    {"conforming", 200'000, 115.0, 0.0},
    {"conforming, quadratic", 50'000, 76.0, 0.0, Interpolation::quadratic},
    {"conforming, budget 20000", 200'000, 115.0, 0.0, Interpolation::trilinear, 20'000},
    {"light", 50'000, 60.0, 2.0},
    {"light", 1'000'000, 60.0, 2.0},
};

/// A pose per frame: any turn, pressed in by 0.1 to 0.2 mm, nothing like the frame before.
Pose pose_of(const Case& c, std::uint64_t frame) {
    const Random random{7};
    const auto normal = [&](std::uint64_t n) { return random.normal(16 * frame + n); };
    const Quat turn = glm::normalize(Quat(normal(0), normal(1), normal(2), normal(3)));
    const Vec3 way = glm::normalize(Vec3(normal(4), normal(5), normal(6)));
    const double press = 1e-4 * (1.0 + random.uniform(16 * frame + 7));
    return {way * (c.apart > 0.0 ? c.apart * c.radius * voxel - press : 0.5 * press), turn};
}

double percentile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

Json measure(const Case& c, int rounds) {
    const Pointshell shell = make_pointshell(spread_over_ball(c.points, c.radius * voxel));
    const Voxmap map = ball(c.radius * voxel + (c.apart > 0.0 ? 0.0 : 0.3e-3));
    ContactLaw law;
    law.interpolation = c.interpolation;
    PointshellContact contact(shell.nodes.size());
    const ContactGridPeer peer(map.grid);
    const int frames = rounds * std::clamp(2'000'000 / c.points, 10, 200);
    // Reading single places is what the peer does, so it is compared where every point is read.
    const bool has_peer = c.apart == 0.0 && c.budget > static_cast<std::size_t>(c.points);
    std::vector<double> ours, theirs;
    ContactSum sum;
    double checked = 0.0;
    for (int frame = -1; frame < frames; ++frame) {  // the first is not counted
        const Pose pose = pose_of(c, static_cast<std::uint64_t>(frame + 1));
        const ContactPair pair{&shell, pose, &map, {}, true};
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
    const ContactPair pair{&shell, pose, &map, {}, true};
    const ContactSum exact = contact_reference({&pair, 1}, pose.position, law);
    const ContactSum fast = contact({&pair, 1}, pose.position, law, c.budget);
    double error = 0.0;
    for (std::size_t i = 0; i < 6; ++i)
        error = std::max(error, std::abs(exact.gradient[i] - fast.gradient[i]) / (i < 3 ? 1.0 : shell.reach));
    const double p50 = percentile(ours, 0.5), per_point = 1e9 * p50 / c.points;
    Json row{{"name", c.name},
             {"points", c.points},
             {"in_contact", sum.in_contact},
             {"evaluated", sum.evaluated},
             {"grid", fmt::format("{0}x{0}x{0}", grid_size)},
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

}  // namespace

int bench_contact_verb(const BenchChoice& choice) {
    Json rows = Json::array();
    if (!choice.json)
        fmt::print(
            "energy, gradient and 6x6 stiffness; kernel {}; voxels of {} mm; processor time of one thread\n"
            "{:26} {:>9} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6}\n",
            kernel::variant_in_use(), 1e3 * voxel, "", "points", "in contact", "ns/point", "p50 us", "p99 us", "error",
            "OpenVDB", "ratio");
    for (const Case& c : cases) {
        const Json row = measure(c, choice.rounds);
        rows.push_back(row);
        if (choice.json) continue;
        fmt::print("{:26} {:9} {:10} {:9.2f} {:9.1f} {:9.1f} {:9.1e}", c.name, c.points,
                   row["in_contact"].get<std::size_t>(), row["ns_per_point"].get<double>(),
                   row["us_per_frame_p50"].get<double>(), row["us_per_frame_p99"].get<double>(),
                   row["error"].get<double>());
        if (row["ratio"].is_number())
            fmt::print(" {:9.1f} {:6.1f}", row["peer_ns_per_point"].get<double>(), row["ratio"].get<double>());
        fmt::print("\n");
    }
    if (choice.json) fmt::print("{}\n", Json{{"kernel", kernel::variant_in_use()}, {"rows", rows}}.dump(2));
    return done;
}

}  // namespace tactus
