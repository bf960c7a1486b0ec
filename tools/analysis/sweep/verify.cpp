// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/verify.hpp"

#include "dsp/core/random.hpp"
#include "tools/analysis/sweep/provenance.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

namespace fs = std::filesystem;

namespace {

/// "build, vector".
std::string differing_parts(const file::Json& a, const file::Json& b) {
    std::string text;
    for (const char* key : {"build", "libc", "vector", "features"})
        if (a.value(key, std::string()) != b.value(key, std::string()))
            text += fmt::format("{}{}", text.empty() ? "" : ", ", key);
    return text;
}

}  // namespace

std::vector<std::size_t> sample_points(const Results& results, double fraction, std::uint64_t seed) {
    std::vector<std::pair<std::uint64_t, std::size_t>> done;
    for (std::size_t i = 0; i < results.size(); ++i)
        if (results.state(i) == Results::State::done)
            done.emplace_back(mix(results.folder().tasks().id(i) ^ mix(seed)), i);
    std::ranges::sort(done);
    const auto wanted = static_cast<std::size_t>(fraction * static_cast<double>(done.size()) + 0.5);
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < std::min(done.size(), std::max<std::size_t>(wanted, 1)); ++i)
        points.push_back(done[i].second);
    return points;
}

Verification verify_points(const Results& results, const std::vector<std::size_t>& points, const file::Json& mine,
                           const fs::path& program, const std::atomic<bool>& stop,
                           const std::function<void(std::size_t done)>& tell) {
    const run::ScratchFolder scratch;
    const PointContext context{&results.folder(),
                               scratch.path() / "point",
                               program,
                               nullptr,
                               false,
                               {results.folder().sweep().limits.seconds, &stop}};
    Verification found;
    for (std::size_t n = 0; n < points.size() && !stop; ++n) {
        const std::size_t index = points[n];
        fs::create_directory(context.scratch);
        const sweep::Row row = run_point(context, index);
        std::error_code ignored;
        fs::remove_all(context.scratch, ignored);
        if (stop) break;
        const std::string parts = differing_parts(mine, results.worker(index));
        if (row.is_ok && row.output == results.output(index)) {
            ++found.equal;
            if (!parts.empty()) ++found.equal_elsewhere;
        } else if (!parts.empty()) {
            ++found.not_comparable;
            if (std::ranges::find(found.reasons, parts) == found.reasons.end()) found.reasons.push_back(parts);
        } else {
            found.differences.push_back(
                row.is_ok ? fmt::format("point {} ({}): output {}, in the results {}", index + 1,
                                        sweep::text_of_id(row.point), sweep::text_of_id(row.output),
                                        sweep::text_of_id(results.output(index)))
                          : fmt::format("point {} ({}): {}", index + 1, sweep::text_of_id(row.point), row.reason));
        }
        tell(n + 1);
    }
    return found;
}

}  // namespace tactus::analysis
