// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/random_walk.hpp"
#include "dsp/segmentation/laplacian.hpp"
#include "dsp/segmentation/multigrid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::segmentation {

namespace {

constexpr int max_sides = 4;  // solved in one pass over the matrix

using Sums = std::array<double, max_sides>;

/// Sum of u·v of each side.
Sums dots(int sides, const std::vector<float>& u, const std::vector<float>& v) {
    Sums sum{};
    const std::size_t stride = static_cast<std::size_t>(sides);
    for (std::size_t n = 0; n < u.size(); n += stride)
        for (std::size_t s = 0; s < stride; ++s)
            sum[s] += static_cast<double>(u[n + s]) * static_cast<double>(v[n + s]);
    return sum;
}

/// The equations of a graph with seeds.
struct Problem {
    const VoxelGraph& graph;
    std::span<const std::uint8_t> seed;
    FreeNodes free;
    std::optional<Multigrid> multigrid;

    Problem(const VoxelGraph& graph_, std::span<const std::uint8_t> seed_) : graph(graph_), seed(seed_) {
        const GraphParts parts = parts_of(graph);
        std::vector<char> has_seed(parts.nodes.size(), 0);
        for (std::size_t n = 0; n < graph.nodes(); ++n)
            if (seed[n] != 0) has_seed[static_cast<std::size_t>(parts.part[n])] = 1;
        std::vector<NodeState> state(graph.nodes());
        for (std::size_t n = 0; n < graph.nodes(); ++n)
            state[n] = seed[n] != 0                                             ? NodeState::fixed
                       : has_seed[static_cast<std::size_t>(parts.part[n])] != 0 ? NodeState::free
                                                                                : NodeState::left_out;
        free = free_nodes(graph, state);
        std::vector<std::array<std::int32_t, 3>> place;
        place.reserve(free.node.size());
        for (const std::uint32_t n : free.node) {
            const auto at = graph.place(n);
            place.push_back({at[0], at[1], at[2]});
        }
        multigrid.emplace(free.matrix, std::move(place));
    }

    /// Conductance of each row to the seeds of labels `first` + 1 and on.
    std::vector<float> right_side(int first, int sides) const {
        std::vector<float> b(free.node.size() * static_cast<std::size_t>(sides), 0.0f);
        const auto join = [&](std::size_t fixed, std::size_t node, float weight) {
            const std::int32_t row = free.row[node];
            const int side = static_cast<int>(seed[fixed]) - 1 - first;
            if (row >= 0 && seed[fixed] != 0 && side >= 0 && side < sides)
                b[static_cast<std::size_t>(row) * static_cast<std::size_t>(sides) + static_cast<std::size_t>(side)] +=
                    weight;
        };
        for (std::size_t n = 0; n < graph.nodes(); ++n)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::int32_t other = graph.next[n][axis];
                if (other < 0) continue;
                join(n, static_cast<std::size_t>(other), graph.weight[n][axis]);
                join(static_cast<std::size_t>(other), n, graph.weight[n][axis]);
            }
        return b;
    }
};

/// Conjugate gradients for all sides at once; each side has its own step lengths. Returns the iterations.
int conjugate_gradients(const Problem& problem, int sides, const std::vector<float>& b, std::vector<float>& x,
                        const WalkAccuracy& accuracy) {
    const Laplacian& a = problem.free.matrix;
    const std::size_t stride = static_cast<std::size_t>(sides), size = x.size();
    Multigrid::Workspace work = problem.multigrid->workspace(sides);
    std::vector<float> r(size), z(size), p(size), q(size);
    const Sums scale = dots(sides, b, b);
    // A label whose seeds have no free neighbour is nowhere else.
    for (std::size_t s = 0; s < stride; ++s)
        if (scale[s] == 0.0)
            for (std::size_t n = s; n < size; n += stride) x[n] = 0.0f;
    residual(a, sides, b.data(), x.data(), r.data());
    // Weakly joined seeds have a small right side, and rounding may keep the residual above the wanted share of it.
    constexpr int patience = 12;
    Sums least;
    least.fill(std::numeric_limits<double>::infinity());
    std::array<int, max_sides> min_at{};
    int iteration = 0;
    const auto is_solved = [&] {
        const Sums rest = dots(sides, r, r);
        bool solved = true;
        for (std::size_t s = 0; s < stride; ++s) {
            if (rest[s] < 0.25 * least[s]) least[s] = rest[s], min_at[s] = iteration;
            solved = solved &&
                     (rest[s] <= accuracy.residual * accuracy.residual * scale[s] || iteration - min_at[s] >= patience);
        }
        return solved;
    };
    Sums rho{};
    for (; iteration < accuracy.max_iterations && !is_solved(); ++iteration) {
        problem.multigrid->apply(sides, r.data(), z.data(), work);
        const Sums next = dots(sides, r, z);
        std::array<float, max_sides> beta{}, alpha{};
        for (std::size_t s = 0; s < stride; ++s)
            beta[s] = iteration == 0 || rho[s] == 0.0 ? 0.0f : static_cast<float>(next[s] / rho[s]);
        rho = next;
        for (std::size_t n = 0; n < size; n += stride)
            for (std::size_t s = 0; s < stride; ++s) p[n + s] = z[n + s] + beta[s] * p[n + s];
        multiply(a, sides, p.data(), q.data());
        const Sums curvature = dots(sides, p, q);
        for (std::size_t s = 0; s < stride; ++s)
            alpha[s] = curvature[s] > 0.0 ? static_cast<float>(rho[s] / curvature[s]) : 0.0f;
        for (std::size_t n = 0; n < size; n += stride)
            for (std::size_t s = 0; s < stride; ++s) {
                x[n + s] += alpha[s] * p[n + s];
                r[n + s] -= alpha[s] * q[n + s];
            }
    }
    return iteration;
}

