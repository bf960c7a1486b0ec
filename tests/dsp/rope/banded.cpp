// SPDX-License-Identifier: Apache-2.0
// The system of a chain against a dense solution of the same equations.
#include "dsp/rope/banded.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::rope;

namespace {

/// A random positive matrix, as blocks and as all its elements.
struct System {
    BlockBand band;
    std::vector<std::vector<double>> dense;
    std::uint64_t drawn = 0;

    System(std::size_t points, const Random& random)
        : band(points), dense(3 * points, std::vector<double>(3 * points, 0.0)) {
        band.clear();
        for (std::size_t i = 0; i < points; ++i)
            for (std::size_t j = i > 2 ? i - 2 : 0; j <= i; ++j) {
                Mat3 block;
                for (int b = 0; b < 3; ++b)
                    for (int a = 0; a < 3; ++a) block[b][a] = random.uniform(drawn++) - 0.5;
                // Rows sum to less than the diagonal: at most four neighbours, and the block's own.
                if (i == j) block = 0.5 * (block + glm::transpose(block)) + Mat3(8.0);
                put(i, j, block);
            }
        // What is added by a number is a multiple of the unit matrix.
        for (std::size_t i = 0; i < points; ++i)
            for (std::size_t j = i > 2 ? i - 2 : 0; j <= i; ++j) {
                const double d = random.uniform(drawn++) * (i == j ? 1.0 : 0.1);
                band.add(i, j, d);
                spread(i, j, Mat3(d));
            }
    }
    void put(std::size_t i, std::size_t j, const Mat3& block) {
        band.add(i, j, block);
        spread(i, j, block);
    }
    void spread(std::size_t i, std::size_t j, const Mat3& block) {
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a) {
                const auto row = 3 * i + static_cast<std::size_t>(a), column = 3 * j + static_cast<std::size_t>(b);
                dense[row][column] += block[b][a];
                if (i != j) dense[column][row] += block[b][a];
            }
    }
    void fix(std::size_t i) {
        band.fix(i);
        for (std::size_t a = 3 * i; a < 3 * i + 3; ++a)
            for (std::size_t n = 0; n < dense.size(); ++n) dense[a][n] = dense[n][a] = a == n ? 1.0 : 0.0;
    }
};

/// Gauss' elimination with the largest pivot.
std::vector<double> solved(std::vector<std::vector<double>> m, std::vector<double> v) {
    const std::size_t size = v.size();
    for (std::size_t j = 0; j < size; ++j) {
        std::size_t best = j;
        for (std::size_t i = j + 1; i < size; ++i)
            if (std::abs(m[i][j]) > std::abs(m[best][j])) best = i;
        std::swap(m[j], m[best]);
        std::swap(v[j], v[best]);
        for (std::size_t i = j + 1; i < size; ++i) {
            const double factor = m[i][j] / m[j][j];
            for (std::size_t k = j; k < size; ++k) m[i][k] -= factor * m[j][k];
            v[i] -= factor * v[j];
        }
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t k = i + 1; k < size; ++k) v[i] -= m[i][k] * v[k];
        v[i] /= m[i][i];
    }
    return v;
}

double difference(System& system, std::size_t points, const std::set<std::size_t>& fixed, const Random& random) {
    std::vector<Vec3> x(points, Vec3(0.0));
    std::vector<double> right(3 * points, 0.0);
    for (std::size_t n = 0; n < points; ++n)
        for (int a = 0; a < 3; ++a)
            if (!fixed.contains(n))
                right[3 * n + static_cast<std::size_t>(a)] = x[n][a] = random.uniform(system.drawn++) - 0.5;
    const std::vector<double> wanted = solved(system.dense, right);
    REQUIRE(system.band.solve(x));
    double largest = 0.0;
    for (std::size_t n = 0; n < points; ++n)
        for (int a = 0; a < 3; ++a)
            largest = std::max(largest, std::abs(x[n][a] - wanted[3 * n + static_cast<std::size_t>(a)]));
    return largest;
}

}  // namespace

TEST_CASE("the equations of a chain are solved as the dense ones are, with any number of points") {
    for (std::size_t points = 3; points <= 66; points += points < 12 ? 1 : 9) {
        CAPTURE(points);
        const Random random{points};
        System system(points, random);
        CHECK(difference(system, points, {}, random) < 1e-13);
    }
}

TEST_CASE("fixed points of a chain stay, and the others are solved as if they were walls") {
    for (const std::size_t points : {3u, 4u, 7u, 8u, 33u, 64u})
        for (std::size_t one = 0; one < points; one += points < 10 ? 1 : 5) {
            CAPTURE(points, one);
            const Random random{100 * points + one};
            System system(points, random);
            const std::set<std::size_t> fixed{0, one, points - 1};
            for (const std::size_t n : fixed) system.fix(n);
            CHECK(difference(system, points, fixed, random) < 1e-13);
        }
}

TEST_CASE("a matrix that is not positive is refused wherever the fault lies") {
    for (const std::size_t points : {3u, 6u, 9u})
        for (std::size_t wrong = 0; wrong < points; ++wrong)
            for (const double weight : {-40.0, std::nan("")}) {
                CAPTURE(points, wrong, weight);
                const Random random{points};
                System system(points, random);
                Mat3 fault(0.0);
                fault[1][1] = weight;
                system.put(wrong, wrong, fault);
                std::vector<Vec3> x(points, Vec3(1.0));
                CHECK_FALSE(system.band.solve(x));
            }
}

TEST_CASE("a copied matrix is solved as the first one") {
    const Random random{5};
    System system(10, random);
    BlockBand copy(10);
    copy.copy(system.band);
    std::vector<Vec3> one(10, Vec3(1.0, 2.0, 3.0)), two = one;
    REQUIRE(system.band.solve(one));
    REQUIRE(copy.solve(two));
    CHECK(one == two);
}
