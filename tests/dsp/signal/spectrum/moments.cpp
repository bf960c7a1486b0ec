// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/moments.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numeric>
#include <vector>

using namespace tactus;

TEST_CASE("skewness and kurtosis are scipy's, also with a large offset") {
    // python3 -c "import numpy as np, scipy.stats as s; n = np.arange(1000)
    // x = np.exp(np.sin(.37*n)) + .2*np.sin(1.1*n) + 5; print(s.skew(x), s.kurtosis(x, fisher=False))"
    for (const double offset : {5.0, 1e5}) {
        std::vector<double> x;
        for (int n = 0; n < 1000; ++n) x.push_back(std::exp(std::sin(0.37 * n)) + 0.2 * std::sin(1.1 * n) + offset);
        const double mean = std::accumulate(x.begin(), x.end(), 0.0) / 1000.0;
        signal::Moments moments;
        moments.push(std::span(x).first(333), mean);
        moments.push(std::span(x).subspan(333), mean);
        CHECK(moments.skewness() == Approx(0.487611187867).epsilon(1e-8));
        CHECK(moments.kurtosis() == Approx(1.833079237475).epsilon(1e-8));
    }
    CHECK(signal::Moments().kurtosis() == 0.0);
}
