// SPDX-License-Identifier: Apache-2.0
// Walks: a job that a person does with mouse and keyboard from its beginning to its end. Each is walked in the smallest
// window, which is drawn soonest and has the least room; TACTUS_WALKS=all walks it in every one, TACTUS_WALKS=1600x1000
// in that one.
#pragma once

#include "tests/tools/window/eyes.hpp"

#include <functional>
#include <future>
#include <string>
#include <vector>

namespace tactus::test {

struct WalkWindow {
    int width, height;
    double scale;

    /// "800x600", "2560x1600": of TACTUS_WALKS and of pictures.
    std::string name() const;
};
inline constexpr WalkWindow small_window{800, 600, 1.0}, usual_window{1600, 1000, 1.0}, dense_window{2560, 1600, 2.0};

/// `small_window`, or those that TACTUS_WALKS names.
std::vector<WalkWindow> walk_windows();

/// A person at a window of that size.
class Walk {
public:
    /// `what`: of the pictures' names.
    Walk(const WalkWindow& window, std::string what);
    ~Walk();
    Walk(const Walk&) = delete;
    Walk& operator=(const Walk&) = delete;

    /// False: without Xvfb or libXtst; says so.
    bool is_possible() const;
    /// Begins the command in its folder. The patch that the window shows is kept in shown.toml. The window closes after
    /// so many seconds.
    void start(const std::string& arguments, double seconds);
    /// The same with a script of its own, after the lines that give the window its size.
    void start_script(const std::string& arguments, const std::string& script, double seconds);
    /// Waits for the command's end; at most for so many seconds, then it is interrupted.
    Outcome end(double max_s = 20.0);
    /// Ends the command as Ctrl-C does.
    Outcome stop();
    /// Ends it at once, as a crash does: kill -9.
    void kill();

    bool shows(const std::string& control) const;
    /// Waits for it, for two minutes at most. With a panel: turns the wheel over it until the control is there.
    bool waits_for(const std::string& control, const std::string& panel = {});
    bool waits_while(const std::string& control) const;
    /// Presses a control; turns the wheel over the panel where it must be until it is there.
    void press(const std::string& control, const std::string& panel = {});
    /// Clicks places of the scene until two of them are measured.
    void measure();
    /// Does one thing through the list of commands.
    void command(const std::string& words);
    /// Repeats what a person does until its effect is seen, at most four times.
    bool until(const std::function<bool()>& is_seen, const std::function<void()>& act);
    /// What the window shows of the patch, and whether a wire or a line is in it.
    bool shows_text(const std::string& part) const;
    void keep(const std::string& name);

    WalkWindow window;
    Folder folder;
    VirtualDisplay display;
    Person person;
    Eyes eyes;

private:
    bool scroll_to(const std::string& control, const std::string& panel);

    std::string what_;
    int pictures_ = 0;
    std::future<Outcome> done_;
};

}  // namespace tactus::test
