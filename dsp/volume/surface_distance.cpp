// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/surface_distance.hpp"

#include "dsp/core/large_pages.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/geometry/closest_point.hpp"
#include "dsp/geometry/nearest_points.hpp"
#include "dsp/volume/surface_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace tactus::volume {

namespace {

constexpr int part_length = 16;  // samples of a row that are skipped together; even
constexpr double exact_band = 1.5;  // of the widest cells

double widest_of(const Grid& layout) { return std::max({layout.spacing.x, layout.spacing.y, layout.spacing.z}); }

// Per sample: the nearest triangle so far and its closest point. Stored together, because neighbours read both.
struct Foot {
    std::int32_t triangle = -1;
    glm::vec3 at{0.0f};  // m from the layout's origin
};

struct Feet {
    const Grid& layout;
    const geometry::TriangleSurface& surface;
    std::vector<Foot> foot = large_vector(layout.count(), Foot{});
    std::vector<float> apart2 = large_vector(layout.count(), std::numeric_limits<float>::infinity());  // m²

    bool offer(std::size_t sample, const Vec3& p, std::int32_t candidate, const std::array<Vec3, 3>& corners) {
        const Vec3 closest = geometry::closest_on_triangle(p, corners[0], corners[1], corners[2]), d = closest - p;
        const auto far2 = static_cast<float>(glm::dot(d, d));
        if (!(far2 < apart2[sample])) return false;
        apart2[sample] = far2;
        foot[sample] = {candidate, glm::vec3(closest - layout.origin)};
        return true;
    }
    bool offer(std::size_t sample, const Vec3& p, std::int32_t candidate) {
        return offer(sample, p, candidate, corners_of(surface, candidate));
    }
};

// Calls offer(sample, position, triangle, corners) for every triangle and the samples of a layer within its reach.
template <class Offer>
void offer_near(const Grid& layout, const geometry::TriangleSurface& surface, const TriangleLayers& near, double reach,
                int k, const Offer& offer) {
    for (const std::int32_t triangle : near[k]) {
        const auto corners = corners_of(surface, triangle);
        const IndexBox box = samples_near(layout, corners, reach);
        const Vec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double twice_area = glm::length(across);
        const PlaneRow plane{corners[0], twice_area > 0.0 ? across / twice_area : Vec3(0.0), reach};
        for (int j = box.low[1]; j <= box.high[1]; ++j) {
            int first = box.low[0], last = box.high[0];
            plane.narrow(layout, Vec3(0.0), j, k, first, last);
            for (int i = first; i <= last; ++i)
                offer(layout.index(i, j, k), layout.position(i, j, k), triangle, corners);
        }
    }
}

// Samples beyond the band of exact distances.
struct Far {
    Feet& feet;
    const SurfaceCells& cells;
    const std::vector<std::int32_t>& nearest;  // cell per sample
    float band2, close2;  // m², of the exact band and of the range of the exact search
    float cell2;                               // m², of two cells

    // Initial guess: the triangles of the cell with the nearest point; farther away only that point's triangle.
    void guess(int k) const {
        const Grid& layout = feet.layout;
        for (int j = 0; j < layout.size[1]; ++j)
            for (int i = 0; i < layout.size[0]; ++i) {
                const std::size_t sample = layout.index(i, j, k);
                if (feet.apart2[sample] <= band2) continue;
                const Vec3 p = layout.position(i, j, k);
                const auto cell = static_cast<std::size_t>(nearest[sample]);
                for (std::size_t n = cells.start[cell]; n < cells.start[cell + 1]; ++n) {
                    feet.offer(sample, p, cells.triangle[n]);
                    if (feet.apart2[sample] > close2) break;
                }
            }
    }

    // Propagates from the six neighbours of every second sample of a part of a row (one colour of a chessboard): the
    // neighbours have the other colour, so that all parts can be processed in parallel. Returns whether any distance
    // decreased.
    bool ask_neighbours(int part, int j, int k, int colour, bool closely) const {
        const Grid& layout = feet.layout;
        const auto& size = layout.size;
        const std::array<std::ptrdiff_t, 3> stride{1, size[0], static_cast<std::ptrdiff_t>(layout.index(0, 0, 1))};
        bool changed = false;
        const int end = std::min(size[0], (part + 1) * part_length);
        for (int i = part * part_length + ((j + k + colour) & 1); i < end; i += 2) {
            const std::size_t sample = layout.index(i, j, k);
            float own = feet.apart2[sample];
            if (own <= band2) continue;
            const std::array<int, 3> place{i, j, k};
            const glm::vec3 here(layout.position(i, j, k) - layout.origin);
            for (std::size_t a = 0; a < 3; ++a)
                for (const int step : {-1, 1}) {
                    if (place[a] + step < 0 || place[a] + step >= size[a]) continue;
                    const auto other = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(sample) + step * stride[a]);
                    const Foot& there = feet.foot[other];
                    if (there.triangle == feet.foot[sample].triangle) continue;
                    const glm::vec3 d = there.at - here;
                    // Close to the surface another triangle may be nearer, although its point for the neighbour is not.
                    const float wanted = closely && own < close2 ? own + cell2 : own * 0.9998f;
                    if (!(glm::dot(d, d) < wanted)) continue;
                    changed |= feet.offer(sample, layout.position(i, j, k), there.triangle);
                    own = feet.apart2[sample];
                }
        }
        return changed;
    }
};

