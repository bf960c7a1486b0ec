// SPDX-License-Identifier: Apache-2.0
// How another program talks to a patch that runs: lines of text over a local socket that only its user can reach.
#pragma once

#include "tools/session/control_folder.hpp"

#include <functional>
#include <string>
#include <vector>

namespace tactus::session {

/// The run's side.
class ControlSocket {
public:
    /// Listens as PID.socket in `control_folder`. Throws Error.
    ControlSocket();
    ~ControlSocket();
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    /// Answers every whole line that has come with what `answer` makes of it. Never waits.
    void serve(const std::function<std::string(const std::string& line)>& answer);

private:
    struct Caller {
        int descriptor;
        std::string received;
    };
    bool listen_to(Caller& caller, const std::function<std::string(const std::string&)>& answer);

    ControlFolder folder_;
    std::string name_;
    int descriptor_ = -1;
    std::vector<Caller> callers_;
};

/// The other side: sends one line to a run and returns its answer. `process` 0: the only one that runs. Throws Error
/// when there is none, several, it is not this user's, or it does not answer within 5 s.
std::string ask_run(int process, const std::string& line);

}  // namespace tactus::session
