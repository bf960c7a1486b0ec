// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "engine/engine.hpp"
#include "engine/take_compare.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/session/replayed_take.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <thread>

namespace tactus::command {

using namespace session;

namespace {

using Json = nlohmann::ordered_json;

struct ReplayChoice {
    std::filesystem::path take;
    bool json = false;
    bool anyway = false;  // although assets have changed
};

/// Outputs whose hashes differ although no value did: values that the streams do not hold.
std::vector<std::string> differing_hashes(const Take& take, const Engine& engine) {
    std::vector<std::string> ports;
    if (take.result.empty()) return ports;
    for (const auto& [port, hash] : engine.port_hashes()) {
        const auto expected = take.result.find(port);
        if (expected == take.result.end() || expected->second != hash) ports.push_back(port);
    }
    return ports;
}

Json difference_json(const TakeDifference& d) {
    return {{"port", d.port},         {"tick", d.tick},         {"time_s", d.time},
            {"channels", d.channels}, {"expected", d.expected}, {"got", d.got}};
}

int replay(const ReplayChoice& choice) {
    const Take take = Take::load(choice.take);
    const std::vector<std::string> differences = take.differences(), changed = take.changed_assets();
    for (const std::string& difference : differences)
        fmt::print(stderr, "tactus: {}; the bits may differ\n", difference);
    for (const std::string& difference : changed) fmt::print(stderr, "tactus: {}\n", difference);
    if (!changed.empty() && !choice.anyway)
        throw Error("the take cannot be repeated with other assets; --anyway tries");

    AssetCache assets;
    TakeComparison comparison(take);
    EngineOptions options;
    options.seconds = take.about.seconds;
    options.tap = [&comparison](const std::string& port, const ValueType& type, const GroupRuntime& group) {
        return comparison.tap(port, type, group);
    };
    ReplayedTake repeated(take, options, assets);
    Engine& engine = repeated.engine();
    LiveLine line;
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    engine.render(threads, [&](double done) { line.show(fmt::format("{:3.0f} %", 100.0 * done)); });
    line.clear();
    engine.finish();

    const std::vector<std::string> hashes = differing_hashes(take, engine);
    const auto& first = comparison.first_difference();
    const bool identical = !first && hashes.empty();
    const double covered = engine.progress_seconds();
    if (choice.json) {
        Json json{{"identical", identical},
                  {"compared_values", comparison.compared_values()},
                  {"first_difference", first ? difference_json(*first) : Json()},
                  {"differing_hashes", hashes},
                  {"seconds", covered},
                  {"whole", take.log.is_whole},
                  {"edits", engine.edits()},
                  {"notices", differences}};
        fmt::print("{}\n", json.dump(2));
    } else if (identical) {
        fmt::print("identical: {} values of {} outputs, {:.3g} s{}\n", comparison.compared_values(),
                   take.streams.size(), covered,
                   take.log.is_whole ? "" : " (the run was cut off; so far it can be repeated)");
    } else if (first) {
        fmt::print("differs: {} at tick {} ({:.6f} s): expected {}, got {}\n", first->port, first->tick, first->time,
                   fmt::join(first->expected, " "), fmt::join(first->got, " "));
    } else {
        fmt::print("differs: the hashes of {}\n", fmt::join(hashes, ", "));
    }
    return identical ? done : answer_is_no;
}

}  // namespace

namespace {

Action add_replay(VerbOptions& verb) {
    const auto choice = std::make_shared<ReplayChoice>();
    verb.add("take", choice->take, "folder that --record made").required();
    verb.flag("--anyway", choice->anyway, "although assets have changed since");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return replay(*choice); };
}

}  // namespace

Verb replay_verb() { return {"replay", "repeat a take and compare every value, bit by bit", add_replay}; }

}  // namespace tactus::command
