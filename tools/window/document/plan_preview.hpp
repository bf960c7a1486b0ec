// SPDX-License-Identifier: Apache-2.0
// The bones of an opened plan while no run shows them: each appears when it is loaded, at its place in the plan as it is
// now. No user interface.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "engine/observe/observer.hpp"
#include "nodes/plan/case_bodies.hpp"
#include "tools/analysis/beside.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tactus::window {

/// Gives a scene the output that a run of the patch would have, with the values before its first tick: what draws a run
/// draws a plan without one.
class PlanPreview {
public:
    /// Once per picture. `port`: the scene output of the patch, "case.scene". Loads the bones of a plan with other files
    /// anew, and follows every other change.
    void tend(const std::shared_ptr<const plan::CasePlan>& plan, const std::string& port);

    /// Null before the first call of `tend`.
    const std::shared_ptr<observe::Observer>& observer() const { return observer_; }
    std::size_t loaded() const { return shown_; }
    std::size_t count() const { return count_; }
    /// The bodies of all fragments, in the order of the plan; empty: they are still being loaded.
    std::vector<std::shared_ptr<const nodes::BodyParts>> parts() const {
        return parts_.size() == count_ ? parts_ : std::vector<std::shared_ptr<const nodes::BodyParts>>();
    }
    bool is_loading() const { return loading_.is_busy(); }
    /// Why a bone could not be loaded; empty: none.
    const std::string& problem() const { return problem_; }

private:
    struct Loaded;
    void begin(const plan::CasePlan& plan);
    void take_loaded();
    void show();

    std::string port_name_;
    std::shared_ptr<const plan::CasePlan> plan_;
    std::string files_;  ///< of the plan whose bones are loaded
    std::shared_ptr<Loaded> coming_;  ///< shared with the thread that loads
    analysis::Beside<std::string> loading_;
    std::vector<std::shared_ptr<const nodes::BodyParts>> parts_;
    std::unique_ptr<nodes::CaseBodies> bodies_;
    std::shared_ptr<observe::Observer> observer_;
    std::shared_ptr<observe::ObservedPort> port_;
    std::size_t shown_ = 0, count_ = 0;
    std::int64_t pictures_ = 0;
    std::chrono::steady_clock::time_point opened_{};
    std::string problem_;
};

}  // namespace tactus::window
