// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/dual_contour.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/geometry/cell_sheets.hpp"
#include "dsp/geometry/self_intersection.hpp"
#include "dsp/geometry/surface_net.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tactus::geometry {

namespace {

constexpr int block = 8;  // samples along the side of a block that is classified by its middle
constexpr double truncated = 0.01;  // of eigenvalues: singular values below 0.1 of the largest
constexpr double outside = 0.45;  // of a cell: how far a vertex may lie beside it
constexpr double rim = 0.02;  // of a cell: vertices keep it from the faces, so that those of two cells do not coincide

/// Tangent planes as a quadratic form about their mean: distances squared are x'mx - 2 right'x and a constant.
struct Planes {
    std::array<double, 9> m{};
    Vec3 right{0.0};

    double error(const Vec3& x) const {
        double sum = -2.0 * glm::dot(right, x);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) sum += x[i] * m[static_cast<std::size_t>(3 * i + j)] * x[j];
        return sum;
    }
    /// The least along the axes that are free from `start`, of least length where the planes do not decide.
    Vec3 nearest(const Vec3& start, const std::array<bool, 3>& is_free) const {
        std::array<double, 9> part{};
        Vec3 to(0.0);
        for (std::size_t i = 0; i < 3; ++i) {
            if (!is_free[i]) continue;
            const int n = static_cast<int>(i);
            to[n] = right[n];
            for (std::size_t j = 0; j < 3; ++j) {
                to[n] -= m[3 * i + j] * start[static_cast<int>(j)];
                if (is_free[j]) part[3 * i + j] = m[3 * i + j];
            }
        }
        const SymmetricEigen<3> eigen = symmetric_eigen<3>(part);
        Vec3 found = start;
        for (std::size_t n = 0; n < 3; ++n) {
            if (!(eigen.value[n] > truncated * eigen.value[2])) continue;
            const Vec3 axis(eigen.vector[n][0], eigen.vector[n][1], eigen.vector[n][2]);
            found += axis * (glm::dot(axis, to) / eigen.value[n]);
        }
        return found;
    }
};

class DualContour {
public:
    DualContour(const volume::Grid& layout, const ImplicitSolid& solid, const RunJobs& run)
        : solid_(solid), run_(run), sheets_(CellSheets::of_all_states()) {
        grid_.size = layout.size, grid_.origin = layout.origin, grid_.spacing = layout.spacing;
        grid_.values.assign(grid_.count(), 1.0f);
    }

    void sample() {
        const int rows = (grid_.size[2] + block - 1) / block;
        const double half = 0.5 * std::sqrt(3.0) * (block - 1) * grid_.spacing.x;
        run_(rows, [&](int job) {
            const int k0 = job * block, k1 = std::min(grid_.size[2], k0 + block);
            for (int j0 = 0; j0 < grid_.size[1]; j0 += block)
                for (int i0 = 0; i0 < grid_.size[0]; i0 += block) {
                    const Vec3 middle = grid_.position(i0, j0, k0) + 0.5 * (block - 1) * grid_.spacing;
                    const double at_middle = solid_.value(middle);
                    const bool is_far = std::abs(at_middle) > half;
                    for (int k = k0; k < k1; ++k)
                        for (int j = j0; j < std::min(grid_.size[1], j0 + block); ++j)
                            for (int i = i0; i < std::min(grid_.size[0], i0 + block); ++i)
                                if (!is_border(i, j, k))
                                    grid_.at(i, j, k) =
                                        static_cast<float>(is_far ? at_middle : solid_.value(grid_.position(i, j, k)));
                }
        });
    }

