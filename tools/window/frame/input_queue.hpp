// SPDX-License-Identifier: Apache-2.0
// Events of mouse and keyboard, one edge for each button and key in a picture: however slow pictures are, no click and no
// key is lost, and a click is where it was made. No user interface.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <deque>
#include <vector>

namespace tactus::window {

struct InputEvent {
    enum class Kind { move, leave, button, wheel, key, letter, focus } kind = Kind::move;
    double x = 0.0, y = 0.0;  ///< of `move`: pixels; of `wheel`: turns
    int code = 0;  ///< button, key or letter
    bool is_down = false;  ///< of buttons and keys; of `focus`: gained
};

/// What a picture sees.
struct InputState {
    static constexpr std::size_t buttons = 5, keys = 512;

    double x = 0.0, y = 0.0;
    bool is_inside = false;
    double wheel_x = 0.0, wheel_y = 0.0;  ///< in this picture
    std::array<bool, buttons> button{};
    std::bitset<keys> key;
    std::vector<unsigned> letters;  ///< in this picture
};

class InputQueue {
public:
    /// Of a callback, in order.
    void add(const InputEvent& event);
    /// For the next picture: takes events up to the first that would hide another one. `is_typing`: a field takes letters,
    /// so that the keys that make them need no picture of their own.
    const InputState& next(bool is_typing = false);
    /// True while events wait for a later picture.
    bool is_waiting() const { return !waiting_.empty(); }
    /// True while a later picture will see the person leave the window: what it sees before that was done before.
    bool waits_to_leave() const;

private:
    void take(const InputEvent& event);

    std::deque<InputEvent> waiting_;
    InputState state_;
};

}  // namespace tactus::window
