// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/input_queue.hpp"

#include "tests/support/catch.hpp"

#include <string>

using namespace tactus::window;
using Kind = InputEvent::Kind;

namespace {

InputEvent move(double x, double y) { return {.kind = Kind::move, .x = x, .y = y}; }
InputEvent button(int which, bool is_down) { return {.kind = Kind::button, .code = which, .is_down = is_down}; }
InputEvent key(int which, bool is_down) { return {.kind = Kind::key, .code = which, .is_down = is_down}; }
InputEvent letter(char which) { return {.kind = Kind::letter, .code = which}; }

}  // namespace

TEST_CASE("a click within one picture is seen pressed and then released, where it was made") {
    InputQueue queue;
    for (const InputEvent& event : {move(10, 20), button(0, true), button(0, false), move(300, 200)}) queue.add(event);
    const InputState pressed = queue.next();
    CHECK(pressed.button[0]);
    CHECK(pressed.x == 10.0);
    const InputState released = queue.next();
    CHECK_FALSE(released.button[0]);
    CHECK(released.x == 10.0);
    CHECK(queue.is_waiting());
    CHECK(queue.next().x == 300.0);
    CHECK_FALSE(queue.is_waiting());
}

TEST_CASE("three clicks within one picture are three clicks") {
    InputQueue queue;
    queue.add(move(5, 5));
    for (int n = 0; n < 3; ++n) {
        queue.add(button(0, true));
        queue.add(button(0, false));
    }
    int presses = 0;
    bool was_down = false;
    while (queue.is_waiting()) {
        const bool is_down = queue.next().button[0];
        presses += is_down && !was_down;
        was_down = is_down;
    }
    CHECK(presses == 3);
}

TEST_CASE("a drag within one picture is pressed at its begin and released at its end") {
    InputQueue queue;
    for (const InputEvent& event :
         {move(1, 1), button(0, true), move(2, 1), move(3, 1), move(9, 1), button(0, false), move(50, 50)})
        queue.add(event);
    const InputState begin = queue.next();
    CHECK((begin.button[0] && begin.x == 1.0));
    const InputState end = queue.next();
    CHECK((!end.button[0] && end.x == 9.0));
    CHECK(queue.next().x == 50.0);
}

TEST_CASE("keys that are pressed and released within one picture are seen, and modifiers hold for what follows them") {
    InputQueue queue;
    for (const InputEvent& event : {key(341, true), key('S', true), key('S', false), key(341, false)}) queue.add(event);
    const InputState pressed = queue.next();
    CHECK((pressed.key['S'] && pressed.key[341]));
    const InputState released = queue.next();
    CHECK_FALSE(released.key['S']);
}

TEST_CASE("typed letters all arrive, in order, and not behind a click that follows them") {
    InputQueue queue;
    for (const char c : std::string("saw")) {
        queue.add(key(c, true));
        queue.add(letter(c));
        queue.add(key(c, false));
    }
    queue.add(button(0, true));
    queue.add(letter('!'));
    const bool is_typing = GENERATE(false, true);
    std::string typed;
    int pictures = 0;
    while (queue.is_waiting()) {
        const InputState& state = queue.next(is_typing);
        ++pictures;
        if (!state.letters.empty() && state.letters.front() == '!') CHECK(typed == "saw");
        for (const unsigned one : state.letters) typed += static_cast<char>(one);
    }
    CHECK(typed == "saw!");
    // A field takes a whole word in one picture.
    if (is_typing) CHECK(pictures == 2);
}

TEST_CASE("a key that changes a text comes behind the letters before it, and before those after it") {
    InputQueue queue;
    constexpr int backspace = 259;
    for (const InputEvent& event : {letter('a'), letter('b'), key(backspace, true), key(backspace, false), letter('c')})
        queue.add(event);
    const InputState letters = queue.next(true);
    CHECK((letters.letters.size() == 2 && !letters.key[backspace]));
    const InputState pressed = queue.next(true);
    CHECK((pressed.letters.empty() && pressed.key[backspace]));
    const InputState after = queue.next(true);
    CHECK((after.letters.size() == 1 && !after.key[backspace]));
}

TEST_CASE("a window that loses the focus releases everything, and one turn of the wheel counts once") {
    InputQueue queue;
    queue.add(key('T', true));
    queue.add(button(1, true));
    queue.next();
    queue.add({.kind = Kind::focus, .is_down = false});
    queue.add({.kind = Kind::wheel, .y = 2.0});
    const InputState after = queue.next();
    CHECK_FALSE(after.button[1]);
    CHECK(after.key.none());
    CHECK(after.wheel_y == 2.0);
    CHECK(queue.next().wheel_y == 0.0);
}

TEST_CASE("a window that was left says so until the keys before it have been seen") {
    InputQueue queue;
    const InputEvent leave{.kind = Kind::leave}, back{.kind = Kind::focus, .is_down = true};
    for (const InputEvent& event : {key(84, true), key(84, false), key(84, true), leave, back}) queue.add(event);
    CHECK(queue.waits_to_leave());
    CHECK(queue.next().key[84]);
    CHECK(queue.waits_to_leave());
    CHECK_FALSE(queue.next().key[84]);
    CHECK(queue.waits_to_leave());
    CHECK(queue.next().key[84]);
    CHECK_FALSE(queue.waits_to_leave());
}

TEST_CASE("a shortcut that is pressed and released within one picture reaches the field in which one types") {
    constexpr int left_control = 341, left_alt = 342, a = 'A';
    for (const int held : {left_control, left_alt}) {
        InputQueue queue;
        for (const InputEvent& event : {key(held, true), key(a, true), key(a, false), key(held, false)})
            queue.add(event);
        const InputState pressed = queue.next(true);
        CHECK(pressed.key[held]);
        CHECK(pressed.key[a]);
        const InputState released = queue.next(true);
        CHECK_FALSE(released.key[a]);
    }
}
