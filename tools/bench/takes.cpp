// SPDX-License-Identifier: Apache-2.0
// Size of a take per hour, for a hand that moves in contact all the time and for one that rests.
#include "assets/file/json.hpp"
#include "tools/bench/bench.hpp"
#include "tools/run/rendered_run.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

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

/// MB per hour of all files of a take, and of its log.
std::pair<double, double> recorded(const std::string& text, double seconds, bool values) {
    const run::ScratchFolder folder;
    run::RunChoice choice;
    choice.patch = (folder.path() / "patch.toml").string();
    choice.text = text;
    choice.seconds = seconds;
    choice.out = folder.path() / "out";
    choice.record = folder.path() / "take";
    choice.record_values = values;
    compile::AssetCache assets;
    const std::atomic<bool> stop{false};
    run::render_run(choice, assets, stop, [](double) {});
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(choice.record))
        if (entry.is_regular_file()) bytes += entry.file_size();
    const double an_hour = 1e-6 * 3600.0 / seconds;
    return {an_hour * static_cast<double>(bytes),
            an_hour * static_cast<double>(fs::file_size(choice.record / "timing.log"))};
}

int bench_takes(const TakesBenchChoice& choice) {
    file::Json rows = file::Json::array();
    if (!choice.json)
        fmt::print("{:8} {:8} {:>14} {:>18} {:>16}   MB per hour\n", "device", "hand", "decisions", "without values",
                   "with values");
    for (const char* model : {"", "touch", "omega", "falcon"})
        for (const bool is_moving : {true, false}) {
            const std::string text = patch_text(model, is_moving);
            const auto [without, log] = recorded(text, choice.seconds, false);
            const auto [with, same] = recorded(text, choice.seconds, true);
            const char* name = *model ? model : "ideal";
            rows.push_back({{"device", name},
                            {"moving", is_moving},
                            {"log_mb_per_h", log},
                            {"without_values_mb_per_h", without},
                            {"with_values_mb_per_h", with}});
            if (!choice.json)
                fmt::print("{:8} {:8} {:14.1f} {:18.1f} {:16.0f}\n", name, is_moving ? "moving" : "resting", log,
                           without, with);
        }
    if (choice.json) fmt::print("{}\n", rows.dump(2));
    return done;
}

}  // namespace

Verb takes_verb() {
    return {"takes", "size of a take per hour, with and without values, of a hand that moves and of one that rests",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<TakesBenchChoice>();
                verb.add("--seconds", choice->seconds, "of each run, s").unit("s").shows_default().range(1.0, 3600.0);
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_takes(*choice); };
            }};
}

}  // namespace tactus::bench
