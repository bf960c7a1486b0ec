// SPDX-License-Identifier: Apache-2.0
// The hand of the patch: that of the window in place of the patch's own.
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/window/document/hand_of_patch.hpp"
#include "tools/window/document/plan_document.hpp"
#include "tools/window/document/workbench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr const char* window_driver = "mouse";

}  // namespace

bool Workbench::can_take_hand() const {
    if (!plan_ || has_taken_hand()) return false;
    const std::optional<HandOfPatch> hand = hand_of(*plan_);
    return hand && hand->driver != window_driver;
}

bool Workbench::use_hand_of_window(bool wanted) {
    if (wanted == has_taken_hand() || (wanted && !can_take_hand())) return false;
    std::vector<std::string>& settings = choice_.overrides.settings;
    const std::vector<std::string> before = settings;
    std::vector<std::string> of_hand;
    if (wanted) {
        const auto& devices = plan_->patch.devices;
        const auto declared = std::ranges::find(devices, window_driver, &patch::PatchDevice::driver);
        const std::string device = declared == devices.end() ? window_driver : declared->name;
        const std::vector<std::string> nodes = hand_of(*plan_).value().nodes;
        for (const std::string& node : nodes) of_hand.push_back(node + ".device=" + device);
        settings.insert(settings.end(), of_hand.begin(), of_hand.end());
    } else without_last(settings, hand_settings_);  // what the command line said holds again
    if (const auto problem = check(editor_->text())) {
        settings = before;
        tell(*problem, true);
        return false;
    }
    hand_settings_ = std::move(of_hand);
    if (is_recording())
        tell(fmt::format("the recording into {} ends here: the run begins again", last_take_.string()), true);
    run_.reset();
    adopt();
    return true;
}

void without_last(std::vector<std::string>& all, const std::vector<std::string>& some) {
    for (const std::string& one : some)
        if (const auto last = std::find(all.rbegin(), all.rend(), one); last != all.rend())
            all.erase(std::next(last).base());
}

void Workbench::change_hand() {
    if (!wanted_hand_ || (is_settled && !is_settled())) return;
    begin_with_hand(*std::exchange(wanted_hand_, std::nullopt));
}

void Workbench::begin_with_hand(bool of_window) {
    const std::vector<std::string> assets = choice_.overrides.assets;
    // The run goes on with the plan that it has changed.
    const auto scene = std::ranges::find(written_.nodes, "case_scene", &patch::PatchNode::type);
    const std::shared_ptr<const RunStatus> now = status();
    if (scene != written_.nodes.end() && now->plan) {
        const auto plan = std::ranges::find(scene->settings, "plan", &OptionText::name);
        if (plan != scene->settings.end()) try {
                const fs::path copy = fs::absolute(free_plan(now->folder));
                plan::save_case_plan(*now->plan, copy);
                use_asset(plan->text, copy);
                next_goes_on_ = true;
            } catch (const Error& error) {
                return tell(error.what(), true);
            }
    }
    if (use_hand_of_window(of_window)) return run();
    choice_.overrides.assets = assets;
    next_goes_on_ = false;
}

}  // namespace tactus::window