// Until no distance decreases; skips parts of rows without changes in or beside them, and layers without such parts: in
// nine of ten rounds only some thousandths of a grid still change.
void settle(const Far& far, const RunJobs& run) {
    constexpr int max_rounds = 60;
    const auto& size = far.feet.layout.size;
    const int parts = (size[0] + part_length - 1) / part_length, rows = size[1], layers = size[2];
    const auto at = [parts, rows](int part, int j, int k) {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(parts) +
               static_cast<std::size_t>(part);
    };
    std::vector<char> active(at(0, 0, layers), 1), changed(active.size());
    std::vector<char> is_active(static_cast<std::size_t>(layers), 1), has_changed(is_active.size());  // per layer
    const auto of = [](std::vector<char>& flags, int k) -> char& { return flags[static_cast<std::size_t>(k)]; };
    for (int round = 0; round < max_rounds; ++round) {
        for (int k = 0; k < layers; ++k) {
            if (of(has_changed, k))
                std::fill_n(changed.begin() + static_cast<std::ptrdiff_t>(at(0, 0, k)), at(0, 0, 1), char{0});
            of(has_changed, k) = 0;
        }
        for (const int colour : {0, 1})
            run(layers, [&](int k) {
                if (!of(is_active, k)) return;
                for (int j = 0; j < rows; ++j)
                    for (int part = 0; part < parts; ++part)
                        if (active[at(part, j, k)] && far.ask_neighbours(part, j, k, colour, round == 0))
                            changed[at(part, j, k)] = of(has_changed, k) = 1;
            });
        run(layers, [&](int k) {
            const bool is_beside =
                of(has_changed, k) || (k > 0 && of(has_changed, k - 1)) || (k + 1 < layers && of(has_changed, k + 1));
            if (!is_beside && !of(is_active, k)) return;
            char any = 0;
            for (int j = 0; j < rows; ++j)
                for (int part = 0; part < parts; ++part)
                    any |= active[at(part, j, k)] =
                        changed[at(part, j, k)] || (part > 0 && changed[at(part - 1, j, k)]) ||
                        (part + 1 < parts && changed[at(part + 1, j, k)]) || (j > 0 && changed[at(part, j - 1, k)]) ||
                        (j + 1 < rows && changed[at(part, j + 1, k)]) || (k > 0 && changed[at(part, j, k - 1)]) ||
                        (k + 1 < layers && changed[at(part, j, k + 1)]);
            of(is_active, k) = any;
        });
        if (std::find(is_active.begin(), is_active.end(), 1) == is_active.end()) return;
    }
}

/// Exact within 1.5 of the widest cells; farther away by propagation.
Feet nearest_feet(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run) {
    Feet feet{layout, surface};
    const double widest = widest_of(layout), reach = exact_band * widest;
    const TriangleLayers near(layout, surface, reach);
    run(layout.size[2], [&](int k) {
        offer_near(layout, surface, near, reach, k,
                   [&feet](std::size_t sample, const Vec3& p, std::int32_t triangle, const auto& corners) {
                       feet.offer(sample, p, triangle, corners);
                   });
    });
    if (const SurfaceCells cells = surface_cells(layout, surface, run); !cells.at.empty()) {
        const std::vector<std::int32_t> nearest = geometry::nearest_points(layout, cells.at, run);
        const Far far{feet,
                      cells,
                      nearest,
                      static_cast<float>(reach * reach),
                      static_cast<float>(64.0 * widest * widest),
                      static_cast<float>(4.0 * widest * widest)};
        run(layout.size[2], [&](int k) { far.guess(k); });
        settle(far, run);
    }
    return feet;
}

