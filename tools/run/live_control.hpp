// SPDX-License-Identifier: Apache-2.0
// Changes of a running patch: saved edits of its file, and commands on the control socket.
#pragma once

#include "engine/run/engine.hpp"
#include "tools/run/control_socket.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/patch_watch.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace tactus::run {

class LiveControl {
public:
    /// `say` reports edits and failures to the user.
    LiveControl(run::Engine& engine, PatchChoice choice, compile::AssetCache& assets,
                std::function<void(const std::string&)> say);

    /// Called from LiveOptions::watch.
    void tend();

    /// Also called from there: edits the run to this text, as if the text had been saved.
    void edit(std::string text);
    /// Reports that the patch was saved as another file, which is watched from now on; its relative paths start there.
    void move_to(const std::filesystem::path& file);
    /// Presses the button `node` by incrementing its parameter 'press'. Returns the time of effect. Throws Error.
    Flicks press_button(const std::string& node);
    /// Handler of a saved file, in place of the default.
    std::function<void()> saved;

private:
    void take_over_file();
    /// `read` creates the patch, and is called on the building thread.
    void edit_to(std::function<patch::Patch(patch::Problems&)> read);
    std::string answer(const std::string& line);
    /// Sets "NODE.PARAM=VALUE". Returns the answer for the caller. Throws Error.
    std::string set(const std::string& setting);
    std::string trigger(const std::string& node);

    run::Engine& engine_;
    PatchChoice choice_;
    compile::AssetCache& assets_;
    std::function<void(const std::string&)> say_;
    std::filesystem::path file_;
    PatchWatch watch_;
    std::unique_ptr<ControlSocket> socket_;
    std::map<std::string, double> presses_;  // last value of 'press', by node
};

}  // namespace tactus::run
