// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/iso_distance.hpp"

#include "dsp/distance/cubic_interpolant.hpp"
#include "dsp/distance/nearest_points.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tactus {

namespace {

// Points of the surface, about one per cell that it crosses, with normals.
struct Points {
    std::vector<glm::vec3> at;      // samples from the origin
    std::vector<glm::vec3> normal;  // unit length in m, towards lower values
};

// A step along the gradient onto the surface, m, at most `reach` long so that a flat spot throws nothing away.
Vec3 onto_surface(const CubicInterpolant::Sample& f, double iso, double reach) {
    const double steep = glm::dot(f.gradient, f.gradient);
    if (!(steep > 0.0)) return Vec3(0.0);
    const Vec3 step = f.gradient * ((iso - f.value) / steep);
    const double length = glm::length(step);
    return length > reach ? step * (reach / length) : step;
}

struct Finder {
    const Grid& grey;
    float iso;
    CubicInterpolant f{grey};
    double cell = std::min({grey.spacing.x, grey.spacing.y, grey.spacing.z});
    double widest = std::max({grey.spacing.x, grey.spacing.y, grey.spacing.z});
    glm::vec3 h{grey.spacing};

    // The mean of the places where the cell's edges cross iso, moved onto the surface.
    std::optional<Vec3> point_in_cell(int i, int j, int k, const std::array<float, 8>& value) const {
        Vec3 sum(0.0);
        int count = 0;
        for (int from = 0; from < 8; ++from)
            for (int bit = 1; bit < 8; bit <<= 1) {
                if (from & bit) continue;
                const float a = value[static_cast<std::size_t>(from)], b = value[static_cast<std::size_t>(from | bit)];
                if ((a >= iso) == (b >= iso)) continue;
                const double t = (double(iso) - double(a)) / (double(b) - double(a));
                Vec3 at(from & 1, from >> 1 & 1, from >> 2);
                at[bit >> 1] += t;
                sum += at;
                ++count;
            }
        if (count == 0) return {};
        const Vec3 corner(i, j, k);
        Vec3 at = corner + sum / double(count);
        for (int step = 0; step < 2; ++step) at += onto_surface(f(at), iso, 0.5 * cell) / grey.spacing;
        return glm::clamp(at, corner, corner + 1.0);
    }

    void points_of_layer(int k, Points& points) const {
        const auto width = static_cast<std::size_t>(grey.size[0]), layer = grey.index(0, 0, 1);
        for (int j = 0; j + 1 < grey.size[1]; ++j) {
            const float* row = &grey.values[grey.index(0, j, k)];
            for (int i = 0; i + 1 < grey.size[0]; ++i, ++row) {
                const std::array<float, 8> value{
                    row[0],     row[1],         row[width],         row[width + 1],
                    row[layer], row[layer + 1], row[layer + width], row[layer + width + 1]};
                int above = 0;
                for (const float v : value) above += v >= iso;
                if (above == 0 || above == 8) continue;
                const auto at = point_in_cell(i, j, k, value);
                const Vec3 slope = f(*at).gradient;
                const double length = glm::length(slope);
                points.at.push_back(glm::vec3(*at));
                points.normal.push_back(glm::vec3(length > 0.0 ? -slope / length : Vec3(0.0)));
            }
        }
    }

    Points all_points(const RunJobs& run) const {
        std::vector<Points> layers(static_cast<std::size_t>(std::max(grey.size[2] - 1, 0)));
        run(static_cast<int>(layers.size()), [&](int k) { points_of_layer(k, layers[static_cast<std::size_t>(k)]); });
        Points all;
        for (const Points& layer : layers) {
            all.at.insert(all.at.end(), layer.at.begin(), layer.at.end());
            all.normal.insert(all.normal.end(), layer.normal.begin(), layer.normal.end());
        }
        return all;
    }

