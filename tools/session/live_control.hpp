// SPDX-License-Identifier: Apache-2.0
// What changes a patch while it runs: its file being saved, and lines on the control socket.
#pragma once

#include "engine/run/engine.hpp"
#include "tools/session/control_socket.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/session/patch_watch.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace tactus::session {

class LiveControl {
public:
    /// `say` tells the user of edits and of why one was not made.
    LiveControl(run::Engine& engine, PatchChoice choice, compile::AssetCache& assets,
                std::function<void(const std::string&)> say);

    /// From LiveOptions::watch.
    void tend();

    /// From there, too: this text takes over, as if it had been saved.
    void edit(std::string text);
    /// Who takes over what was saved, instead of this.
    std::function<void()> saved;

private:
    void take_over_file();
    std::string answer(const std::string& line);
    /// "NODE.PARAM=VALUE". Returns what the caller is told. Throws Error.
    std::string set(const std::string& setting);
    /// Presses the button `node`: its parameter 'press' counts up. Returns what the caller is told. Throws Error.
    std::string trigger(const std::string& node);

    run::Engine& engine_;
    PatchChoice choice_;
    compile::AssetCache& assets_;
    std::function<void(const std::string&)> say_;
    std::filesystem::path file_;
    PatchWatch watch_;
    std::unique_ptr<ControlSocket> socket_;
    std::map<std::string, double> presses_;  // by node: what 'press' was set to last
};

}  // namespace tactus::session
