// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/symmetric_eigen.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

namespace {

template <std::size_t N>
void check_equation(std::uint64_t seed) {
    std::array<double, N * N> m{};
    const Random random{seed};
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = i; j < N; ++j) m[N * i + j] = m[N * j + i] = random.normal(N * i + j);
    const geometry::SymmetricEigen<N> eigen = geometry::symmetric_eigen<N>(m);
    for (std::size_t n = 0; n < N; ++n) {
        if (n > 0) CHECK(eigen.value[n] >= eigen.value[n - 1]);
        for (std::size_t i = 0; i < N; ++i) {
            double sum = 0.0;
            for (std::size_t j = 0; j < N; ++j) sum += m[N * i + j] * eigen.vector[n][j];
            CHECK(sum == Approx(eigen.value[n] * eigen.vector[n][i]).margin(1e-12));
        }
    }
}

}  // namespace

TEST_CASE("dsp: eigenvalues and eigenvectors of 3, 4 and 6 rows satisfy their equation") {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        check_equation<3>(seed);
        check_equation<4>(seed);
        check_equation<6>(seed);
    }
}

TEST_CASE("dsp: eigenvalues of a known matrix") {
    const geometry::SymmetricEigen<3> eigen = geometry::symmetric_eigen<3>({2, -1, 0, -1, 2, -1, 0, -1, 2});
    CHECK(eigen.value[0] == Approx(2.0 - std::sqrt(2.0)));
    CHECK(eigen.value[1] == Approx(2.0));
    CHECK(eigen.value[2] == Approx(2.0 + std::sqrt(2.0)));
}