    // Distance to the point of the surface nearest to `at`, from a near guess: steps onto the surface, and along it
    // towards `at`, as long as the curvature seen so far asks for. Infinite when no point of the surface was met.
    double refined(const Vec3& at, const Vec3& guess) const {
        Vec3 x = guess, moved(0.0), before(0.0);
        double best = std::numeric_limits<double>::infinity(), stretch = 1.0;
        for (int step = 0; step < 10; ++step) {
            const auto here = f(x);
            const double steep = glm::dot(here.gradient, here.gradient);
            if (!(steep > 0.0)) break;
            const Vec3 towards = (at - x) * grey.spacing;
            const Vec3 along = towards - here.gradient * (glm::dot(towards, here.gradient) / steep);
            const double off = std::abs(here.value - double(iso)) / std::sqrt(steep), aside = glm::length(along);
            const double far = glm::length(towards);
            if (off < 2e-3 * cell) {
                best = std::min(best, far);
                // Straight below `at`: what is left aside lengthens by its square only.
                if (aside < 0.04 * far || aside < 2e-3 * cell) break;
            }
            // On a convex surface a full step overshoots, in a hollow it falls short.
            if (const double length2 = glm::dot(moved, moved); length2 > 0.0)
                stretch = std::clamp(length2 / std::max(glm::dot(before - along, moved), 1e-9 * length2), 0.2, 2.0);
            moved = along * std::min(stretch, 0.6 * cell / std::max(aside, 1e-30));
            before = along;
            x += (onto_surface(here, iso, 0.5 * cell) + moved) / grey.spacing;
        }
        return best;
    }
};

struct Field {
    const Finder& finder;
    const Points& points;
    const std::vector<std::int32_t>& nearest;
    float band = static_cast<float>(3.0 * finder.widest);
    float around2 =
        (band + 1.5f * static_cast<float>(finder.widest)) * (band + 1.5f * static_cast<float>(finder.widest));

    float apart2(const glm::vec3& at, std::int32_t id) const {
        const glm::vec3 d = (points.at[static_cast<std::size_t>(id)] - at) * finder.h;
        return glm::dot(d, d);
    }

    // To the disc of half a cell's diagonal around a point, along its tangent plane.
    float to_disc(const glm::vec3& at, std::int32_t id) const {
        const glm::vec3 d = (at - points.at[static_cast<std::size_t>(id)]) * finder.h;
        const float up = glm::dot(d, points.normal[static_cast<std::size_t>(id)]);
        const float aside = std::sqrt(std::max(0.0f, glm::dot(d, d) - up * up));
        const float over = std::max(0.0f, aside - 0.7f * static_cast<float>(finder.cell));
        return std::sqrt(up * up + over * over);
    }

    // Points that may be nearest, the nearest first: what the sample, its neighbours and the places below it on the
    // surface know.
    struct Candidates {
        std::array<std::int32_t, 3> id{-1, -1, -1};
        std::array<float, 3> apart2{};
    };

    void offer(Candidates& found, const glm::vec3& at, int x, int y, int z) const {
        const std::int32_t id = nearest[finder.grey.index(x, y, z)];
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

    Candidates candidates(int i, int j, int k) const {
        const glm::vec3 at(i, j, k);
        Candidates found;
        offer(found, at, i, j, k);
        if (found.apart2[0] < around2) neighbours(found, at, i, j, k);
        walk(found, at);
        return found;
    }

    void neighbours(Candidates& found, const glm::vec3& at, int i, int j, int k) const {
        const auto& size = finder.grey.size;
        if (i > 0) offer(found, at, i - 1, j, k);
        if (j > 0) offer(found, at, i, j - 1, k);
        if (k > 0) offer(found, at, i, j, k - 1);
        if (i + 1 < size[0]) offer(found, at, i + 1, j, k);
        if (j + 1 < size[1]) offer(found, at, i, j + 1, k);
        if (k + 1 < size[2]) offer(found, at, i, j, k + 1);
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
                  std::clamp(static_cast<int>(foot.z + 0.5f), 0, size[2] - 1));
            if (found.id[0] == before) break;
        }
    }

