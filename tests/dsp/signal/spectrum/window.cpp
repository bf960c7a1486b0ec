// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/window.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("windows equal scipy's, periodic and symmetric") {
    // /usr/bin/python3 -c 'import scipy.signal as s; print([(s.get_window(w,7)[2], s.get_window(w,8,False)[3])
    //     for w in ("hann","hamming","blackman","blackmanharris","flattop")])'
    struct Golden {
        signal::WindowKind kind;
        double periodic, symmetric;
    };
    for (const auto& [kind, periodic, symmetric] :
         {Golden{signal::WindowKind::hann, 0.6112604669781573, 0.9504844339512095},
          {signal::WindowKind::hamming, 0.6423596296199047, 0.9544456792351128},
          {signal::WindowKind::blackman, 0.45918295754596367, 0.9203636180999081},
          {signal::WindowKind::blackman_harris, 0.33283350429856506, 0.8893697722232837},
          {signal::WindowKind::flat_top, 0.01070371671615349, 0.7808739149387699}}) {
        CHECK(signal::make_window(kind, 7)[2] == Approx(periodic).epsilon(1e-13));
        CHECK(signal::make_window(kind, 8, signal::WindowSymmetry::symmetric)[3] == Approx(symmetric).epsilon(1e-13));
    }
}

TEST_CASE("the noise bandwidth is one bin without a window and one and a half with Hann") {
    CHECK(signal::noise_bandwidth_bins(signal::make_window(signal::WindowKind::rectangular, 100)) == Approx(1.0));
    CHECK(signal::noise_bandwidth_bins(signal::make_window(signal::WindowKind::hann, 4096)) * 48000.0 / 4096.0 ==
          Approx(17.578125));
}
