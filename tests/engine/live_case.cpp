// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/live_case.hpp"

#include "tests/engine/chaos.hpp"

#include <atomic>

namespace tactus::test {

std::string with_slow_group(const std::string& rate) {
    PatchText patch;
    add_hand(patch, "left");
    patch.nodes.push_back({"slow", "chaos", rate, {}});
    patch.nodes.push_back({"near", "chaos", "1 kHz", {}});
    patch.wires.insert(patch.wires.end(), {"near.out -> slow.in", "slow.out -> near.in"});
    return patch.toml();
}

LiveOutcome run_case(const LiveCase& what, const WatchedHand& hand) {
    run::EngineOptions options;
    options.seconds = what.seconds;
    options.live = true;
    options.take = what.take;
    run::Engine engine(compile_text(what.text), options);
    std::atomic<bool> stop{false};
    LiveOutcome outcome;
    run::LiveOptions live;
    live.stop = &stop;
    live.watch = [&] {
        if (outcome.done_ns == 0 && hand.logical_s > what.at) {
            outcome.done_ns = steady_now();
            what.deed(engine);
        }
        if (outcome.done_ns != 0 && !stop && what.is_over(engine)) {
            outcome.stopped_ns = steady_now();
            stop = true;
        }
    };
    engine.run_live(live);
    outcome.returned_ns = steady_now();
    engine.finish();
    outcome.hashes = engine.port_hashes();
    for (const auto& slot : engine.host().devices)
        for (const io::DeviceFault& fault : slot->guard.faults()) outcome.faults.emplace_back(describe(fault.reason));
    return outcome;
}

}  // namespace tactus::test
