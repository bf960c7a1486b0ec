// SPDX-License-Identifier: Apache-2.0
#include "tools/window/plan/plan_map.hpp"

#include "dsp/core/stop.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace tactus::window {

void PlanMap::show(std::optional<Kind> kind) {
    if (kind == kind_) return;
    kind_ = kind;
    made_.reset();
    scene_.use_map(nullptr, drawn_range_ = range_);
}

void PlanMap::set_range(double range) {
    range_ = range;
    ranged_at_ = std::chrono::steady_clock::now();
}

/// New colours for all fragments take longer than a picture: while the range is dragged they come now and then.
void PlanMap::draw_range() {
    using namespace std::chrono_literals;
    if (range_ == drawn_range_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - ranged_at_ < 150ms && now - drawn_at_ < 700ms) return;
    drawn_at_ = now;
    scene_.set_map_range(drawn_range_ = range_);
}

void PlanMap::tend() {
    // Nobody could take the colours away.
    if (!run_.is_there()) show({});
    draw_range();
    if (making_.is_ready()) {
        try {
            auto map = std::make_shared<const render::SurfaceMap>(making_.take());
            // What was asked for may have changed meanwhile.
            if (kind_ == map->kind) scene_.use_map(std::move(map), drawn_range_ = range_);
        } catch (const std::exception& error) {
            bench_.tell(error.what(), true);
            if (made_ == kind_) show({});
        }
    }
    // Of all fragments at once: each new map colours those anew that are there.
    if (!kind_ || making_.is_busy() || !run_.plan() || !scene_.is_fitted()) return;
    std::vector<std::shared_ptr<const observe::SeenBody>> bodies = scene_.plan_bodies();
    const auto seen = bodies.size() - static_cast<std::size_t>(std::ranges::count(bodies, nullptr));
    if (seen == 0 || (made_ == kind_ && of_ == run_.version() && seen == seen_)) return;
    made_ = kind_;
    seen_ = seen;
    of_ = run_.version();
    making_.begin(analysis::Lane::studies, [kind = *kind_, plan = *run_.plan(), folder = run_.file().parent_path(),
                                            bodies = std::move(bodies)](std::stop_token stop) {
        const StopScope scope(stop);
        return render::make_surface_map(kind, plan, folder, bodies, std::move(stop));
    });
}

}  // namespace tactus::window
