// SPDX-License-Identifier: Apache-2.0
// What a person sees of a window: where its controls are, and what the run writes. A script line `spots spots.txt` keeps the
// controls in the folder where the command works.
#pragma once

#include "tests/tools/window/person.hpp"

#include <csignal>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tactus::test {

struct Spot {
    double left, top, right, bottom;

    bool operator==(const Spot&) const = default;
};

struct Eyes {
    std::filesystem::path folder;

    std::map<std::string, Spot> spots() const;
    /// Fails the test when it is not there within 30 s.
    Spot spot(const std::string& name) const;
    /// Where it is once it does not move any more: lists scroll, and grow while a scene is being made.
    Spot resting_spot(const std::string& name) const;
    /// Waits until the window has written its controls twice more: what was done before is in them.
    void look_again() const;
    /// The last whole row of a table that a run writes, without and with its end ".part"; empty: none.
    std::vector<double> last_row(const std::string& table) const;

private:
    std::filesystem::file_time_type written() const;
    void wait_for_next() const;
};

/// Presses a control by its name.
void press(Person& person, const Eyes& eyes, const std::string& control);

/// A script that keeps the controls ten times a second for so long, then closes the window.
std::string watching_script(const std::string& begin, double seconds);

/// Waits until the window shows what was done: pictures are slow on a busy machine.
void settle(const Person& person);

/// TACTUS_KEEP_PICTURES names a folder for pictures that somebody looks at.
void keep(const Person& person, const std::string& name);

/// Sends a signal to the command that works in the folder; SIGINT ends it as Ctrl-C does.
void interrupt(const std::filesystem::path& folder, int signal = SIGINT);

/// Waits until something is to be seen, for two minutes at most: on a busy machine a window may be that late.
template <class Condition>
bool sees(Condition&& is_there) {
    for (int i = 0; i < 1200; ++i) {
        if (is_there()) return true;
        Person::wait(0.1);
    }
    return false;
}

}  // namespace tactus::test