    /// Removes small parts and all cavities, by 6-neighbours.
    void clean(double crumb, Contour& made) {
        const double cell = grid_.spacing.x * grid_.spacing.y * grid_.spacing.z;
        const auto most = static_cast<std::size_t>(crumb / cell);
        std::vector<std::uint8_t> is_seen(grid_.count(), 0);
        std::vector<std::size_t> part;
        const std::array<std::ptrdiff_t, 3> step{1, grid_.size[0],
                                                 static_cast<std::ptrdiff_t>(grid_.size[0]) * grid_.size[1]};
        for (std::size_t first = 0; first < is_seen.size(); ++first) {
            if (is_seen[first] || !is_in(first)) continue;
            const std::size_t size = flood(first, step, is_seen, part);
            if (size > most) continue;
            for (const std::size_t s : part) grid_.values[s] = -grid_.values[s] + tiny;
            ++made.crumbs, made.crumb_volume += static_cast<double>(size) * cell;
        }
        std::ranges::fill(is_seen, std::uint8_t{0});
        // The border is outside, and all of it is connected.
        flood(0, step, is_seen, part);
        for (std::size_t first = 0; first < is_seen.size(); ++first) {
            if (is_seen[first] || is_in(first)) continue;
            flood(first, step, is_seen, part);
            for (const std::size_t s : part) grid_.values[s] = -std::abs(grid_.values[s]) - tiny;
            ++made.voids;
        }
    }

    /// Until no edge has more than two triangles.
    void mesh(Contour& made) {
        for (int round = 0; round < 20; ++round) {
            net_ = surface_net(grid_, 0.0f, false);
            const std::vector<std::array<int, 2>> shared = crowded_edges();
            if (shared.empty()) break;
            for (const auto& [a, b] : shared) made.flipped += separate(a, b);
        }
    }

    void place_vertices() {
        sheet_.assign(net_.vertices.size(), 0);
        for (std::size_t v = 1; v < sheet_.size(); ++v)
            if (net_.cell[v] == net_.cell[v - 1]) sheet_[v] = static_cast<std::uint8_t>(sheet_[v - 1] + 1);
        mean_.resize(net_.vertices.size());
        settled_.resize(net_.vertices.size());
        constexpr int chunk = 4096;
        const int count = static_cast<int>(net_.vertices.size());
        run_((count + chunk - 1) / chunk, [&](int job) {
            for (int v = job * chunk; v < std::min(count, (job + 1) * chunk); ++v) place(static_cast<std::size_t>(v));
        });
        part_vertices();
    }

    /// Divides each quad along the diagonal whose middle is nearer to the surface: along edges of the solid, not across.
    void choose_diagonals() {
        const auto quads = static_cast<int>(net_.triangles.size() / 2);
        constexpr int chunk = 4096;
        run_((quads + chunk - 1) / chunk, [&](int job) {
            for (int q = job * chunk; q < std::min(quads, (job + 1) * chunk); ++q) choose_diagonal(at(q));
        });
        for (int round = 0; round < 4; ++round) {
            const auto crowded = crowded_edges();
            if (crowded.empty()) return;
            for (std::size_t q = 0; q < at(quads); ++q) {
                const std::array<int, 4> c = quad(q);
                const std::array<int, 2> diagonal =
                    is_cut_at_first(q) ? std::array{c[0], c[2]} : std::array{c[1], c[3]};
                if (std::ranges::binary_search(
                        crowded, std::array{std::min(diagonal[0], diagonal[1]), std::max(diagonal[0], diagonal[1])}))
                    divide(q, c, !is_cut_at_first(q));
            }
        }
    }

    /// Vertices of triangles that intersect approach the mean of their crossings.
    void untangle(Contour& made) {
        const TriangleBoxes boxes(net_, 1.5 * grid_.spacing.x);
        std::vector<std::vector<int>> of_vertex;
        std::vector<std::uint8_t> is_moved(net_.vertices.size(), 0);
        std::vector<std::array<int, 2>> pairs = self_intersections(net_, 100000, run_);
        for (int round = 0; round < 12 && !pairs.empty(); ++round) {
            if (of_vertex.empty()) {
                of_vertex.resize(net_.vertices.size());
                for (std::size_t t = 0; t < net_.triangles.size(); ++t)
                    for (const int v : net_.triangles[t]) of_vertex[at(v)].push_back(static_cast<int>(t));
            }
            std::vector<int> moved, dirty;
            for (const auto& pair : pairs)
                for (const int t : pair)
                    for (const int v : net_.triangles[at(t)]) moved.push_back(v);
            std::ranges::sort(moved);
            moved.erase(std::ranges::unique(moved).begin(), moved.end());
            for (const int v : moved) {
                made.smoothed += is_moved[at(v)] == 0;
                is_moved[at(v)] = 1;
                net_.vertices[at(v)] =
                    round == 0 ? settled_[at(v)] : glm::mix(net_.vertices[at(v)], mean_[at(v)], round < 4 ? 0.5 : 1.0);
                dirty.insert(dirty.end(), of_vertex[at(v)].begin(), of_vertex[at(v)].end());
            }
            std::ranges::sort(dirty);
            dirty.erase(std::ranges::unique(dirty).begin(), dirty.end());
            pairs.clear();
            for (const int t : dirty) boxes.intersections_of(at(t), true, pairs);
        }
    }