double mean_edge(const geometry::TriangleSurface& surface) {
    double sum = 0.0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(surface.triangles.size()); ++t) {
        const auto corners = corners_of(surface, t);
        for (std::size_t c = 0; c < 3; ++c) sum += glm::length(corners[(c + 1) % 3] - corners[c]);
    }
    return sum / (3.0 * static_cast<double>(std::max<std::size_t>(surface.triangles.size(), 1)));
}

/// Every second sample of a layout, and one beyond its last where that is not among them.
Grid half_of(const Grid& layout) {
    Grid half{{}, layout.origin, 2.0 * layout.spacing, {}};
    for (std::size_t a = 0; a < 3; ++a) half.size[a] = layout.size[a] / 2 + 1;
    return half;
}

using Lanes = float __attribute__((vector_size(16)));  // of samples of a row

/// A triangle in single precision, for distances of several samples at a time. m from an origin.
struct FlatTriangle {
    glm::vec3 a, ab, ac;
    float g11, g12, g22;
    float inverse;  // of the determinant; no number for a triangle without area, which is treated as its edges
    float inverse_ab, inverse_ac, inverse_bc;  // of squared lengths, 0 for edges without length

    FlatTriangle(const std::array<Vec3, 3>& corners, const Vec3& origin) {
        const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
        const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), det = uu * vv - uv * uv;
        const double ww = glm::dot(v - u, v - u);
        const auto inverse_of = [](double x) { return x > 0.0 ? static_cast<float>(1.0 / x) : 0.0f; };
        a = glm::vec3(corners[0] - origin), ab = glm::vec3(u), ac = glm::vec3(v);
        g11 = static_cast<float>(uu), g12 = static_cast<float>(uv), g22 = static_cast<float>(vv);
        inverse = det > 1e-12 * uu * vv ? static_cast<float>(1.0 / det) : std::numeric_limits<float>::quiet_NaN();
        inverse_ab = inverse_of(uu), inverse_ac = inverse_of(vv), inverse_bc = inverse_of(ww);
    }

    Lanes distance2(const Lanes& x, float y, float z) const {
        const Lanes px = x - a.x;
        const float py = y - a.y, pz = z - a.z;
        const Lanes r1 = px * ab.x + (py * ab.y + pz * ab.z), r2 = px * ac.x + (py * ac.y + pz * ac.z);
        const auto at = [&](const Lanes& u, const Lanes& v) {
            const Lanes dx = px - u * ab.x - v * ac.x, dy = py - u * ab.y - v * ac.y, dz = pz - u * ab.z - v * ac.z;
            return dx * dx + dy * dy + dz * dz;
        };
        const auto within = [](const Lanes& t) {
            const Lanes low = t > 0.0f ? t : Lanes{};
            return low < 1.0f ? low : Lanes{} + 1.0f;
        };
        const auto least = [](const Lanes& m, const Lanes& n) { return m < n ? m : n; };
        const Lanes w = within((r2 - r1 - g12 + g11) * inverse_bc);
        const Lanes edges =
            least(least(at(within(r1 * inverse_ab), Lanes{}), at(Lanes{}, within(r2 * inverse_ac))), at(1.0f - w, w));
        const Lanes u = (g22 * r1 - g12 * r2) * inverse, v = (g11 * r2 - g12 * r1) * inverse;
        return (u >= 0.0f) & (v >= 0.0f) & (u + v <= 1.0f) ? at(u, v) : edges;
    }
};

/// Distances of samples by the triangles nearest to the coarse samples around each. A triangle may be the nearest to a
/// sample between opposite sides of a body and to none of the coarse samples beside it: those one step farther are
/// included, too.
struct Between {
    static constexpr int lanes = sizeof(Lanes) / sizeof(float), vectors = 2;
    static constexpr int length = lanes * vectors;  // samples of a row that are processed together
    /// Rows of coarse samples around a sample: two beside an odd one, three around an even one; so of samples in a row.
    using Found = std::array<std::int32_t, 9 * (length / 2 + 2)>;

    const Grid& layout;
    const Grid& coarse;
    const std::vector<FlatTriangle>& triangles;
    const std::vector<Foot>& foot;  // per coarse sample
    float band2;  // m², of the exact band

    /// The triangles nearest to the coarse samples around a part of a row, without repetition; returns their number.
    std::size_t around(int first, int j, int k, Found& found) const {
        const auto low = [](int n) { return std::max(n - 1, 0) / 2; };
        const auto high = [this](int n, std::size_t axis) { return std::min((n + 2) / 2, coarse.size[axis] - 1); };
        const int last = std::min(first + length, layout.size[0]) - 1;
        std::size_t count = 0;
        for (int z = low(k); z <= high(k, 2); ++z)
            for (int y = low(j); y <= high(j, 1); ++y) {
                std::int32_t before = -1;
                for (int x = low(first); x <= high(last, 0); ++x) {
                    const std::int32_t triangle = foot[coarse.index(x, y, z)].triangle;
                    if (triangle == before) continue;
                    before = triangle;
                    const auto known = found.begin() + static_cast<std::ptrdiff_t>(count);
                    if (triangle >= 0 && std::find(found.begin(), known, triangle) == known) found[count++] = triangle;
                }
            }
        return count;
    }

