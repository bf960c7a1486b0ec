// SPDX-License-Identifier: Apache-2.0
// What a scope shows, as a file.
#include "dsp/core/error.hpp"
#include "tools/report/figures/figure_file.hpp"
#include "tools/window/signal/scopes.hpp"
#include "tools/window/signal/table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::window {

namespace fs = std::filesystem;

fs::path Scopes::free_file(const std::string& port, const std::string& ending) const {
    std::string name = port;
    std::ranges::replace(name, '/', '-');  // of a sub-patch
    fs::path folder = bench_.status()->folder;
    if (folder.empty() && !folder_of_take.empty()) {
        // A take holds its recordings only.
        folder = folder_of_take.parent_path();
        name = folder_of_take.filename().string() + "-" + name;
    }
    fs::path path;
    for (int i = 1; path.empty() || fs::exists(path); ++i) path = folder / fmt::format("{}-{}{}", name, i, ending);
    return path;
}

void Scopes::save(std::size_t index, const Feed& feed, const std::string& ending) {
    try {
        write(index, feed, free_file(scopes_[index].port, ending));
    } catch (const Error& error) {
        bench_.tell(error.what(), true);
    }
}

void Scopes::write_table(Scope& scope, const Feed& feed, const fs::path& path) const {
    switch (scope.view) {
        case Scope::View::wave: {
            // What is shown, also where a trigger holds it.
            const Range time{scope.plot.origin + scope.plot.x.low, scope.plot.origin + scope.plot.x.high};
            std::vector<TableTrace> traces{{scope.held ? &*scope.held : feed.trace(scope.port), units(scope.port)}};
            for (std::size_t i = 0; i < scope.others.size(); ++i)
                if (const Trace* over = other(scope, i, feed))
                    traces.push_back({over, units(scope.others[i]), scope.others[i]});
            return write_csv(traces, time, path);
        }
        case Scope::View::spectrum: return write_spectrum_csv(scope.plot, path);
        case Scope::View::waterfall: return write_waterfall_csv(scope.plot, path);
        case Scope::View::histogram: return write_histogram_csv(scope.plot, path);
        case Scope::View::xy: return write_pairs_csv(scope.plot, path);
    }
}

void Scopes::write(std::size_t index, const Feed& feed, const fs::path& path) {
    if (index >= scopes_.size()) throw Error(fmt::format("there are {} scopes", scopes_.size()));
    Scope& scope = scopes_[index];
    ports_ = feed.ports();
    scope.computed_at = -1.0;
    refresh(scope, feed, 700);
    const bool has_levels = scope.plot.waterfall && scope.plot.note.empty();
    const bool has_points = std::ranges::any_of(
        scope.plot.curves, [](const Curve& curve) { return !curve.is_reference && !curve.points.empty(); });
    if (!has_levels && !has_points)
        throw Error(scope.plot.note.empty() ? fmt::format("there are no values of {} yet", scope.port)
                                            : fmt::format("{}: {}", scope.port, scope.plot.note));
    if (path.extension() == ".csv") write_table(scope, feed, path);
    else if (const std::string warning = report::write_figure(figure_of(scope.plot), path); !warning.empty())
        bench_.tell(warning, true);
    std::error_code ignored;
    bench_.tell(fmt::format("wrote {}", (path.has_parent_path() ? path : fs::absolute(path, ignored)).string()));
}

}  // namespace tactus::window
