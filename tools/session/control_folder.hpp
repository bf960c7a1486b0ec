// SPDX-License-Identifier: Apache-2.0
// The folder of the control sockets. It may stand in /tmp, where others can plant files and links, so it is checked once
// and then used by its descriptor only.
#pragma once

#include <sys/un.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::session {

/// Folder of the sockets of this user's runs: $XDG_RUNTIME_DIR/tactus, or /tmp/tactus-UID.
std::filesystem::path control_folder();

/// That folder, open. Nothing in it is changed but sockets that nobody listens to.
class ControlFolder {
public:
    enum class Missing {
        make,  ///< with access for its user only
        leave,
    };
    /// Throws Error when it is a link, somebody else's, or open to others. A missing folder that is left: no names, and
    /// no address.
    explicit ControlFolder(Missing missing);
    ~ControlFolder();
    ControlFolder(const ControlFolder&) = delete;
    ControlFolder& operator=(const ControlFolder&) = delete;

    bool is_there() const { return folder_ >= 0; }
    static std::string name_of(int process);
    /// Of a socket in this folder, whatever its path has become meanwhile. Valid as long as the folder is open.
    sockaddr_un address(const std::string& name) const;
    /// Processes whose sockets take a connection, ascending; a stopped process is among them.
    std::vector<int> listening() const;
    /// Removes sockets of runs that are no more: those that refuse a connection.
    void remove_refusing() const;
    void remove(const std::string& name) const;

    /// One process at a time binds its socket and cleans; waits at most a second. False: another one still does.
    bool lock() const;
    void unlock() const;

private:
    std::vector<std::string> names() const;
    /// What connecting to that socket gives, 0: somebody listens.
    int try_connection(const std::string& name) const;

    int folder_ = -1;
};

}  // namespace tactus::session
