// SPDX-License-Identifier: Apache-2.0
// The folder of the control sockets. It may be in /tmp, where other users can create files and links, so that it is
// checked once and then accessed only by its descriptor.
#pragma once

#include <sys/un.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::run {

/// Folder of the sockets of this user's runs: $XDG_RUNTIME_DIR/tactus, or /tmp/tactus-UID.
std::filesystem::path control_folder();

/// The open folder. Only stale sockets in it are removed.
class ControlFolder {
public:
    enum class Missing {
        make,  ///< with access for the user only
        leave,
    };
    /// Throws Error if it is a link, belongs to another user, or is accessible to others. A missing folder that is not
    /// created has no names and no address.
    explicit ControlFolder(Missing missing);
    ~ControlFolder();
    ControlFolder(const ControlFolder&) = delete;
    ControlFolder& operator=(const ControlFolder&) = delete;

    bool is_there() const { return folder_ >= 0; }
    static std::string name_of(int process);
    /// The address of a socket in this folder, valid even if the path changes. Valid while the folder is open.
    sockaddr_un address(const std::string& name) const;
    /// Processes whose sockets accept a connection, ascending; includes stopped processes.
    std::vector<int> listening() const;
    /// Removes stale sockets, which refuse a connection.
    void remove_refusing() const;
    void remove(const std::string& name) const;

    /// Locks the folder, so that only one process at a time binds and cleans; waits at most 1 s. Returns false if
    /// another process holds the lock.
    bool lock() const;
    void unlock() const;

private:
    std::vector<std::string> names() const;
    /// Returns the errno of connecting to that socket; 0: a process listens.
    int try_connection(const std::string& name) const;

    int folder_ = -1;
};

}  // namespace tactus::run
