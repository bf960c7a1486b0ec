// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/multigrid.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::segmentation {

namespace {

using Places = std::vector<std::array<std::int32_t, 3>>;

constexpr std::size_t few_rows = 300;  // solved by a factorisation
constexpr float weak = 0.1f;  // share of a row's strongest conductance below which an edge joins no aggregate
// Piecewise constant corrections are too small by nearly a factor of two in smooth regions (Braess 1995).
constexpr float over_correction = 1.6f;
constexpr int sweeps = 2;
// Range of eigenvalues of D⁻¹A that smoothing treats. None is above 2.
constexpr float upper = 2.0f, lower = 0.4f;

struct Aggregates {
    std::vector<std::int32_t> of;
    Places place;
};

Aggregates aggregate(const Laplacian& a, const Places& place) {
    const std::size_t rows = a.rows();
    std::vector<float> strongest(rows, 0.0f);
    for (std::size_t n = 0; n < rows; ++n)
        for (std::uint32_t e = a.start[n]; e < a.start[n + 1]; ++e) strongest[n] = std::max(strongest[n], a.weight[e]);
    std::vector<std::int32_t> parent(rows);
    for (std::size_t n = 0; n < rows; ++n) parent[n] = static_cast<std::int32_t>(n);
    const auto root = [&](std::int32_t n) {
        while (parent[static_cast<std::size_t>(n)] != n) n = parent[static_cast<std::size_t>(n)];
        return n;
    };
    const auto block = [&](std::size_t n) {
        return std::array<std::int32_t, 3>{place[n][0] >> 1, place[n][1] >> 1, place[n][2] >> 1};
    };
    for (std::size_t n = 0; n < rows; ++n)
        for (std::uint32_t e = a.start[n]; e < a.start[n + 1]; ++e) {
            const auto other = static_cast<std::size_t>(a.column[e]);
            if (other > n || a.weight[e] < weak * std::min(strongest[n], strongest[other]) || block(n) != block(other))
                continue;
            const std::int32_t p = root(static_cast<std::int32_t>(n)), q = root(static_cast<std::int32_t>(other));
            parent[static_cast<std::size_t>(std::max(p, q))] = std::min(p, q);
        }
    Aggregates out;
    out.of.resize(rows);
    for (std::size_t n = 0; n < rows; ++n) {
        const std::int32_t r = root(static_cast<std::int32_t>(n));
        if (static_cast<std::size_t>(r) == n) {
            out.of[n] = static_cast<std::int32_t>(out.place.size());
            out.place.push_back(block(n));
        } else out.of[n] = out.of[static_cast<std::size_t>(r)];
    }
    return out;
}

/// Sums of rows and columns over aggregates: PᵀAP for a piecewise constant P.
Laplacian summed(const Laplacian& a, const std::vector<std::int32_t>& of, std::size_t count) {
    // Rows of each aggregate, one after the other.
    std::vector<std::uint32_t> first(count + 1, 0);
    for (const std::int32_t c : of) ++first[static_cast<std::size_t>(c) + 1];
    for (std::size_t c = 0; c < count; ++c) first[c + 1] += first[c];
    std::vector<std::uint32_t> row(of.size()), filled(first.begin(), first.end() - 1);
    for (std::size_t n = 0; n < of.size(); ++n)
        row[filled[static_cast<std::size_t>(of[n])]++] = static_cast<std::uint32_t>(n);

    Laplacian out;
    out.diagonal.reserve(count);
    std::vector<std::int32_t> slot(count, -1);  // entry of each column in the row in hand
    for (std::size_t c = 0; c < count; ++c) {
        const std::size_t begin = out.column.size();
        double diagonal = 0.0;
        for (std::uint32_t m = first[c]; m < first[c + 1]; ++m) {
            const std::uint32_t n = row[m];
            diagonal += static_cast<double>(a.diagonal[n]);
            for (std::uint32_t e = a.start[n]; e < a.start[n + 1]; ++e) {
                const std::int32_t d = of[static_cast<std::size_t>(a.column[e])];
                if (static_cast<std::size_t>(d) == c) {
                    diagonal -= static_cast<double>(a.weight[e]);
                    continue;
                }
                std::int32_t& at = slot[static_cast<std::size_t>(d)];
                if (at < 0) {
                    at = static_cast<std::int32_t>(out.column.size());
                    out.column.push_back(d);
                    out.weight.push_back(0.0f);
                }
                out.weight[static_cast<std::size_t>(at)] += a.weight[e];
            }
        }
        double sum = 0.0;
        for (std::size_t e = begin; e < out.column.size(); ++e) {
            slot[static_cast<std::size_t>(out.column[e])] = -1;
            sum += static_cast<double>(out.weight[e]);
        }
        // Rounding must not make the matrix indefinite.
        out.diagonal.push_back(static_cast<float>(std::max(diagonal, sum * (1.0 + 1e-6))));
        out.start.push_back(static_cast<std::uint32_t>(out.column.size()));
    }
    return out;
}

}  // namespace

Multigrid::Multigrid(const Laplacian& matrix, std::vector<std::array<std::int32_t, 3>> place) : fine_(matrix) {
    while (this->matrix(coarse_.size()).rows() > few_rows) {
        const Laplacian& below = this->matrix(coarse_.size());
        Aggregates groups = aggregate(below, place);
        if (groups.place.size() > below.rows() * 9 / 10) break;  // no aggregates are left; smoothing must do
        Coarse next{summed(below, groups.of, groups.place.size()), std::move(groups.of)};
        place = std::move(groups.place);
        coarse_.push_back(std::move(next));
    }
    factorise();
}

