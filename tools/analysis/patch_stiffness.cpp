// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/patch_stiffness.hpp"

#include "dsp/control/stated_hand.hpp"

#include <algorithm>

namespace tactus::analysis {

std::vector<NodeContactLaw> contact_laws(const run::Engine& engine) {
    const std::vector<bool> is_between = analyse::between_hand_and_force(engine.plan());
    std::vector<NodeContactLaw> laws;
    for (std::size_t n = 0; n < engine.nodes().size(); ++n) {
        const auto& node = engine.nodes()[n];
        const auto area = node->params.find("area_stiffness"), point = node->params.find("point_stiffness");
        if (area == node->params.end() || point == node->params.end()) continue;
        NodeContactLaw law;
        law.node = node->name;
        law.by_point = point->second->value > 0.0;
        law.stiffness = (law.by_point ? point : area)->second->value;
        law.is_felt = is_between[n];
        if (const auto spring = node->params.find("stiffness"); law.is_felt && spring != node->params.end())
            law.felt = spring->second->value;
        laws.push_back(std::move(law));
    }
    return laws;
}

std::vector<ClassVerdict> class_verdicts(const std::vector<analyse::ForceLoop>& loops) {
    std::vector<ClassVerdict> verdicts;
    for (const analyse::ForceLoop& loop : loops) {
        if (!loop.declared) continue;
        for (const analyse::DeviceClass& kind : analyse::device_classes()) {
            analyse::ForceLoop with = loop;
            with.damping = kind.damping + control::StatedHand::damping;
            with.is_damping_stated = true;
            with.latency_s = analyse::loop_delay(loop.graph_s, kind.delay, kind.delay);
            with.limit = analyse::stiffness_limit(with.damping, loop.period_s, with.latency_s);
            with.max_stiffness = kind.max_stiffness;
            verdicts.push_back({loop.from, loop.to, kind, std::min(with.limit, with.max_stiffness), with.ok()});
        }
    }
    return verdicts;
}

}  // namespace tactus::analysis
