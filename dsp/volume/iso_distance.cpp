// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/iso_distance.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/geometry/nearest_points.hpp"
#include "dsp/volume/iso_surface.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::volume {

namespace {

// Data for the samples of some layers: grey values, and the index of the nearest surface point.
struct Field {
    const SurfaceFinder& finder;
    const SurfacePoints& points;
    const std::vector<std::int32_t>& nearest;
    int first, end;  // layers that `nearest` covers
    double reach;
    float band = static_cast<float>(3.0 * finder.widest);
    float around2 =
        (band + 1.5f * static_cast<float>(finder.widest)) * (band + 1.5f * static_cast<float>(finder.widest));

    float apart2(const glm::vec3& at, std::int32_t id) const {
        const glm::vec3 d = (points.at[static_cast<std::size_t>(id)] - at) * finder.h;
        return glm::dot(d, d);
    }

    // Distance to the disc of half a cell's diagonal around a point, in its tangent plane.
    float to_disc(const glm::vec3& at, std::int32_t id) const {
        const glm::vec3 d = (at - points.at[static_cast<std::size_t>(id)]) * finder.h;
        const float up = glm::dot(d, points.normal[static_cast<std::size_t>(id)]);
        const float aside = std::sqrt(std::max(0.0f, glm::dot(d, d) - up * up));
        const float over = std::max(0.0f, aside - 0.7f * static_cast<float>(finder.cell));
        return std::sqrt(up * up + over * over);
    }

    // Candidates for the nearest point, nearest first: those of the sample, of its neighbours and of the cells below it
    // on the surface.
    struct Candidates {
        std::array<std::int32_t, 3> id{-1, -1, -1};
        std::array<float, 3> apart2{};
    };

    std::int32_t nearest_at(int x, int y, int z) const { return nearest[finder.grey.index(x, y, z - first)]; }

    void offer(Candidates& found, const glm::vec3& at, int x, int y, int z) const {
        const std::int32_t id = nearest_at(x, y, std::clamp(z, first, end - 1));
        if (id == found.id[0] || id == found.id[1] || id == found.id[2]) return;
        const float d = apart2(at, id);
        for (std::size_t n = 0; n < 3; ++n)
            if (found.id[n] < 0 || d < found.apart2[n]) {
                for (std::size_t m = 2; m > n; --m)
                    found.id[m] = found.id[m - 1], found.apart2[m] = found.apart2[m - 1];
                found.id[n] = id, found.apart2[n] = d;
                return;
            }
    }

    void neighbours(Candidates& found, const glm::vec3& at, int i, int j, int k) const {
        const auto& size = finder.grey.size;
        if (i > 0) offer(found, at, i - 1, j, k);
        if (j > 0) offer(found, at, i, j - 1, k);
        if (k > 0) offer(found, at, i, j, k - 1);
        if (i + 1 < size[0]) offer(found, at, i + 1, j, k);
        if (j + 1 < size[1]) offer(found, at, i, j + 1, k);
        if (k + 1 < finder.layers) offer(found, at, i, j, k + 1);
    }

    void walk(Candidates& found, const glm::vec3& at) const {
        const auto& size = finder.grey.size;
        for (int step = 0; step < 3; ++step) {
            const std::int32_t before = found.id[0];
            const auto n = static_cast<std::size_t>(before);
            const glm::vec3 d = (at - points.at[n]) * finder.h;
            const glm::vec3 foot = at - points.normal[n] * glm::dot(d, points.normal[n]) / finder.h;
            offer(found, at, std::clamp(static_cast<int>(foot.x + 0.5f), 0, size[0] - 1),
                  std::clamp(static_cast<int>(foot.y + 0.5f), 0, size[1] - 1),
                  std::clamp(static_cast<int>(foot.z + 0.5f), 0, finder.layers - 1));
            if (found.id[0] == before) break;
        }
    }

