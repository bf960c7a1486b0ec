// SPDX-License-Identifier: Apache-2.0
// The first tube: a sweep over directions and radii at the seed.
#include "dsp/vessel/search.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <numbers>

namespace tactus::vessel {

double edge_distance(const Scan& scan, const Tube& tube) {
    constexpr int rays = 12;
    const double level = tube.background + 0.5 * tube.contrast;
    const double step = std::min(0.3 * scan.voxel(), 0.2 * tube.radius);
    const Across frame = across(tube.direction);
    std::array<double, rays> found;
    for (int ray = 0; ray < rays; ++ray) {
        const double angle = 2.0 * std::numbers::pi * ray / rays;
        const Vec3 out = std::cos(angle) * frame.first + std::sin(angle) * frame.second;
        double distance = step;
        for (; distance < 4.0 * tube.radius; distance += step) {
            double sum = 0.0;
            int count = 0;
            for (const double along : {-0.8, -0.4, 0.0, 0.4, 0.8}) {
                float value;
                if (scan.value(tube.centre + distance * out + along * tube.radius * tube.direction, value))
                    sum += double(value), ++count;
            }
            if (count < 3 || sum < level * count) break;
        }
        found[static_cast<std::size_t>(ray)] = distance;
    }
    std::nth_element(found.begin(), found.begin() + 2, found.end());
    return found[2];
}

namespace {

/// Directions over a half sphere, about 15 degrees apart.
std::vector<Vec3> half_sphere() {
    std::vector<Vec3> directions;
    constexpr int count = 120;
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int n = 0; n < count / 2; ++n) {
        const double z = 1.0 - (2.0 * n + 1.0) / count, r = std::sqrt(1.0 - z * z);
        directions.emplace_back(r * std::cos(golden * n), r * std::sin(golden * n), z);
    }
    return directions;
}

/// The tube of least radius whose score is not surpassed by the next larger one: the score of what holds a vessel and
/// its neighbours grows with the number of samples. Only tubes of at least half of the best contrast.
Tube first_peak(std::vector<Tube> tubes, double min_score) {
    std::ranges::stable_sort(tubes, [](const Tube& a, const Tube& b) { return a.radius < b.radius; });
    std::vector<Tube> different;  // fits of several radii often end at one tube
    double contrast = 0.0;
    for (const Tube& tube : tubes) {
        if (tube.score >= min_score) contrast = std::max(contrast, tube.contrast);
        if (!different.empty() && tube.radius < 1.2 * different.back().radius) {
            if (tube.score > different.back().score) different.back() = tube;
        } else {
            different.push_back(tube);
        }
    }
    Tube best;
    for (std::size_t n = 0; n < different.size(); ++n) {
        const Tube& tube = different[n];
        if (tube.score > best.score) best = tube;
        const bool is_peak = n + 1 == different.size() || different[n + 1].score < tube.score;
        if (is_peak && tube.score >= min_score && tube.contrast > 0.5 * contrast) return tube;
    }
    return best;
}

}  // namespace

Tube best_start(const Search& search, const Vec3& seed) {
    static const std::vector<Vec3> directions = half_sphere();
    const TrackSettings& settings = search.settings;
    std::vector<Tube> best;  // one per radius
    const double least = std::max(settings.min_radius, 0.7 * search.scan.voxel());
    for (double radius = least; radius <= settings.max_radius; radius *= 1.3) {
        Tube found;
        for (const Vec3& direction : directions) {
            Tube tube;
            tube.centre = seed, tube.direction = direction, tube.radius = radius;
            tube = measured(search.scan, search.window, search.sampling, tube);
            if (tube.score > found.score) found = tube;
        }
        if (!(found.score > 0.0)) continue;
        FitLimits limits{0.75 * radius, 1.35 * radius};
        limits.shift = 1.0;
        limits.rounds = 3;
        Tube tube = fitted(search.scan, search.window, search.sampling, found, limits);
        const double edge = edge_distance(search.scan, tube);
        if (tube.radius > 1.3 * edge) {
            if (0.75 * radius > 1.3 * edge) continue;
            limits.max_radius = 1.3 * edge;
            tube.radius = std::min(tube.radius, limits.max_radius);
            tube = fitted(search.scan, search.window, search.sampling, tube, limits);
        }
        // The seed must lie in the vessel.
        const Vec3 away = seed - tube.centre;
        const double along = glm::dot(away, tube.direction);
        const double off = std::sqrt(std::max(0.0, glm::dot(away, away) - along * along));
        if (off > std::max(1.3 * tube.radius, search.scan.voxel())) continue;
        best.push_back(tube);
    }
    return first_peak(std::move(best), search.min_start);
}

}  // namespace tactus::vessel
