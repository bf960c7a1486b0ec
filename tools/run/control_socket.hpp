// SPDX-License-Identifier: Apache-2.0
// Remote control of a running patch: lines of text over a local socket that only its user can access.
#pragma once

#include "tools/run/control_folder.hpp"

#include <functional>
#include <string>
#include <vector>

namespace tactus::run {

/// The server side, in the run.
class ControlSocket {
public:
    /// Listens as PID.socket in `control_folder`. Throws Error.
    ControlSocket();
    ~ControlSocket();
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    /// Answers every complete line with `answer`(line). Does not block.
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

/// The client side: sends one line to a run and returns its answer. `process` 0: the only run. Throws Error when there
/// is no run, several, one of another user, or no answer within 5 s.
std::string ask_run(int process, const std::string& line);

}  // namespace tactus::run
