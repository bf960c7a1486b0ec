// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/surface_net.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/geometry/cell_sheets.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace tactus::geometry {

namespace {

struct Netter {
    const volume::Grid& grid;
    float iso;
    bool inside_above;
    SurfaceNet& net;
    std::array<std::vector<int>, 2> vertex;  // first vertex per cell of this layer and the previous one, or -1
    std::vector<CellSheets> sheets;  // for each of the 256 in/out states

    bool is_in(int i, int j, int k) const { return (grid.at(i, j, k) >= iso) == inside_above; }

    int& slot(int i, int j, int k) {
        return vertex[static_cast<std::size_t>(
            k & 1)][static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.size[0]) + static_cast<std::size_t>(i)];
    }

    const CellSheets& sheets_of(int i, int j, int k) const {
        std::size_t in = 0;
        for (int c = 0; c < 8; ++c)
            in |= static_cast<std::size_t>(is_in(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))) << c;
        return sheets[in];
    }

    void make_vertices(int i, int j, int k) {
        slot(i, j, k) = -1;
        const CellSheets& sheet = sheets_of(i, j, k);
        if (sheet.count == 0) return;
        std::array<Vec3, 4> sum{};
        std::array<int, 4> crossings{};
        for (int edge = 0; edge < 24; ++edge) {
            if (sheet.of_edge[CellSheets::at(edge)] < 0) continue;
            const int from = edge / 3;
            Vec3 at(from & 1, from >> 1 & 1, from >> 2), step(0.0);
            step[edge % 3] = 1.0;
            const double a = value(Vec3(i, j, k) + at), b = value(Vec3(i, j, k) + at + step);
            const auto n = CellSheets::at(sheet.of_edge[CellSheets::at(edge)]);
            sum[n] += at + step * ((double(iso) - a) / (b - a));
            ++crossings[n];
        }
        slot(i, j, k) = static_cast<int>(net.vertices.size());
        for (std::size_t n = 0; n < static_cast<std::size_t>(sheet.count); ++n) {
            net.vertices.push_back(grid.origin + (Vec3(i, j, k) + sum[n] / double(crossings[n])) * grid.spacing);
            net.cell.push_back({i, j, k});
        }
    }

    double value(const Vec3& at) const {
        return double(grid.at(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)));
    }

    // Vertex of the cell whose lowest sample is (i, j, k) for its edge from corner `low` along `axis`.
    int vertex_at(int i, int j, int k, int low, int along) {
        return slot(i, j, k) + sheets_of(i, j, k).of_edge[CellSheets::at(3 * low + along)];
    }

    // The four cells around an edge, counter-clockwise seen from its far end.
    void make_quad(bool out_at_end, int a, int b, int c, int d) {
        if (!out_at_end) std::swap(b, d);
        const auto length2 = [this](int p, int q) {
            const Vec3 difference =
                net.vertices[static_cast<std::size_t>(p)] - net.vertices[static_cast<std::size_t>(q)];
            return glm::dot(difference, difference);
        };
        if (length2(a, c) <= length2(b, d)) {
            net.triangles.push_back({a, b, c});
            net.triangles.push_back({a, c, d});
        } else {
            net.triangles.push_back({a, b, d});
            net.triangles.push_back({b, c, d});
        }
    }

    void run() {
        const std::size_t layer = static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1]);
        vertex = {std::vector<int>(layer, -1), std::vector<int>(layer, -1)};
        for (int k = 0; k + 1 < grid.size[2]; ++k) {
            leave_if_stopped();
            for (int j = 0; j + 1 < grid.size[1]; ++j)
                for (int i = 0; i + 1 < grid.size[0]; ++i) make_vertices(i, j, k);
            for (int j = 0; j + 1 < grid.size[1]; ++j)
                for (int i = 0; i + 1 < grid.size[0]; ++i) {
                    const bool in = is_in(i, j, k);
                    if (j > 0 && k > 0 && in != is_in(i + 1, j, k))
                        make_quad(in, vertex_at(i, j - 1, k - 1, 6, 0), vertex_at(i, j, k - 1, 4, 0),
                                  vertex_at(i, j, k, 0, 0), vertex_at(i, j - 1, k, 2, 0));
                    if (i > 0 && k > 0 && in != is_in(i, j + 1, k))
                        make_quad(in, vertex_at(i - 1, j, k - 1, 5, 1), vertex_at(i - 1, j, k, 1, 1),
                                  vertex_at(i, j, k, 0, 1), vertex_at(i, j, k - 1, 4, 1));
                    if (i > 0 && j > 0 && in != is_in(i, j, k + 1))
                        make_quad(in, vertex_at(i - 1, j - 1, k, 3, 2), vertex_at(i, j - 1, k, 2, 2),
                                  vertex_at(i, j, k, 0, 2), vertex_at(i - 1, j, k, 1, 2));
                }
        }
    }
};

