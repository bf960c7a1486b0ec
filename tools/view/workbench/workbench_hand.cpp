// SPDX-License-Identifier: Apache-2.0
// The hand of the patch: that of the window in place of the patch's own.
#include "tools/view/hand_of_patch.hpp"
#include "tools/view/workbench.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tactus::view {

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
    } else
        // What the command line said holds again.
        for (const std::string& setting : hand_settings_)
            if (const auto last = std::find(settings.rbegin(), settings.rend(), setting); last != settings.rend())
                settings.erase(std::next(last).base());
    if (const auto problem = check(editor_->text())) {
        settings = before;
        tell(*problem, true);
        return false;
    }
    hand_settings_ = std::move(of_hand);
    run_.reset();
    adopt();
    return true;
}

void Workbench::begin_with_hand(bool of_window) {
    if (use_hand_of_window(of_window)) run();
}

}  // namespace tactus::view
