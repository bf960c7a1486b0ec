// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/plan_preview.hpp"

#include "assets/plan/case_bones.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <exception>
#include <mutex>
#include <utility>

namespace tactus::window {

namespace {

// The observer copies all bodies when one is added.
constexpr auto between_openings = std::chrono::milliseconds(200);

std::string files_of(const plan::CasePlan& plan) {
    std::string files;
    for (const plan::PlanFragment& fragment : plan::fragments_of(plan))
        files += fragment.name + "\n" + fragment.file + "\n" + std::to_string(fragment.hash) + "\n";
    return files;
}

}  // namespace

struct PlanPreview::Loaded {
    std::mutex lock;
    std::vector<std::shared_ptr<const nodes::BodyParts>> parts;
};

void PlanPreview::begin(const plan::CasePlan& plan) {
    parts_.clear();
    bodies_.reset();
    shown_ = 0;
    count_ = plan.fragments.size();
    problem_.clear();
    port_.reset();
    observer_ = std::make_shared<observe::Observer>();
    coming_ = std::make_shared<Loaded>();
    loading_.let_go();
    if (count_ > coupling::Scene::max_objects) {
        problem_ = fmt::format("the plan has {} fragments, but a scene shows at most {}: plan the case in parts",
                               count_, coupling::Scene::max_objects);
        return;
    }
    // Not the lane of the scene: the meshes of bones that are loaded do not wait for the others.
    loading_.begin(analysis::Lane::moves, [into = coming_, plan](std::stop_token stop) {
        const StopScope scope(std::move(stop));
        try {
            plan::check_files(plan, {});
            for (const plan::PlanFragment& fragment : plan::fragments_of(plan)) {
                auto body = nodes::body_of_fragment(plan::fragment_bone(fragment, {}, plan::Paint::or_proposed).bone);
                const std::lock_guard lock(into->lock);
                into->parts.push_back(std::move(body));
            }
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    });
}

void PlanPreview::take_loaded() {
    if (loading_.is_ready()) try {
            problem_ = loading_.take();
        } catch (const std::exception& error) {
            problem_ = error.what();
        }
    const auto now = std::chrono::steady_clock::now();
    const std::lock_guard lock(coming_->lock);
    const std::size_t ready = coming_->parts.size();
    if (ready == parts_.size()) return;
    if (loading_.is_busy() && ready < count_ && now - opened_ < between_openings) return;
    opened_ = now;
    parts_ = coming_->parts;
    bodies_ = std::make_unique<nodes::CaseBodies>(parts_);
    plan_.reset();
}

void PlanPreview::show() {
    bodies_->arrange(plan::state_of(*plan_).arrangement);
    const coupling::Scene& scene = bodies_->scene();
    const auto* const bytes = reinterpret_cast<const std::byte*>(&scene);
    if (shown_ != parts_.size() || !port_) {
        port_ = observer_->open({port_name_, flicks_per_second, 1}, value::snapshot<coupling::Scene>, bytes);
        shown_ = parts_.size();
    }
    port_->see(pictures_++, bytes, 1, sizeof scene);
}

void PlanPreview::tend(const std::shared_ptr<const plan::CasePlan>& plan, const std::string& port) {
    if (plan_ != plan || port_name_ != port) {
        port_name_ = port;
        if (std::string files = files_of(*plan); files != files_) {
            begin(*plan);
            files_ = std::move(files);
        }
    }
    take_loaded();
    const bool is_shown = plan_ == plan;
    plan_ = plan;
    if (bodies_ && (!is_shown || !port_)) show();
}

}  // namespace tactus::window