// Neighbours of each vertex along the sides of quads, without duplicates.
struct Neighbours {
    std::vector<std::array<int, 6>> of;

    explicit Neighbours(const SurfaceNet& net) : of(net.vertices.size(), {-1, -1, -1, -1, -1, -1}) {
        for (const auto& t : net.triangles)
            for (std::size_t c = 0; c < 3; ++c) {
                const auto a = static_cast<std::size_t>(t[c]), b = static_cast<std::size_t>(t[(c + 1) % 3]);
                for (int axis = 0; axis < 3; ++axis) {
                    const auto n = static_cast<std::size_t>(axis);
                    const int step = net.cell[b][n] - net.cell[a][n];
                    // Sides join cells that share a face; diagonals of quads are not sides.
                    if (step == 0 || net.cell[b][(n + 1) % 3] != net.cell[a][(n + 1) % 3] ||
                        net.cell[b][(n + 2) % 3] != net.cell[a][(n + 2) % 3])
                        continue;
                    of[a][2 * n + (step > 0)] = t[(c + 1) % 3];
                    of[b][2 * n + (step < 0)] = t[c];
                }
            }
    }
};

}  // namespace

SurfaceNet surface_net(const volume::Grid& grid, float iso, bool inside_above) {
    SurfaceNet net;
    if (grid.size[0] > 1 && grid.size[1] > 1 && grid.size[2] > 1)
        Netter{grid, iso, inside_above, net, {}, CellSheets::of_all_states()}.run();
    return net;
}

void relax(SurfaceNet& net, const volume::Grid& grid, int passes, const RunJobs& run) {
    const Neighbours neighbours(net);
    const std::vector<Vec3> start = net.vertices;
    std::vector<Vec3> moved(net.vertices.size());
    constexpr int chunk = 4096;
    const auto count = static_cast<int>(net.vertices.size());
    constexpr double inwards = 0.6, pass_band = 0.05, outwards = 1.0 / (pass_band - 1.0 / inwards);
    const Vec3 reach = 0.6 * grid.spacing;
    for (int pass = 0; pass < 2 * passes; ++pass) {
        const double share = pass % 2 == 0 ? inwards : outwards;
        run((count + chunk - 1) / chunk, [&](int job) {
            for (int n = job * chunk; n < std::min(count, (job + 1) * chunk); ++n) {
                const auto v = static_cast<std::size_t>(n);
                const Vec3& at = net.vertices[v];
                Vec3 sum(0.0);
                double weight = 0.0;
                for (const int other : neighbours.of[v])
                    if (other >= 0) sum += net.vertices[static_cast<std::size_t>(other)], weight += 1.0;
                moved[v] = weight > 0.0
                               ? glm::clamp(at + share * (sum / weight - at), start[v] - reach, start[v] + reach)
                               : at;
            }
        });
        net.vertices.swap(moved);
    }
}

}  // namespace tactus::geometry