    double exact(const glm::vec3& at, const Candidates& found) const {
        const auto place = [&](std::size_t n) { return points.at[static_cast<std::size_t>(found.id[n])]; };
        double least = finder.refined(Vec3(at), Vec3(place(0)));
        for (std::size_t n = 1; n < 3 && found.id[n] >= 0; ++n) {
            // A different part of the surface: not next to the first, and no farther than its cell's corners allow.
            const glm::vec3 between = (place(n) - place(0)) * finder.h;
            const auto aside = 1.0 * finder.widest;
            if (glm::length(between) > 1.5f * static_cast<float>(finder.widest) &&
                double(found.apart2[n]) < least * least + aside * aside)
                least = std::min(least, finder.refined(Vec3(at), Vec3(place(n))));
        }
        return least;
    }

    // All points that can count for a sample at this distance from the surface lie in the available layers: those below
    // its foot points are as far away again.
    bool is_sure(int k, double away) const {
        const double need = 2.0 * away + 6.0 * finder.widest, h = finder.grey.spacing.z;
        return (first == 0 || (k - first) * h >= need) && (end == finder.layers || (end - 1 - k) * h >= need);
    }

    // Distances of layer k; false when more layers around it are needed.
    bool layer(int k, float* out) const {
        const Grid& grid = finder.grey;
        for (int j = 0; j < grid.size[1]; ++j) {
            leave_if_stopped();
            for (int i = 0; i < grid.size[0]; ++i, ++out) {
                const glm::vec3 at(i, j, k);
                const bool inside = grid.at(i, j, k - finder.first) >= finder.iso;
                Candidates found;
                const bool has_point = nearest_at(i, j, k) >= 0;
                if (has_point) offer(found, at, i, j, k);
                const double away =
                    has_point ? std::sqrt(double(found.apart2[0])) : std::numeric_limits<double>::infinity();
                if (!inside && away >= reach + finder.widest) {
                    *out = static_cast<float>(reach);
                    continue;
                }
                if (!is_sure(k, away)) return false;
                if (!has_point) {
                    *out = inside ? -std::numeric_limits<float>::infinity() : static_cast<float>(reach);
                    continue;
                }
                if (found.apart2[0] < around2) neighbours(found, at, i, j, k);
                walk(found, at);
                float value = to_disc(at, found.id[0]);
                if (value < band)
                    if (const double d = exact(at, found); std::isfinite(d)) value = static_cast<float>(d);
                *out = inside ? -value : std::min(value, static_cast<float>(reach));
            }
        }
        return true;
    }
};

// The layers of a volume in memory, and the surface points found so far.
struct Slabs {
    const Grid& layout;
    float iso;
    const DistanceInLayers& how;
    const LayersOfGrey& source;
    const RunJobs& run;
    Grid held{};  // from layer `first` on
    int first = 0;
    std::vector<SurfacePoints> cells{};  // between each layer and the next
    double widest = std::max({layout.spacing.x, layout.spacing.y, layout.spacing.z});
    double cell = std::min({layout.spacing.x, layout.spacing.y, layout.spacing.z});

    int layers() const { return layout.size[2]; }
    int held_end() const { return first + held.size[2]; }
    SurfaceFinder finder() const { return {held, first, layers(), iso}; }

    // Margin for a sample in the band: range of the Newton steps from a nearby point, plus the cubic's support.
    int around() const { return static_cast<int>(std::ceil((10.0 * widest + 11.0 * cell) / layout.spacing.z)) + 3; }

    // Holds the layers from `from` up to `end`, with the points of all cells below `end` - 3.
    void hold(int from, int end) {
        from = std::max(from, first);
        end = std::min(end, layers());
        const std::size_t layer = layout.index(0, 0, 1);
        if (const int gone = std::min(from, held_end()) - first; gone > 0) {
            held.values.erase(held.values.begin(), held.values.begin() + static_cast<std::ptrdiff_t>(
                                                                             static_cast<std::size_t>(gone) * layer));
            held.size[2] -= gone;
            first += gone;
        }
        if (end <= held_end()) return;
        if (held.values.empty()) {
            held = source(held_end(), end - held_end());
            held.origin = layout.origin;
        } else {
            const Grid more = source(held_end(), end - held_end());
            held.values.insert(held.values.end(), more.values.begin(), more.values.end());
            held.size[2] += more.size[2];
        }
        find_points(held_end() == layers() ? layers() - 1 : held_end() - 3);
    }

