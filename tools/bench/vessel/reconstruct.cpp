// SPDX-License-Identifier: Apache-2.0
// Reconstruction of a jaw: a published plan, the cost of dragging a plane, ranking, and how often the split is optimal.
#include "assets/file/json.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/reconstruction/fibula_inputs.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/core/random.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/plate_line.hpp"
#include "dsp/reconstruction/ranking.hpp"
#include "dsp/rope/bone_field.hpp"
#include "tools/bench/bench.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <span>

namespace tactus::bench {

namespace {

namespace fs = std::filesystem;
using namespace reconstruction;

/// A closed tube along z.
geometry::TriangleSurface tube(const Vec3& from, double length, int round, int rings) {
    geometry::TriangleSurface out;
    for (int ring = 0; ring < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            const double a = 2.0 * std::numbers::pi * n / round, s = length * ring / (rings - 1);
            const double r = (7.0 + std::cos(3.0 * a) + 0.5 * std::sin(s / (40.0 * mm))) * mm;
            out.vertices.push_back(from + Vec3(r * std::cos(a), r * std::sin(a), s));
        }
    const auto at = [round](int ring, int n) { return ring * round + n % round; };
    for (int ring = 0; ring + 1 < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            out.triangles.push_back({at(ring, n), at(ring, n + 1), at(ring + 1, n)});
            out.triangles.push_back({at(ring, n + 1), at(ring + 1, n + 1), at(ring + 1, n)});
        }
    const int low = static_cast<int>(out.vertices.size()), first = (rings - 1) * round;
    out.vertices.push_back(from);
    out.vertices.push_back(from + Vec3(0.0, 0.0, length));
    for (int n = 0; n < round; ++n) {
        out.triangles.push_back({low, (n + 1) % round, n});
        out.triangles.push_back({low + 1, first + n, first + (n + 1) % round});
    }
    return out;
}

FibulaInputs four_planes(int round, int rings) {
    FibulaInputs in;
    in.planes = {{{-60 * mm, 0, 0}, Vec3(1, 0.3, 0), {}},
                 {{-20 * mm, -20 * mm, 0}, {}, {}},
                 {{20 * mm, -20 * mm, 3 * mm}, {}, {}},
                 {{60 * mm, 10 * mm, 0}, Vec3(1, -0.4, 0), {}}};
    in.line_point = {100 * mm, 0, -200 * mm};
    in.donor = tube(in.line_point, 330 * mm, round, rings);
    return in;
}

struct Times {
    double median = 0.0, p95 = 0.0;  // ms
};

Times of(std::vector<double> ms) {
    std::ranges::sort(ms);
    return {ms[ms.size() / 2], ms[ms.size() * 95 / 100]};
}

Times drag(std::size_t& triangles) {
    FibulaInputs in = four_planes(200, 500);
    triangles = in.donor->triangles.size();
    const Random random{3};
    std::vector<double> ms;
    for (std::uint64_t n = 0; n < 60; ++n) {
        in.planes[1 + n % 2].origin +=
            Vec3(random.normal(3 * n), random.normal(3 * n + 1), random.normal(3 * n + 2)) * 0.5 * mm;
        const double begin = thread_seconds();
        plan_fibula(in);
        ms.push_back(1e3 * (thread_seconds() - begin));
    }
    return of(ms);
}

/// The same with a donor that is prepared once, as while a hand drags.
Times drag_prepared() {
    FibulaInputs in = four_planes(200, 500);
    const DonorBone donor(in);
    const Random random{3};
    std::vector<double> ms;
    for (std::uint64_t n = 0; n < 60; ++n) {
        in.planes[1 + n % 2].origin +=
            Vec3(random.normal(3 * n), random.normal(3 * n + 1), random.normal(3 * n + 2)) * 0.5 * mm;
        const double begin = thread_seconds();
        plan_fibula(in, donor);
        ms.push_back(1e3 * (thread_seconds() - begin));
    }
    return of(ms);
}

/// Eight candidates with artery and vein, two sites each, round a field of the donor.
Times ranking(int round, int rings) {
    FibulaInputs in = four_planes(round, rings);
    Flap flap;
    for (const VesselKind kind : {VesselKind::artery, VesselKind::vein}) {
        FlapVessel vessel{name_of(kind), kind, 1.5 * mm, {}};
        for (int n = 0; n <= 66; ++n)
            vessel.points.emplace_back((kind == VesselKind::vein ? 103.0 : 100.0) * mm, 11.0 * mm,
                                       (130.0 - 5.0 * n) * mm);
        flap.vessels.push_back(vessel);
        const double beside = kind == VesselKind::vein ? 4.0 * mm : 0.0;
        flap.sites.push_back({fmt::format("left {}", name_of(kind)), kind, {75 * mm + beside, 50 * mm, -30 * mm}});
        flap.sites.push_back({fmt::format("right {}", name_of(kind)), kind, {-75 * mm - beside, 50 * mm, -30 * mm}});
    }
    flap.plates = {plate_on(in, plan_fibula(in))};
    flap.plates[0].name = "plate";
    volume::Grid layout;
    layout.size = {40, 40, 345};
    layout.spacing = Vec3(1.0 * mm);
    layout.origin = in.line_point - Vec3(20.0, 20.0, 7.0) * mm;
    const contact::Voxmap map = contact::sample_voxmap(layout, [&](const Vec3& p) {
        const Vec3 d = p - in.line_point;
        return std::max({std::hypot(d.x, d.y) - 7.0 * mm, -d.z, d.z - 330.0 * mm});
    });
    const rope::BoneField donor(map);
    std::vector<double> ms;
    for (int n = 0; n < 20; ++n) {
        in.planes[1].origin.z += 0.3 * mm;
        const double begin = thread_seconds();
        ranked(in, flap, {{}, &donor, {}});
        ms.push_back(1e3 * (thread_seconds() - begin));
    }
    return of(ms);
}

/// Curves that are a chain of three straight pieces, whose best split is known: all joints found within 1 mm and all
/// directions within 2 degrees.
int optimal(int curves) {
    int found = 0;
    for (int c = 0; c < curves; ++c) {
        const Random random{static_cast<std::uint64_t>(c) + 100};
        std::vector<Vec3> joints{Vec3(0.0)};
        Vec3 along(1.0, 0.0, 0.0);
        for (std::uint64_t n = 0; n < 3; ++n) {
            joints.push_back(joints.back() + (25.0 + 25.0 * random.uniform(4 * n)) * mm * along);
            along = glm::normalize(
                along + 0.6 * Vec3(random.normal(4 * n + 1), random.normal(4 * n + 2), random.normal(4 * n + 3)));
        }
        const CurveSplit split = split_curve(joints, 3, 20.0 * mm);
        bool is_found = split.joints.size() == 4;
        for (std::size_t n = 0; is_found && n < 4; ++n) is_found = glm::length(split.joints[n] - joints[n]) < 1.0 * mm;
        for (std::size_t n = 0; is_found && n < 3; ++n)
            is_found = glm::dot(glm::normalize(split.joints[n + 1] - split.joints[n]),
                                glm::normalize(joints[n + 1] - joints[n])) > std::cos(2.0 * std::numbers::pi / 180.0);
        found += is_found;
    }
    return found;
}

struct Published {
    bool is_there = false;
    double distance = 0.0, angle = 0.0;  // mm, degrees
};

/// Greatest distance (mm) and angle (degrees) of the rims of the published pieces from the planes of the jaw, when the
/// pieces are mapped by our transforms.
Published published(const fs::path& folder) {
    if (!fs::exists(folder / "brp_plan_inputs.json")) return {};
    FibulaInputs in = read_fibula_inputs(folder / "brp_plan_inputs.json");
    Published worst;
    worst.is_there = true;
    std::vector<std::array<std::vector<Vec3>, 2>> rims;
    const Vec3 axis = glm::normalize(in.line_direction);
    for (int n = 0; n < 3; ++n) {
        const mesh::Mesh piece = mesh::load_mesh(folder / fmt::format("brp_fibula_segment{}.ply", n));
        std::map<std::pair<int, int>, int> uses;
        for (const auto& t : piece.triangles)
            for (std::size_t c = 0; c < 3; ++c) ++uses[std::minmax(t[c], t[(c + 1) % 3])];
        std::vector<Vec3> border;
        double middle = 0.0;
        for (const auto& [edge, count] : uses)
            if (count == 1) border.push_back(piece.vertices[static_cast<std::size_t>(edge.first)] * mm);
        for (const Vec3& p : border) middle += glm::dot(p, axis) / static_cast<double>(border.size());
        std::array<std::vector<Vec3>, 2> two;
        for (const Vec3& p : border) two[glm::dot(p, axis) > middle ? 1 : 0].push_back(p);
        rims.push_back(two);
    }
    // The most distal piece first; its lower rim tells where on the line it begins.
    std::ranges::sort(rims, {}, [&](const auto& two) { return glm::dot(two[0][0], axis); });
    const FibulaPlan unplaced = plan_fibula(in);
    for (std::size_t n = 0; n < 3; ++n) {
        const Vec3 normal = unplaced.segments[n].donor_plane[0].normal;
        in.along_line.push_back(glm::dot(normal, rims[n][0][0] - in.line_point) / glm::dot(normal, axis));
    }
    const FibulaPlan plan = plan_fibula(in);
    for (std::size_t n = 0; n < 3; ++n)
        for (std::size_t end = 0; end < 2; ++end) {
            const FibulaSegment& s = plan.segments[n];
            const Vec3 normal = glm::normalize(*in.planes[n + end].normal);
            Vec3 fitted(0.0);
            for (const Vec3& a : rims[n][end])
                for (const Vec3& b : rims[n][end]) {
                    const Vec3 cross = glm::cross(a - rims[n][end][0], b - rims[n][end][0]);
                    if (glm::length(cross) > glm::length(fitted)) fitted = cross;
                }
            const double cosine = std::abs(glm::dot(s.donor_to_target.rotate(glm::normalize(fitted)), normal));
            worst.angle = std::max(worst.angle, std::acos(std::min(1.0, cosine)) * 180.0 / std::numbers::pi);
            for (const Vec3& p : rims[n][end])
                worst.distance =
                    std::max(worst.distance,
                             1e3 * std::abs(glm::dot(s.donor_to_target.apply(p) - in.planes[n + end].origin, normal)));
        }
    return worst;
}

int run(bool json) {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    const Published golden = data ? published(fs::path(data) / "foff") : Published{};
    std::size_t triangles = 0;
    const Times dragged = drag(triangles), prepared = drag_prepared(), rank = ranking(60, 150),
                rank_large = ranking(200, 500);
    const int best = optimal(100);
    if (json) {
        fmt::print(
            "{}\n",
            file::Json{{"published_distance_mm", golden.is_there ? file::Json(golden.distance) : file::Json(nullptr)},
                       {"published_angle_deg", golden.is_there ? file::Json(golden.angle) : file::Json(nullptr)},
                       {"drag_triangles", triangles},
                       {"drag_median_ms", dragged.median},
                       {"drag_p95_ms", dragged.p95},
                       {"drag_prepared_median_ms", prepared.median},
                       {"drag_prepared_p95_ms", prepared.p95},
                       {"rank_median_ms", rank.median},
                       {"rank_p95_ms", rank.p95},
                       {"rank_large_median_ms", rank_large.median},
                       {"rank_large_p95_ms", rank_large.p95},
                       {"optimal_of_100", best}}
                .dump(2));
        return done;
    }
    if (golden.is_there)
        fmt::print("published plan: rims meet the planes of the jaw within {:.4f} mm and {:.4f}°\n", golden.distance,
                   golden.angle);
    else fmt::print("published plan: skipped, TACTUS_SHARED_DATA names no folder with foff/brp_plan_inputs.json\n");
    fmt::print("a plane dragged, four planes, {} triangles: median {:.1f} ms, p95 {:.1f} ms of processor time\n",
               triangles, dragged.median, dragged.p95);
    fmt::print("  with the donor prepared before: median {:.1f} ms, p95 {:.1f} ms\n", prepared.median, prepared.p95);
    fmt::print("eight candidates ranked, two vessels with two sites each: median {:.1f} ms, p95 {:.1f} ms\n",
               rank.median, rank.p95);
    fmt::print("  with a donor of {} triangles: median {:.1f} ms, p95 {:.1f} ms\n", triangles, rank_large.median,
               rank_large.p95);
    fmt::print("split of a curve: {} of 100 within 1 mm and 2° of the known optimum\n", best);
    return done;
}

}  // namespace

Verb reconstruct_verb() {
    return {"reconstruct", "reconstruction of a jaw: a published plan, dragging a plane, ranking, splits of curves",
            [](VerbOptions& verb) -> Action {
                const auto json = std::make_shared<bool>(false);
                verb.flag("--json", *json, "as JSON");
                return [json] { return run(*json); };
            }};
}

}  // namespace tactus::bench