    TriangleSurface take() { return {std::move(net_.vertices), std::move(net_.triangles)}; }

private:
    static constexpr float tiny = 1e-9f;

    static std::size_t at(int n) { return static_cast<std::size_t>(n); }

    // surface_net makes two triangles per quad, one after the other: (a, b, c), (a, c, d) or (a, b, d), (b, c, d).
    bool is_cut_at_first(std::size_t q) const { return net_.triangles[2 * q][0] == net_.triangles[2 * q + 1][0]; }
    std::array<int, 4> quad(std::size_t q) const {
        const auto &s = net_.triangles[2 * q], &t = net_.triangles[2 * q + 1];
        if (is_cut_at_first(q)) return {s[0], s[1], s[2], t[2]};
        return {s[0], s[1], t[1], s[2]};
    }
    void divide(std::size_t q, const std::array<int, 4>& c, bool at_first) {
        net_.triangles[2 * q] = at_first ? std::array{c[0], c[1], c[2]} : std::array{c[0], c[1], c[3]};
        net_.triangles[2 * q + 1] = at_first ? std::array{c[0], c[2], c[3]} : std::array{c[1], c[2], c[3]};
    }
    void choose_diagonal(std::size_t q) {
        const std::array<int, 4> c = quad(q);
        const Vec3 &p0 = net_.vertices[at(c[0])], &p1 = net_.vertices[at(c[1])], &p2 = net_.vertices[at(c[2])],
                   &p3 = net_.vertices[at(c[3])];
        const double first = std::abs(solid_.value(0.5 * (p0 + p2))), second = std::abs(solid_.value(0.5 * (p1 + p3)));
        const auto min_area = [](const Vec3& a, const Vec3& b, const Vec3& d, const Vec3& e) {
            return std::min(glm::length(glm::cross(b - a, d - a)), glm::length(glm::cross(d - a, e - a)));
        };
        if (std::abs(first - second) > 1e-3 * grid_.spacing.x) divide(q, c, first < second);
        else divide(q, c, min_area(p0, p1, p2, p3) >= min_area(p1, p2, p3, p0));
    }

    bool is_in(std::size_t s) const { return grid_.values[s] < 0.0f; }
    bool is_border(int i, int j, int k) const {
        return i == 0 || j == 0 || k == 0 || i + 1 == grid_.size[0] || j + 1 == grid_.size[1] || k + 1 == grid_.size[2];
    }

