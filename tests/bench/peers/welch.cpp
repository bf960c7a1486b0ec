// SPDX-License-Identifier: Apache-2.0
// The other half of welch.py: reads doubles from a file, then computes their Welch spectrum each time a line with a
// number of threads and the samples of a segment comes in; answers with seconds and the powers.
#include "dsp/signal/spectrum/welch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <thread>

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const bool single = std::string(argv[2]) == "float";
    std::ifstream file(argv[1], std::ios::binary);
    std::vector<double> x;
    for (double v; file.read(reinterpret_cast<char*>(&v), sizeof v);) x.push_back(v);
    const std::vector<float> narrow(x.begin(), x.end());
    tactus::signal::WelchSettings settings;
    for (int threads = 0; std::cin >> threads >> settings.segment;) {
        settings.overlap = settings.segment / 2;
        const tactus::signal::ForEach spread = [&](std::size_t count, const std::function<void(std::size_t)>& run) {
            std::atomic<std::size_t> next{0};
            const auto work = [&] {
                for (std::size_t i; (i = next.fetch_add(1)) < count;) run(i);
            };
            std::vector<std::jthread> others;
            for (int i = 1; i < threads; ++i) others.emplace_back(work);
            work();
        };
        const auto begin = std::chrono::steady_clock::now();
        const tactus::signal::Spectrum spectrum = single ? tactus::signal::welch<float>(narrow, settings, spread)
                                                         : tactus::signal::welch<double>(x, settings, spread);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        fmt::print("{} {}\n", seconds, fmt::join(spectrum.power, " "));
        std::fflush(stdout);
    }
}