/// Probabilities below 0 and above 1 are errors of the solver, at most of the size of the residual. The last label
/// takes what the others leave.
void complete(Walks& walks, const Problem& problem) {
    const auto labels = static_cast<std::size_t>(walks.labels);
    for (std::size_t n = 0; n < problem.graph.nodes(); ++n) {
        float* p = walks.probability.data() + n * labels;
        if (problem.seed[n] != 0) {
            std::fill(p, p + labels, 0.0f);
            p[problem.seed[n] - 1] = 1.0f;
        } else if (problem.free.row[n] >= 0) {
            double sum = 0.0;
            for (std::size_t l = 0; l + 1 < labels; ++l) {
                p[l] = std::clamp(p[l], 0.0f, 1.0f);
                sum += static_cast<double>(p[l]);
            }
            p[labels - 1] = static_cast<float>(std::max(0.0, 1.0 - sum));
            if (sum > 1.0)
                for (std::size_t l = 0; l + 1 < labels; ++l) p[l] = static_cast<float>(static_cast<double>(p[l]) / sum);
        } else std::fill(p, p + labels, 0.0f);
    }
}

/// Worst relative residual of the labels, in double precision, from the probabilities at all nodes.
double true_residual(const Walks& walks, const Problem& problem) {
    const auto labels = static_cast<std::size_t>(walks.labels);
    const Laplacian& a = problem.free.matrix;
    double worst = 0.0;
    for (std::size_t l = 0; l < labels; ++l) {
        const std::vector<float> b = problem.right_side(static_cast<int>(l), 1);
        double rest = 0.0, scale = 0.0;
        for (std::size_t row = 0; row < a.rows(); ++row) {
            const auto value = [&](std::size_t m) {
                return static_cast<double>(walks.probability[problem.free.node[m] * labels + l]);
            };
            double sum = static_cast<double>(b[row]) - static_cast<double>(a.diagonal[row]) * value(row);
            for (std::uint32_t e = a.start[row]; e < a.start[row + 1]; ++e)
                sum += static_cast<double>(a.weight[e]) * value(static_cast<std::size_t>(a.column[e]));
            rest += sum * sum;
            scale += static_cast<double>(b[row]) * static_cast<double>(b[row]);
        }
        if (scale > 0.0) worst = std::max(worst, std::sqrt(rest / scale));
    }
    return worst;
}

}  // namespace

Walks random_walks(const VoxelGraph& graph, std::span<const std::uint8_t> seed, int labels,
                   const WalkAccuracy& accuracy, const Walks* start, const RunJobs& run) {
    const Problem problem(graph, seed);
    const auto count = static_cast<std::size_t>(labels);
    Walks walks;
    walks.labels = labels;
    walks.probability.assign(graph.nodes() * count, 0.0f);
    const bool warm =
        start != nullptr && start->labels == labels && start->probability.size() == walks.probability.size();

    // The last label takes the rest.
    const int panels = (labels - 1 + max_sides - 1) / max_sides;
    std::vector<int> iterations(static_cast<std::size_t>(panels), 0);
    run(panels, [&](int panel) {
        const int first = panel * max_sides, sides = std::min(max_sides, labels - 1 - first);
        const auto stride = static_cast<std::size_t>(sides), offset = static_cast<std::size_t>(first);
        const std::vector<float> b = problem.right_side(first, sides);
        std::vector<float> x(b.size(), 0.0f);
        const auto& nodes = problem.free.node;
        if (warm)
            for (std::size_t row = 0; row < nodes.size(); ++row)
                for (std::size_t s = 0; s < stride; ++s)
                    x[row * stride + s] = start->probability[nodes[row] * count + offset + s];
        iterations[static_cast<std::size_t>(panel)] = conjugate_gradients(problem, sides, b, x, accuracy);
        for (std::size_t row = 0; row < nodes.size(); ++row)
            for (std::size_t s = 0; s < stride; ++s)
                walks.probability[nodes[row] * count + offset + s] = x[row * stride + s];
    });
    for (const int n : iterations) walks.iterations = std::max(walks.iterations, n);
    complete(walks, problem);
    walks.residual = true_residual(walks, problem);
    return walks;
}

std::vector<std::uint8_t> labels_of(const Walks& walks) {
    const auto labels = static_cast<std::size_t>(walks.labels);
    std::vector<std::uint8_t> out(labels == 0 ? 0 : walks.probability.size() / labels, 0);
    for (std::size_t n = 0; n < out.size(); ++n) {
        const float* p = walks.probability.data() + n * labels;
        const float* best = std::max_element(p, p + labels);
        if (*best > 0.0f) out[n] = static_cast<std::uint8_t>(best - p + 1);
    }
    return out;
}

std::vector<float> certainty_of(const Walks& walks) {
    const auto labels = static_cast<std::size_t>(walks.labels);
    std::vector<float> out(labels == 0 ? 0 : walks.probability.size() / labels, 0.0f);
    for (std::size_t n = 0; n < out.size(); ++n) {
        float first = 0.0f, second = 0.0f;
        for (std::size_t l = 0; l < labels; ++l) {
            const float p = walks.probability[n * labels + l];
            if (p > first) second = first, first = p;
            else second = std::max(second, p);
        }
        if (first > 0.0f) out[n] = 1.0f - second / first;
    }
    return out;
}

}  // namespace tactus::segmentation