    void fill(int k, std::vector<float>& distance2) const {
        Found found{};
        const auto z = static_cast<float>(k * layout.spacing.z);
        for (int j = 0; j < layout.size[1]; ++j) {
            const auto y = static_cast<float>(j * layout.spacing.y);
            for (int first = 0; first < layout.size[0]; first += length) {
                const int count = std::min(length, layout.size[0] - first);
                float* const own = &distance2[layout.index(first, j, k)];
                if (std::all_of(own, own + count, [this](float d2) { return d2 <= band2; })) continue;
                std::array<Lanes, vectors> x{}, least{};
                for (int n = 0; n < length; ++n) {
                    x[static_cast<std::size_t>(n / lanes)][n % lanes] =
                        static_cast<float>((first + n) * layout.spacing.x);
                    least[static_cast<std::size_t>(n / lanes)][n % lanes] = std::numeric_limits<float>::infinity();
                }
                const std::size_t candidates = around(first, j, k, found);
                for (std::size_t c = 0; c < candidates; ++c) {
                    const FlatTriangle& triangle = triangles[static_cast<std::size_t>(found[c])];
                    for (std::size_t v = 0; v < vectors; ++v) {
                        const Lanes d2 = triangle.distance2(x[v], y, z);
                        least[v] = d2 < least[v] ? d2 : least[v];
                    }
                }
                for (int n = 0; n < count; ++n)
                    if (own[n] > band2)
                        own[n] = std::min(own[n], least[static_cast<std::size_t>(n / lanes)][n % lanes]);
            }
        }
    }
};

/// For triangles larger than two samples: the nearest triangles of every second sample are those of all samples beside
/// it. A third of the time, and a quarter of the memory.
std::vector<float> distance2_of_large(const Grid& layout, const geometry::TriangleSurface& surface,
                                      const RunJobs& run) {
    std::vector<float> distance2 = large_vector(layout.count(), std::numeric_limits<float>::infinity());
    // Near the surface the nearest triangle changes within a sample.
    const double reach = 2.0 * exact_band * widest_of(layout);
    const TriangleLayers near(layout, surface, reach);
    run(layout.size[2], [&](int k) {
        offer_near(layout, surface, near, reach, k,
                   [&distance2](std::size_t sample, const Vec3& p, std::int32_t, const std::array<Vec3, 3>& corners) {
                       const Vec3 d = geometry::closest_on_triangle(p, corners[0], corners[1], corners[2]) - p;
                       distance2[sample] = std::min(distance2[sample], static_cast<float>(glm::dot(d, d)));
                   });
    });
    std::vector<FlatTriangle> triangles;
    triangles.reserve(surface.triangles.size());
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(surface.triangles.size()); ++t)
        triangles.emplace_back(corners_of(surface, t), layout.origin);
    const Grid coarse = half_of(layout);
    const Feet feet = nearest_feet(coarse, surface, run);
    const Between between{layout, coarse, triangles, feet.foot, static_cast<float>(reach * reach)};
    run(layout.size[2], [&](int k) { between.fill(k, distance2); });
    return distance2;
}

// Side of the projected edge a → b on which the origin lies: ±1, and exactly opposite for b → a. Simulation of
// simplicity: the origin is shifted by (ε², ε) when it is on the edge; 0 only when the ends coincide.
int side(double ay, double az, double by, double bz) {
    const double area = ay * bz - az * by;
    if (area != 0.0) return area > 0.0 ? 1 : -1;
    if (ay != by) return ay < by ? -1 : 1;
    if (az != bz) return az < bz ? 1 : -1;
    return 0;
}

