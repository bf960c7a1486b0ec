// SPDX-License-Identifier: Apache-2.0
// Size of a take of an hour, for a hand that moves in contact all the time and for one that rests.
#include "assets/file/json.hpp"
#include "engine/take/take_streams.hpp"
#include "tools/bench/bench.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::bench {

namespace fs = std::filesystem;

namespace {

struct TakesBenchChoice {
    double seconds = 20.0;
    bool json = false;
};

/// A hand in six degrees of freedom on a ball, 1 kHz.
std::string patch_text(const std::string& model, bool is_moving) {
    std::string text = R"(title = "a hand on a ball"
wires = [
  "hand.pose -> ball.pose",
  "ball.wrench -> out.wrench",
]
[devices.scripted]
driver = "scripted"
targets = "0 s: 0 0 0 mm; 0.5 s: 0 0 -2 mm"
stiffness = "2 N/mm"
damping = "30 N s/m"
)";
    if (!model.empty()) text += fmt::format("model = \"{}\"\n", model);
    if (is_moving) text += "wiggle = \"10 mm\"\nwiggle_turn = \"10 deg\"\n";
    for (const char* node : {"hand", "ball", "out"}) {
        text += fmt::format("[nodes.{}]\nrate = \"1 kHz\"\n", node);
        if (std::string_view(node) == "ball") text += "type = \"sphere_contact\"\nstiffness = \"0.5 N/mm\"\n";
        else
            text += fmt::format("type = \"device_{}\"\ndevice = \"scripted\"\n",
                                std::string_view(node) == "hand" ? "input" : "output");
    }
    return text;
}

/// MB per hour.
struct TakeSize {
    double log = 0.0, streams = 0.0, all = 0.0;

    /// Of a take of an hour without --values.
    double by_default() const { return all - streams + std::min(streams, 1e-6 * take::max_first_bytes); }
};

TakeSize recorded(const std::string& text, double seconds) {
    const run::ScratchFolder folder;
    run::RunChoice choice;
    choice.patch = (folder.path() / "patch.toml").string();
    choice.text = text;
    choice.seconds = seconds;
    choice.out = folder.path() / "out";
    choice.record = folder.path() / "take";
    compile::AssetCache assets;
    const std::atomic<bool> stop{false};
    run::render_run(choice, assets, stop, [](double) {});
    TakeSize size;
    for (const auto& entry : fs::recursive_directory_iterator(choice.record)) {
        if (!entry.is_regular_file()) continue;
        const double bytes = 1e-6 * 3600.0 / seconds * static_cast<double>(entry.file_size());
        size.all += bytes;
        if (entry.path().parent_path().filename() == "streams") size.streams += bytes;
        if (entry.path().filename() == "timing.log") size.log = bytes;
    }
    return size;
}

int bench_takes(const TakesBenchChoice& choice) {
    file::Json rows = file::Json::array();
    if (!choice.json)
        fmt::print("{:8} {:8} {:>14} {:>14} {:>16}   MB of an hour\n", "device", "hand", "decisions", "default",
                   "with --values");
    for (const char* model : {"", "touch", "omega", "falcon"})
        for (const bool is_moving : {true, false}) {
            const TakeSize size = recorded(patch_text(model, is_moving), choice.seconds);
            const char* name = *model ? model : "ideal";
            rows.push_back({{"device", name},
                            {"moving", is_moving},
                            {"log_mb_per_h", size.log},
                            {"default_mb_of_an_hour", size.by_default()},
                            {"with_values_mb_per_h", size.all}});
            if (!choice.json)
                fmt::print("{:8} {:8} {:14.1f} {:14.1f} {:16.0f}\n", name, is_moving ? "moving" : "resting", size.log,
                           size.by_default(), size.all);
        }
    if (choice.json) fmt::print("{}\n", rows.dump(2));
    return done;
}

}  // namespace

Verb takes_verb() {
    return {"takes",
            "size of a take of an hour, by default and with all values, of a hand that moves and of one that rests",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<TakesBenchChoice>();
                verb.add("--seconds", choice->seconds, "of each run, s").unit("s").shows_default().range(1.0, 3600.0);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_takes(*choice); };
            }};
}

}  // namespace tactus::bench
