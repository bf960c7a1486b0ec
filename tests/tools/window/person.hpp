// SPDX-License-Identifier: Apache-2.0
// A person at a display without a screen: events of mouse and keyboard by the XTEST extension, as a device would give them,
// and what the screen shows. The libraries are opened at run time, so that nothing needs their headers.
#pragma once

#include "tests/tools/window/on_display.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::test {

class Person {
public:
    explicit Person(const VirtualDisplay& display);
    ~Person();
    Person(const Person&) = delete;
    Person& operator=(const Person&) = delete;

    /// False without libX11 and libXtst.
    bool is_there() const;

    /// Pixels of the screen.
    void move(double x, double y);
    /// 1 left, 2 middle, 3 right, 4 and 5 the wheel.
    void button(int which, bool is_down);
    void key(const std::string& name, bool is_down);
    void click(double x, double y);
    /// Drags with a button held, in so many seconds.
    void drag(double x, double y, double to_x, double to_y, double seconds, int which = 1);
    void tap(const std::string& name);
    /// With modifiers held: "Control_L", "Shift_L".
    void chord(const std::vector<std::string>& modifiers, const std::string& name);
    void double_click(double x, double y);
    /// Letters, digits, blanks and _-./:,>" as a keyboard of the United States has them.
    void type(const std::string& text);
    static void wait(double seconds);

    /// The whole screen.
    Picture look() const;
    /// Waits until a window of that title is there; false after that time.
    bool sees_window(const std::string& title, double max_s) const;
    /// Gives the keyboard to the window of that title, or takes it from all.
    void give_keyboard(const std::string& title);
    void take_keyboard();

private:
    /// Of the window with that title; 0: there is none.
    unsigned long window(const std::string& title) const;

    struct Libraries;
    std::unique_ptr<Libraries> x_;
};

}  // namespace tactus::test

#define NEEDS_PERSON(person, display)                                          \
    NEEDS_DISPLAY(display)                                                     \
    Person person(display);                                                    \
    if (!person.is_there()) {                                                  \
        tactus::test::skip("libXtst is not installed (apt install libxtst6)"); \
        return;                                                                \
    }
