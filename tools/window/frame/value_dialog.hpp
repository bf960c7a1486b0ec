// SPDX-License-Identifier: Apache-2.0
// A dialog that asks for one value, for hands on the keyboard.
#pragma once

#include <functional>
#include <string>

namespace tactus::window {

struct ValueQuestion {
    std::string what;   ///< "level of the trigger of scope 1"
    std::string value;  ///< at first, with its unit
    std::function<void(const std::string&)> take;  ///< throws Error to refuse: the dialog stays, and says why
};

class ValueDialog {
public:
    void ask(ValueQuestion question);
    /// Once per picture.
    void draw();

private:
    /// True: the value is taken.
    bool enter();

    ValueQuestion question_;
    std::string refusal_;
    bool is_asked_ = false, wants_focus_ = false;
};

}  // namespace tactus::window
