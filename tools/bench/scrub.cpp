// SPDX-License-Identifier: Apache-2.0
// Cost of random access to a take: repeating the run once, and then each jump.
#include "assets/file/json.hpp"
#include "tools/bench/bench.hpp"
#include "tools/window/desk/take_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

namespace tactus::bench {

struct ScrubBenchChoice {
    std::filesystem::path take;
    int jumps = 1000;
    bool json = false;
};

int bench_scrub(const ScrubBenchChoice& choice) {
    using Clock = std::chrono::steady_clock;
    const auto ms_since = [](Clock::time_point begin) {
        return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    };
    const auto begin = Clock::now();
    window::TakeBench bench(choice.take);
    bench.go_to(bench.length());
    while (!bench.scene_is_there()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const double repeated_ms = ms_since(begin);
    std::minstd_rand random(1);
    std::uniform_real_distribution<double> anywhere(0.0, bench.length());
    std::vector<double> jumps;
    for (int i = 0; i < choice.jumps; ++i) {
        const double to = anywhere(random);
        const auto jump = Clock::now();
        bench.go_to(to);
        jumps.push_back(ms_since(jump));
    }
    if (!bench.scene()) throw Error(bench.scene_note());
    std::ranges::sort(jumps);
    const auto quantile = [&](double q) {
        return jumps[static_cast<std::size_t>(q * static_cast<double>(jumps.size() - 1))];
    };
    const double kept_mb = static_cast<double>(bench.scene()->kept_bytes()) * 1e-6;
    if (choice.json) {
        const file::Json json{
            {"seconds", bench.length()},       {"repeated_ms", repeated_ms},    {"kept_mb", kept_mb},
            {"jump_median_ms", quantile(0.5)}, {"jump_p99_ms", quantile(0.99)}, {"jump_max_ms", jumps.back()}};
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print("{:.1f} s of take, repeated once in {:.0f} ms, {:.1f} MB kept\n", bench.length(), repeated_ms, kept_mb);
    fmt::print(
        "{} jumps: median {:.3f} ms, p99 {:.3f} ms, longest {:.3f} ms; running to there again takes {:.0f} ms on "
        "average\n",
        jumps.size(), quantile(0.5), quantile(0.99), jumps.back(), 0.5 * repeated_ms);
    return done;
}

Verb scrub_verb() {
    return {"scrub", "time to jump to any instant of a take, including bones and bodies",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<ScrubBenchChoice>();
                verb.add("take", choice->take, "folder of a take, made with --record").required();
                verb.add("--jumps", choice->jumps, "how many").shows_default().range(1, 100'000);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_scrub(*choice); };
            }};
}

}  // namespace tactus::bench