void Multigrid::factorise() {
    const Laplacian& a = matrix(coarse_.size());
    const std::size_t rows = a.rows();
    if (rows > 4 * few_rows) return;
    factor_.assign(rows * rows, 0.0);
    for (std::size_t n = 0; n < rows; ++n) {
        factor_[n * rows + n] = static_cast<double>(a.diagonal[n]);
        for (std::uint32_t e = a.start[n]; e < a.start[n + 1]; ++e)
            factor_[n * rows + static_cast<std::size_t>(a.column[e])] = -static_cast<double>(a.weight[e]);
    }
    for (std::size_t n = 0; n < rows; ++n)
        for (std::size_t m = 0; m <= n; ++m) {
            double sum = factor_[n * rows + m];
            for (std::size_t k = 0; k < m; ++k) sum -= factor_[n * rows + k] * factor_[m * rows + k];
            factor_[n * rows + m] = n == m ? std::sqrt(std::max(sum, 1e-12 * static_cast<double>(a.diagonal[n])))
                                           : sum / factor_[m * rows + m];
        }
}

void Multigrid::solve_coarsest(int sides, const float* b, float* x) const {
    const std::size_t rows = matrix(coarse_.size()).rows(), stride = static_cast<std::size_t>(sides);
    std::vector<double> y(rows);
    for (std::size_t side = 0; side < stride; ++side) {
        for (std::size_t n = 0; n < rows; ++n) {
            double sum = static_cast<double>(b[n * stride + side]);
            for (std::size_t k = 0; k < n; ++k) sum -= factor_[n * rows + k] * y[k];
            y[n] = sum / factor_[n * rows + n];
        }
        for (std::size_t n = rows; n-- > 0;) {
            double sum = y[n];
            for (std::size_t k = n + 1; k < rows; ++k) sum -= factor_[k * rows + n] * y[k];
            y[n] = sum / factor_[n * rows + n];
            x[n * stride + side] = static_cast<float>(y[n]);
        }
    }
}

Multigrid::Workspace Multigrid::workspace(int sides) const {
    Workspace work;
    for (std::size_t level = 0; level < levels(); ++level) {
        const std::size_t size = matrix(level).rows() * static_cast<std::size_t>(sides);
        auto& v = work.level.emplace_back();
        v.r.resize(size);
        v.d.resize(size);
        if (level == 0) continue;
        v.x.resize(size);
        v.b.resize(size);
        v.e.resize(size);
    }
    return work;
}

// Chebyshev iteration for D⁻¹A on [lower, upper] (Saad, Iterative Methods, algorithm 12.1).
void Multigrid::smooth(std::size_t level, int sides, const float* b, float* x, bool from_zero, Workspace& work) const {
    const Laplacian& a = matrix(level);
    auto& v = work.level[level];
    const std::size_t rows = a.rows(), stride = static_cast<std::size_t>(sides);
    constexpr float middle = (upper + lower) / 2.0f, half = (upper - lower) / 2.0f;
    float rho = half / middle;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const float* r = b;
        if (!from_zero || sweep > 0) {
            residual(a, sides, b, x, v.r.data());
            r = v.r.data();
        }
        const bool first = sweep == 0;
        const float next_rho = first ? rho : 1.0f / (2.0f * middle / half - rho);
        const float keep = first ? 0.0f : next_rho * rho;
        const float gain = first ? 1.0f / middle : 2.0f * next_rho / half;
        for (std::size_t n = 0; n < rows; ++n) {
            const float g = gain / a.diagonal[n];
            for (std::size_t m = n * stride; m < (n + 1) * stride; ++m) {
                v.d[m] = (first ? 0.0f : keep * v.d[m]) + g * r[m];
                x[m] = (from_zero && first ? 0.0f : x[m]) + v.d[m];
            }
        }
        rho = next_rho;
    }
}

void Multigrid::cycle(std::size_t level, int sides, const float* b, float* x, Workspace& work) const {
    if (level == coarse_.size()) {
        if (!factor_.empty()) return solve_coarsest(sides, b, x);
        smooth(level, sides, b, x, true, work);
        for (int n = 0; n < 8; ++n) smooth(level, sides, b, x, false, work);
        return;
    }
    smooth(level, sides, b, x, true, work);

    auto& v = work.level[level];
    auto& above = work.level[level + 1];
    const Coarse& coarse = coarse_[level];
    const std::size_t rows = matrix(level).rows(), stride = static_cast<std::size_t>(sides);
    residual(matrix(level), sides, b, x, v.r.data());
    std::fill(above.b.begin(), above.b.end(), 0.0f);
    for (std::size_t n = 0; n < rows; ++n) {
        float* sum = above.b.data() + static_cast<std::size_t>(coarse.of[n]) * stride;
        for (std::size_t s = 0; s < stride; ++s) sum[s] += v.r[n * stride + s];
    }
    cycle(level + 1, sides, above.b.data(), above.x.data(), work);
    if (level + 1 < coarse_.size()) {
        // The second half of the W corrects what the first left.
        std::vector<float>& rest = above.e;
        residual(coarse.matrix, sides, above.b.data(), above.x.data(), rest.data());
        std::swap(rest, above.b);
        std::vector<float> once = std::move(above.x);
        above.x.resize(once.size());
        cycle(level + 1, sides, above.b.data(), above.x.data(), work);
        for (std::size_t m = 0; m < once.size(); ++m) above.x[m] += once[m];
    }
    for (std::size_t n = 0; n < rows; ++n) {
        const float* change = above.x.data() + static_cast<std::size_t>(coarse.of[n]) * stride;
        for (std::size_t s = 0; s < stride; ++s) x[n * stride + s] += over_correction * change[s];
    }
    smooth(level, sides, b, x, false, work);
}

void Multigrid::apply(int sides, const float* r, float* z, Workspace& work) const { cycle(0, sides, r, z, work); }

}  // namespace tactus::segmentation
