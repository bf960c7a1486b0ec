// SPDX-License-Identifier: Apache-2.0
#include "tools/study/patch_stiffness.hpp"

#include <algorithm>

namespace tactus::study {

std::vector<NodeContactLaw> contact_laws(const std::vector<std::shared_ptr<build::LiveNode>>& nodes) {
    std::vector<NodeContactLaw> laws;
    for (const auto& node : nodes) {
        const auto area = node->params.find("area_stiffness"), point = node->params.find("point_stiffness");
        if (area == node->params.end() || point == node->params.end()) continue;
        NodeContactLaw law;
        law.node = node->name;
        law.by_point = point->second->value > 0.0;
        law.stiffness = (law.by_point ? point : area)->second->value;
        if (const auto spring = node->params.find("stiffness"); spring != node->params.end())
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
            with.damping = kind.damping;
            with.limit = analyse::stiffness_limit(kind.damping, loop.period_s, loop.latency_s);
            with.max_stiffness = kind.max_stiffness;
            verdicts.push_back({loop.from, loop.to, kind, std::min(with.limit, with.max_stiffness), with.ok()});
        }
    }
    return verdicts;
}

}  // namespace tactus::study