// Marks the sample in row (j, k) of a layer from which on a triangle has been crossed along x.
void cross(const Grid& layout, const std::array<Vec3, 3>& corner, int j, int k, std::span<std::int16_t> crossings) {
    const Vec3 ray = layout.position(0, j, k);
    std::array<double, 3> y{}, z{};
    for (std::size_t c = 0; c < 3; ++c) y[c] = corner[c].y - ray.y, z[c] = corner[c].z - ray.z;
    const int s0 = side(y[1], z[1], y[2], z[2]), s1 = side(y[2], z[2], y[0], z[0]);
    const int s2 = side(y[0], z[0], y[1], z[1]);
    if (s0 == 0 || s0 != s1 || s1 != s2) return;
    const double w0 = y[1] * z[2] - z[1] * y[2], w1 = y[2] * z[0] - z[2] * y[0];
    const double w2 = y[0] * z[1] - z[0] * y[1], sum = w0 + w1 + w2;
    if (sum == 0.0) return;
    const double x = (w0 * corner[0].x + w1 * corner[1].x + w2 * corner[2].x) / sum;
    const double first = std::ceil((x - layout.origin.x) / layout.spacing.x);
    if (first >= layout.size[0]) return;
    // Entering through a triangle that faces -x (negative area in y, z) counts +1.
    std::int16_t& count = crossings[layout.index(first < 0.0 ? 0 : static_cast<int>(first), j, 0)];
    count = static_cast<std::int16_t>(count - s0);
}

// Winding numbers of layer k; they are 0 before.
void wind(const Grid& layout, const geometry::TriangleSurface& surface, const TriangleLayers& near, int k,
          std::span<std::int16_t> winding) {
    for (const std::int32_t triangle : near[k]) {
        const auto corners = corners_of(surface, triangle);
        const IndexBox box = samples_near(layout, corners, 0.5 * layout.spacing.y);
        for (int j = box.low[1]; j <= box.high[1]; ++j) cross(layout, corners, j, k, winding);
    }
    for (int j = 0; j < layout.size[1]; ++j)
        for (int i = 1; i < layout.size[0]; ++i) {
            std::int16_t& here = winding[layout.index(i, j, 0)];
            here = static_cast<std::int16_t>(here + winding[layout.index(i - 1, j, 0)]);
        }
}

void turn_inside(Grid& distance, const geometry::TriangleSurface& surface, const RunJobs& run) {
    const TriangleLayers near(distance, surface, 0.5 * widest_of(distance));
    const std::size_t layer = distance.index(0, 0, 1);
    run(distance.size[2], [&](int k) {
        std::vector<std::int16_t> winding(layer, 0);
        wind(distance, surface, near, k, winding);
        float* const values = &distance.values[distance.index(0, 0, k)];
        for (std::size_t n = 0; n < layer; ++n)
            if (winding[n] != 0) values[n] = -values[n];
    });
}

}  // namespace

std::vector<float> surface_distance(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run) {
    const bool is_large = mean_edge(surface) > 2.0 * widest_of(layout);
    std::vector<float> distance =
        is_large ? distance2_of_large(layout, surface, run) : std::move(nearest_feet(layout, surface, run).apart2);
    run(layout.size[2], [&](int k) {
        const std::size_t first = layout.index(0, 0, k), end = layout.index(0, 0, k + 1);
        for (std::size_t n = first; n < end; ++n) distance[n] = std::sqrt(distance[n]);
    });
    return distance;
}

std::vector<std::int16_t> winding_numbers(const Grid& layout, const geometry::TriangleSurface& surface,
                                          const RunJobs& run) {
    std::vector<std::int16_t> winding = large_vector(layout.count(), std::int16_t{0});
    const TriangleLayers near(layout, surface, 0.5 * widest_of(layout));
    run(layout.size[2], [&](int k) {
        wind(layout, surface, near, k, std::span(winding).subspan(layout.index(0, 0, k), layout.index(0, 0, 1)));
    });
    return winding;
}

Grid signed_distance(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run) {
    Grid grid{layout.size, layout.origin, layout.spacing, surface_distance(layout, surface, run)};
    turn_inside(grid, surface, run);
    return grid;
}

Grid signed_distance_near(const Grid& layout, const geometry::TriangleSurface& surface, double reach,
                          const RunJobs& run) {
    const auto most2 = static_cast<float>(reach * reach);
    Grid grid{layout.size, layout.origin, layout.spacing, large_vector(layout.count(), most2)};
    const TriangleLayers near(layout, surface, reach);
    run(layout.size[2], [&](int k) {
        offer_near(layout, surface, near, reach, k,
                   [&grid](std::size_t sample, const Vec3& p, std::int32_t, const std::array<Vec3, 3>& corners) {
                       const Vec3 d = geometry::closest_on_triangle(p, corners[0], corners[1], corners[2]) - p;
                       grid.values[sample] = std::min(grid.values[sample], static_cast<float>(glm::dot(d, d)));
                   });
        for (std::size_t n = layout.index(0, 0, k); n < layout.index(0, 0, k + 1); ++n)
            grid.values[n] = std::sqrt(grid.values[n]);
    });
    turn_inside(grid, surface, run);
    return grid;
}

}  // namespace tactus::volume
