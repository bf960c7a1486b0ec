// SPDX-License-Identifier: Apache-2.0
#include "tools/view/plan/plan_map.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace tactus::view {

void PlanMap::show(std::optional<Kind> kind) {
    if (kind == kind_) return;
    kind_ = kind;
    made_.reset();
    scene_.use_map(nullptr, range_);
}

void PlanMap::set_range(double range) {
    range_ = range;
    scene_.set_map_range(range);
}

void PlanMap::tend() {
    // Nobody could take the colours away.
    if (!run_.is_there()) show({});
    if (making_.valid() && making_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        try {
            auto map = std::make_shared<const picture::SurfaceMap>(making_.get());
            // What was asked for may have changed meanwhile.
            if (kind_ == map->kind) scene_.use_map(std::move(map), range_);
        } catch (const std::exception& error) {
            bench_.tell(error.what(), true);
            if (made_ == kind_) show({});
        }
    }
    if (!kind_ || making_.valid() || !run_.plan()) return;
    std::vector<std::shared_ptr<const observe::SeenBody>> bodies = scene_.plan_bodies();
    const auto seen = bodies.size() - static_cast<std::size_t>(std::ranges::count(bodies, nullptr));
    if (seen == 0 || (made_ == kind_ && of_ == run_.written() && seen == seen_)) return;
    made_ = kind_;
    seen_ = seen;
    of_ = run_.written();
    making_ = std::async(std::launch::async, [kind = *kind_, plan = *run_.plan(), folder = run_.file().parent_path(),
                                              bodies = std::move(bodies)] {
        return picture::make_surface_map(kind, plan, folder, bodies);
    });
}

}  // namespace tactus::view