    void find_points(int end) {
        const int begin = static_cast<int>(cells.size());
        if (end <= begin) return;
        cells.resize(static_cast<std::size_t>(end));
        const SurfaceFinder finder = this->finder();
        run(end - begin, [&](int n) {
            SurfacePoints& points = cells[static_cast<std::size_t>(begin + n)];
            finder.points_of_layer(begin + n, points);
            points.at.shrink_to_fit();
            points.normal.shrink_to_fit();
        });
    }

    // The points in the cells between the layers from `from` up to `end`.
    SurfacePoints points_between(int from, int end) const {
        SurfacePoints all;
        std::size_t count = 0;
        for (int k = from; k + 1 < end; ++k) count += cells[static_cast<std::size_t>(k)].at.size();
        all.at.reserve(count);
        all.normal.reserve(count);
        for (int k = from; k + 1 < end; ++k) {
            const SurfacePoints& points = cells[static_cast<std::size_t>(k)];
            all.at.insert(all.at.end(), points.at.begin(), points.at.end());
            all.normal.insert(all.normal.end(), points.normal.begin(), points.normal.end());
        }
        return all;
    }

    // Distances of the layers from k0 up to k1 with `beside` layers of points on both sides; false when these do not
    // suffice.
    bool distances(int k0, int k1, int beside, Grid& out) {
        const int from = std::max(0, k0 - beside), end = std::min(layers(), k1 + beside);
        hold(k0 - around(), std::max(end + 3, k1 + around()));
        const SurfacePoints points = points_between(from, end);
        Grid window{{layout.size[0], layout.size[1], end - from}, layout.origin, layout.spacing, {}};
        const std::vector<std::int32_t> nearest = geometry::nearest_points(window, points.at, run, from);
        const SurfaceFinder finder = this->finder();
        const Field field{finder, points, nearest, from, end, how.reach};
        std::vector<char> sure(static_cast<std::size_t>(k1 - k0));
        run(k1 - k0,
            [&](int n) { sure[static_cast<std::size_t>(n)] = field.layer(k0 + n, &out.values[out.index(0, 0, n)]); });
        return std::find(sure.begin(), sure.end(), 0) == sure.end();
    }
};

}  // namespace

void distance_to_iso(const Grid& layout, float iso, const DistanceInLayers& how, const LayersOfGrey& grey,
                     const TakeLayers& take, const RunJobs& run) {
    Slabs slabs{layout, iso, how, grey, run};
    const int layers = layout.size[2], at_once = how.at_once > 0 ? how.at_once : layers;
    int beside = layers;
    if (std::isfinite(how.reach))
        beside =
            std::min(layers, static_cast<int>(std::ceil((2.0 * how.reach + 8.0 * slabs.widest) / layout.spacing.z)));
    for (int k = 0; k < layers; k += at_once) {
        const int end = std::min(k + at_once, layers);
        Grid out{{layout.size[0], layout.size[1], end - k}, layout.position(0, 0, k), layout.spacing, {}};
        out.values.resize(out.count());
        while (!slabs.distances(k, end, beside, out)) beside = std::min(layers, 2 * beside);
        take(k, out);
    }
}

Grid distance_to_iso(const Grid& grey, float iso, const RunJobs& run) {
    Grid out;
    distance_to_iso(
        grey, iso, {}, [&grey](int, int) { return grey; }, [&out](int, const Grid& distance) { out = distance; }, run);
    out.origin = grey.origin;
    return out;
}

}  // namespace tactus::volume
