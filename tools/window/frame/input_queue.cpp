// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/input_queue.hpp"

#include <algorithm>

namespace tactus::window {

using Kind = InputEvent::Kind;

void InputQueue::add(const InputEvent& event) {
    // A mouse that only moves needs no history.
    if (event.kind == Kind::move && !waiting_.empty() && waiting_.back().kind == Kind::move) waiting_.back() = event;
    else waiting_.push_back(event);
}

bool InputQueue::waits_to_leave() const {
    return std::ranges::any_of(waiting_, [](const InputEvent& event) {
        return event.kind == Kind::leave || (event.kind == Kind::focus && !event.is_down);
    });
}

void InputQueue::take(const InputEvent& event) {
    const auto code = static_cast<std::size_t>(event.code);
    switch (event.kind) {
        case Kind::move:
            state_.x = event.x;
            state_.y = event.y;
            state_.is_inside = true;
            break;
        case Kind::leave: state_.is_inside = false; break;
        case Kind::button:
            if (code < InputState::buttons) state_.button[code] = event.is_down;
            break;
        case Kind::wheel:
            state_.wheel_x += event.x;
            state_.wheel_y += event.y;
            break;
        case Kind::key:
            if (code < InputState::keys) state_.key[code] = event.is_down;
            break;
        case Kind::letter: state_.letters.push_back(static_cast<unsigned>(event.code)); break;
        case Kind::focus:
            // Who leaves the window releases everything elsewhere.
            if (!event.is_down) {
                state_.button = {};
                state_.key.reset();
            }
            break;
    }
}

namespace {

// Of GLFW: Enter, arrows, modifiers, …
constexpr int first_control_key = 256, left_control = 341, left_alt = 342, right_control = 345;

/// The other Alt writes letters on many keyboards.
bool has_control(const InputState& state) {
    return state.key[left_control] || state.key[right_control] || state.key[left_alt];
}

}  // namespace

const InputState& InputQueue::next(bool is_typing) {
    state_.wheel_x = state_.wheel_y = 0.0;
    state_.letters.clear();
    std::array<bool, InputState::buttons> clicked{};
    std::bitset<InputState::keys> pressed;
    bool has_clicked = false, has_key = false, has_wheel = false;
    while (!waiting_.empty()) {
        const InputEvent& event = waiting_.front();
        const auto code = static_cast<std::size_t>(event.code);
        switch (event.kind) {
            // A button is where it was pressed or released.
            case Kind::move:
            case Kind::leave:
                if (has_clicked || has_wheel) return state_;
                break;
            case Kind::button:
                if (code < clicked.size() && clicked[code]) return state_;
                if (has_wheel) return state_;
                if (code < clicked.size()) clicked[code] = true;
                has_clicked = true;
                break;
            case Kind::wheel:
                if (has_clicked) return state_;
                has_wheel = true;
                break;
            case Kind::key:
                if (has_clicked) return state_;
                // Letters come by themselves, but not those of a shortcut: "choose all" of a field.
                if (is_typing && event.code < first_control_key && !has_control(state_)) break;
                if (code < pressed.size() && pressed[code]) return state_;
                // Letters come before a key that ends or changes the text.
                if (event.is_down && !state_.letters.empty()) return state_;
                if (code < pressed.size()) pressed[code] = true;
                has_key = has_key || event.is_down;
                break;
            case Kind::letter:
                // The field may be another one after a click, and the text another one after a key.
                if (has_clicked || (is_typing && has_key)) return state_;
                break;
            case Kind::focus:
                if (has_clicked || has_key) return state_;
                break;
        }
        take(event);
        waiting_.pop_front();
    }
    return state_;
}

}  // namespace tactus::window