    double exact(const glm::vec3& at, const Candidates& found) const {
        const auto place = [&](std::size_t n) { return points.at[static_cast<std::size_t>(found.id[n])]; };
        double least = finder.refined(Vec3(at), Vec3(place(0)));
        for (std::size_t n = 1; n < 3 && found.id[n] >= 0; ++n) {
            // Another part of the surface: not beside the first, and no farther than its cell's corners allow.
            const glm::vec3 between = (place(n) - place(0)) * finder.h;
            const auto aside = 1.0 * finder.widest;
            if (glm::length(between) > 1.5f * static_cast<float>(finder.widest) &&
                double(found.apart2[n]) < least * least + aside * aside)
                least = std::min(least, finder.refined(Vec3(at), Vec3(place(n))));
        }
        return least;
    }

    void layer(int k, Grid& out) const {
        const Grid& grid = finder.grey;
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const glm::vec3 at(i, j, k);
                const Candidates found = candidates(i, j, k);
                float value = to_disc(at, found.id[0]);
                if (value < band)
                    if (const double d = exact(at, found); std::isfinite(d)) value = static_cast<float>(d);
                out.at(i, j, k) = grid.at(i, j, k) >= finder.iso ? -value : value;
            }
    }
};

// The weights over three rows, in place; `before` is what stood in the row before, and becomes what stood in this one.
void smooth_row(float* row, const float* after, std::vector<float>& before) {
    for (std::size_t i = 0; i < before.size(); ++i) {
        const float here = row[i];
        row[i] = (before[i] + 4.0f * here + (after ? after[i] : here)) / 6.0f;
        before[i] = here;
    }
}

// Along x and y.
void smooth_layer(Grid& grid, int k) {
    const int width = grid.size[0], rows = grid.size[1];
    for (int j = 0; j < rows; ++j) {
        float* row = &grid.values[grid.index(0, j, k)];
        float before = row[0];
        for (int i = 0; i < width; ++i) {
            const float here = row[i];
            row[i] = (before + 4.0f * here + row[std::min(i + 1, width - 1)]) / 6.0f;
            before = here;
        }
    }
    float* row = &grid.values[grid.index(0, 0, k)];
    std::vector<float> before(row, row + width);
    for (int j = 0; j < rows; ++j, row += width) smooth_row(row, j + 1 < rows ? row + width : nullptr, before);
}

// Along z.
void smooth_wall(Grid& grid, int j) {
    const float* first = &grid.values[grid.index(0, j, 0)];
    std::vector<float> before(first, first + grid.size[0]);
    for (int k = 0; k < grid.size[2]; ++k)
        smooth_row(&grid.values[grid.index(0, j, k)],
                   k + 1 < grid.size[2] ? &grid.values[grid.index(0, j, k + 1)] : nullptr, before);
}

}  // namespace

Grid smoothed(Grid grid, const RunJobs& run) {
    if (grid.values.empty()) return grid;
    run(grid.size[2], [&](int k) { smooth_layer(grid, k); });
    run(grid.size[1], [&](int j) { smooth_wall(grid, j); });
    return grid;
}

Grid distance_to_iso(const Grid& grey, float iso, const RunJobs& run) {
    const Finder finder{grey, iso};
    const Points points = finder.all_points(run);
    Grid out{grey.size, grey.origin, grey.spacing, {}};
    if (points.at.empty()) {
        const bool inside = !grey.values.empty() && grey.values.front() >= iso;
        out.values.assign(grey.count(), std::numeric_limits<float>::infinity() * (inside ? -1.0f : 1.0f));
        return out;
    }
    out.values.resize(grey.count());
    const std::vector<std::int32_t> nearest = nearest_points(grey, points.at, run);
    const Field field{finder, points, nearest};
    run(grey.size[2], [&](int k) { field.layer(k, out); });
    return out;
}

}  // namespace tactus