    template <class Visit>
    void neighbours(std::size_t s, const std::array<std::ptrdiff_t, 3>& step, const Visit& visit) const {
        const auto at = static_cast<std::ptrdiff_t>(s);
        const std::array<std::ptrdiff_t, 3> place{at % step[1], at / step[1] % grid_.size[1], at / step[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (place[axis] > 0) visit(static_cast<std::size_t>(at - step[axis]));
            if (place[axis] + 1 < grid_.size[axis]) visit(static_cast<std::size_t>(at + step[axis]));
        }
    }
    std::size_t flood(std::size_t first, const std::array<std::ptrdiff_t, 3>& step, std::vector<std::uint8_t>& is_seen,
                      std::vector<std::size_t>& part) const {
        part.assign(1, first);
        is_seen[first] = 1;
        const bool side = is_in(first);
        for (std::size_t n = 0; n < part.size(); ++n) {
            if (n % 65536 == 0) leave_if_stopped();
            neighbours(part[n], step, [&](std::size_t other) {
                if (is_seen[other] || is_in(other) != side) return;
                is_seen[other] = 1;
                part.push_back(other);
            });
        }
        return part.size();
    }

    /// Edges with more than two triangles.
    std::vector<std::array<int, 2>> crowded_edges() const {
        std::vector<std::array<int, 2>> edges;
        edges.reserve(3 * net_.triangles.size());
        for (const auto& t : net_.triangles)
            for (std::size_t n = 0; n < 3; ++n)
                edges.push_back({std::min(t[n], t[(n + 1) % 3]), std::max(t[n], t[(n + 1) % 3])});
        std::ranges::sort(edges);
        std::vector<std::array<int, 2>> crowded;
        for (std::size_t n = 0; n + 2 < edges.size(); ++n)
            if (edges[n] == edges[n + 2] && (crowded.empty() || crowded.back() != edges[n]))
                crowded.push_back(edges[n]);
        return crowded;
    }

    /// Changes the sample nearest to the surface on the face that the cells of both vertices share.
    std::size_t separate(int a, int b) {
        const auto &p = net_.cell[static_cast<std::size_t>(a)], &q = net_.cell[static_cast<std::size_t>(b)];
        std::array<int, 3> low{}, high{};
        for (std::size_t n = 0; n < 3; ++n) low[n] = std::max(p[n], q[n]), high[n] = std::min(p[n], q[n]) + 1;
        std::size_t best = 0;
        double least = infinity_;
        for (int k = low[2]; k <= high[2]; ++k)
            for (int j = low[1]; j <= high[1]; ++j)
                for (int i = low[0]; i <= high[0]; ++i) {
                    const double size = std::abs(static_cast<double>(grid_.at(i, j, k)));
                    if (is_border(i, j, k) || !(size < least)) continue;
                    least = size, best = grid_.index(i, j, k);
                }
        if (!(least < infinity_)) return 0;
        // The next change takes another sample.
        const float value = grid_.values[best];
        grid_.values[best] = (value < 0.0f ? 1.0f : -1.0f) * static_cast<float>(0.3 * grid_.spacing.x);
        return 1;
    }

    /// The crossing of an edge, by the solid itself where its samples have different sides there.
    Vec3 crossing_of(const Vec3& a, const Vec3& b, bool a_is_in) const {
        double low = 0.0, high = 1.0, at_low = solid_.value(a), at_high = solid_.value(b);
        if ((at_low < 0.0) != a_is_in || (at_high < 0.0) == a_is_in) return 0.5 * (a + b);
        double t = 0.5;
        // Regula falsi that halves a bound that stays (Illinois).
        int kept = 0;
        for (int round = 0; round < 30 && high - low > 1e-7; ++round) {
            t = std::clamp(low + (high - low) * at_low / (at_low - at_high), low, high);
            const double here = solid_.value(glm::mix(a, b, t));
            if (std::abs(here) < 1e-9 * grid_.spacing.x) break;
            if ((here < 0.0) == (at_low < 0.0)) {
                low = t, at_low = here;
                if (kept == 1) at_high *= 0.5;
                kept = 1;
            } else {
                high = t, at_high = here;
                if (kept == -1) at_low *= 0.5;
                kept = -1;
            }
        }
        return glm::mix(a, b, t);
    }

    void place(std::size_t v) {
        const auto& cell = net_.cell[v];
        unsigned in = 0;
        for (int c = 0; c < 8; ++c)
            in |=
                static_cast<unsigned>(is_in(grid_.index(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2))))
                << c;
        const CellSheets& sheets = sheets_[in];
        std::array<Vec3, 12> point, normal;
        std::size_t count = 0;
        const Vec3 corner = grid_.position(cell[0], cell[1], cell[2]);
        for (int edge = 0; edge < 24; ++edge) {
            if (sheets.of_edge[CellSheets::at(edge)] != static_cast<int>(sheet_[v])) continue;
            const int from = edge / 3;
            const Vec3 a = corner + Vec3(from & 1, from >> 1 & 1, from >> 2) * grid_.spacing;
            Vec3 b = a;
            b[edge % 3] += grid_.spacing[edge % 3];
            point[count] = crossing_of(a, b, (in >> from & 1u) != 0);
            normal[count] = solid_.normal(point[count]);
            ++count;
        }
        Vec3 mean(0.0);
        for (std::size_t n = 0; n < count; ++n) mean += point[n] / static_cast<double>(count);
        const Vec3 low = corner + rim * grid_.spacing, high = corner + (1.0 - rim) * grid_.spacing;
        mean_[v] = glm::clamp(mean, low, high);
        std::array<double, 9> m{};
        Vec3 right(0.0);
        for (std::size_t n = 0; n < count; ++n) {
            const Vec3& w = normal[n];
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) m[static_cast<std::size_t>(3 * i + j)] += w[i] * w[j];
            right += w * glm::dot(w, point[n] - mean);
        }
        const Planes planes{m, right};
        const std::array<bool, 3> all{true, true, true};
        const Vec3 free = mean + planes.nearest(Vec3(0.0), all);
        const auto is_within = [&](const Vec3& x, const Vec3& from, const Vec3& to) {
            return glm::all(glm::lessThanEqual(from, x)) && glm::all(glm::lessThanEqual(x, to));
        };
        settled_[v] = is_within(free, low, high) ? free : in_cell(planes, mean, low, high);
        // An edge may pass beside a cell whose corner it cuts off.
        const Vec3 beside = outside * grid_.spacing;
        net_.vertices[v] = is_within(free, low - beside, high + beside) ? free : settled_[v];
    }

    /// Corners that several cells have found: only one vertex may be there.
    void part_vertices() {
        for (const auto& t : net_.triangles)
            for (std::size_t n = 0; n < 3; ++n) {
                const std::size_t a = at(t[n]), b = at(t[(n + 1) % 3]);
                if (glm::length(net_.vertices[a] - net_.vertices[b]) > 1e-3 * grid_.spacing.x) continue;
                net_.vertices[a] = settled_[a], net_.vertices[b] = settled_[b];
            }
    }

    /// The place in the cell nearest to the planes: the least over the cell's faces, edges and corners, as none is inside.
    static Vec3 in_cell(const Planes& planes, const Vec3& mean, const Vec3& low, const Vec3& high) {
        Vec3 best(0.0);
        double least = infinity_;
        // Each axis is free, at its low or at its high bound.
        for (int choice = 1; choice < 27; ++choice) {
            std::array<bool, 3> is_free{};
            Vec3 start(0.0);
            for (int axis = 0, rest = choice; axis < 3; ++axis, rest /= 3) {
                is_free[at(axis)] = rest % 3 == 0;
                if (rest % 3 == 1) start[axis] = low[axis] - mean[axis];
                if (rest % 3 == 2) start[axis] = high[axis] - mean[axis];
            }
            const Vec3 offset = planes.nearest(start, is_free), found = glm::clamp(mean + offset, low, high);
            if (glm::length(found - mean - offset) > 1e-9 * glm::length(high - low)) continue;
            // Where the planes do not decide, the nearest to the mean.
            if (const double error = planes.error(offset) + 1e-3 * glm::dot(offset, offset); error < least)
                least = error, best = found;
        }
        return least < infinity_ ? best : glm::clamp(mean, low, high);
    }

    static constexpr double infinity_ = std::numeric_limits<double>::infinity();

    const ImplicitSolid& solid_;
    const RunJobs& run_;
    std::vector<CellSheets> sheets_;
    volume::Grid grid_;
    SurfaceNet net_;
    std::vector<std::uint8_t> sheet_;  // per vertex: which of its cell
    std::vector<Vec3> settled_, mean_;  // per vertex: within its cell; mean of its crossings
};

}  // namespace

Contour dual_contour(const volume::Grid& layout, const ImplicitSolid& solid, double crumb, const RunJobs& run) {
    Contour made;
    DualContour contour(layout, solid, run);
    contour.sample();

    contour.clean(crumb, made);

    contour.mesh(made);

    contour.place_vertices();

    contour.choose_diagonals();

    contour.untangle(made);

    made.surface = contour.take();
    return made;
}

}  // namespace tactus::geometry
