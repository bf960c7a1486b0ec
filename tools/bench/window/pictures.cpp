// SPDX-License-Identifier: Apache-2.0
// Processor time per picture of the window on each patch of the library that has a scene, while the patch runs.
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/window/quantile.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/scratch_folder.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/window/frame/picture_meter.hpp"
#include "tools/window/view.hpp"

#include <fmt/format.h>

#include <stdlib.h>
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;
namespace fs = std::filesystem;

// The first pictures make meshes and compile shaders.
constexpr double settles_s = 1.0;

struct PicturesChoice {
    std::vector<std::string> patches;
    double seconds = 5.0;
    double max_ms = 0.0;
    std::string layout;
    int width = 1280, height = 800;
    bool json = false;
};

struct SceneCost {
    std::string patch;
    std::size_t pictures = 0, threads = 0;  ///< pictures that drew the scene
    double median = 0.0, p95 = 0.0, most = 0.0;  ///< ms, of those pictures
    double panels = 0.0;  ///< ms, median of pictures that drew only panels
    double per_s = 0.0;  ///< pictures of the scene per second
};

/// Without pictures when the patch has no scene.
SceneCost cost_of(const std::string& patch, const PicturesChoice& choice, const fs::path& folder,
                  const std::atomic<bool>& interrupted) {
    window::PictureMeter meter;
    window::ViewedRunChoice run;
    run.patch = patch;
    run.seconds = choice.seconds + settles_s;
    run.audio = "file";
    run.out = folder / patch;
    run.edits = false;
    run.view.width = choice.width;
    run.view.height = choice.height;
    run.view.scale = 1.0;
    run.view.layout = choice.layout;
    run.view.meter = &meter;
    window::watch_run(run, interrupted);
    std::vector<double> scenes, panels;
    double last = settles_s;
    for (const window::PictureMeter::Cost& cost : meter.costs()) {
        if (cost.at < settles_s) continue;
        (cost.draws_scene ? scenes : panels).push_back(1e3 * cost.processor);
        last = cost.at;
    }
    return {patch,
            scenes.size(),
            meter.threads(),
            quantile(scenes, 0.5),
            quantile(scenes, 0.95),
            quantile(scenes, 1.0),
            quantile(panels, 0.5),
            last > settles_s ? static_cast<double>(scenes.size()) / (last - settles_s) : 0.0};
}

std::vector<std::string> library_patches() {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(run::library_folder() / "patches"))
        if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    return {names.begin(), names.end()};
}

int bench_pictures(const PicturesChoice& choice) {
    const std::atomic<bool>& interrupted = run::stop_on_signals();
    const run::ScratchFolder folder;
    // What a person opened last, and in which layout, is neither used nor changed.
    ::setenv("XDG_STATE_HOME", (folder.path() / "state").c_str(), 1);
    std::vector<SceneCost> costs;
    for (const std::string& patch : choice.patches.empty() ? library_patches() : choice.patches) {
        if (interrupted) break;
        costs.push_back(cost_of(patch, choice, folder.path(), interrupted));
        if (costs.back().pictures > 0) continue;
        if (!choice.patches.empty())
            throw Error(fmt::format(
                "'{}' drew no scene after its first second: give more --seconds, or a patch with a scene", patch));
        costs.pop_back();
    }
    double worst = 0.0;
    Json rows = Json::array();
    for (const SceneCost& cost : costs) {
        worst = std::max(worst, cost.median);
        rows.push_back({{"patch", cost.patch},
                        {"median_ms", cost.median},
                        {"p95_ms", cost.p95},
                        {"max_ms", cost.most},
                        {"panels_median_ms", cost.panels},
                        {"pictures", cost.pictures},
                        {"pictures_per_s", cost.per_s},
                        {"threads", cost.threads}});
    }
    if (choice.json)
        fmt::print("{}\n", Json{{"width", choice.width}, {"height", choice.height}, {"scenes", rows}}.dump(2));
    else {
        fmt::print("processor time per picture of a window of {} x {}, all threads that draw\n", choice.width,
                   choice.height);
        fmt::print("{:<22} {:>10} {:>10} {:>10} {:>12} {:>9} {:>7}\n", "", "median ms", "p95 ms", "most ms",
                   "panels ms", "pictures", "per s");
        for (const SceneCost& cost : costs)
            fmt::print("{:<22} {:10.1f} {:10.1f} {:10.1f} {:12.1f} {:9} {:7.1f}\n", cost.patch, cost.median, cost.p95,
                       cost.most, cost.panels, cost.pictures, cost.per_s);
    }
    return choice.max_ms > 0.0 && worst > choice.max_ms ? answer_is_no : done;
}

}  // namespace

Verb pictures_verb() {
    return {"pictures", "processor time per picture of the window, for each patch of the library with a scene",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<PicturesChoice>();
                verb.add("--patch", choice->patches, "only this patch; may be given again").one_each();
                verb.add("--seconds", choice->seconds, "measured per patch, after a first second")
                    .shows_default()
                    .range(1.0, 600.0);
                verb.add("--most", choice->max_ms, "exit code 1 when a median is greater, ms; 0: never")
                    .shows_default()
                    .range(0.0, 1e6);
                verb.add("--layout", choice->layout,
                         "of the window: patch, plan or train; without it, what the patch asks for")
                    .one_of({"patch", "plan", "train"});
                verb.add("--width", choice->width, "of the window, pixels").shows_default().range(320, 8192);
                verb.add("--height", choice->height, "of the window, pixels").shows_default().range(240, 8192);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_pictures(*choice); };
            }};
}

}  // namespace tactus::bench
