// SPDX-License-Identifier: Apache-2.0
// The control socket touches nothing but dead sockets, and takes no folder that others can reach.
#include "tools/run/control_socket.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstring>
#include <fstream>
#include <string>

using namespace tactus;
using tactus::test::Folder;
using tactus::test::Run;
using tactus::test::slurp;
using tactus::test::wait_for;

namespace {

namespace fs = std::filesystem;

/// $XDG_RUNTIME_DIR, a scratch folder for as long as this lives.
struct Runtime {
    Folder folder;
    fs::path sockets = folder.path / "tactus";

    Runtime() { ::setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1); }
    ~Runtime() { ::unsetenv("XDG_RUNTIME_DIR"); }
    void make(mode_t mode = 0700) const {
        fs::create_directory(sockets);
        ::chmod(sockets.c_str(), mode);
    }
};

mode_t mode_of(const fs::path& path) {
    struct stat status{};
    return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 0777 : 0;
}

/// A socket file whose process is gone.
void leave_socket(const fs::path& path) {
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path.c_str());
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::close(socket);
}

const std::string half_patch = "[nodes.half]\ntype = \"constant\"\nrate = \"1 kHz\"\nnumber = 0.5\n";

}  // namespace

TEST_CASE("a folder that is a link is left alone: nothing behind it is removed, and its rights stay") {
    const Runtime runtime;
    const fs::path documents = runtime.folder.path / "documents";
    fs::create_directories(documents / "letters");
    std::ofstream(documents / "thesis.tex") << "text";
    std::ofstream(documents / "1.socket") << "no socket";
    ::chmod(documents.c_str(), 0755);
    fs::create_directory_symlink(documents, runtime.sockets);
    CHECK_THROWS_WITH(run::ControlSocket(), Catch::Matchers::ContainsSubstring("it is a link"));
    CHECK_THROWS_WITH(run::ask_run(0, "set a.b=1"), Catch::Matchers::ContainsSubstring("it is a link"));
    // As a program that knows nothing of this folder meets it.
    const std::string file = runtime.folder.write("p.toml", half_patch).string();
    CHECK(runtime.folder
              .tactus("run " + file + " --audio none --seconds 0.1 --out " + (runtime.folder.path / "out").string())
              .code == 0);
    CHECK(slurp(documents / "thesis.tex") == "text");
    CHECK(fs::exists(documents / "1.socket"));
    CHECK(fs::exists(documents / "letters"));
    CHECK(mode_of(documents) == 0755);
}

TEST_CASE("a folder that others have access to is refused and keeps its rights") {
    const Runtime runtime;
    runtime.make(0755);
    CHECK_THROWS_WITH(run::ControlSocket(), Catch::Matchers::ContainsSubstring("others have access"));
    CHECK_THROWS_WITH(run::ask_run(0, "set a.b=1"), Catch::Matchers::ContainsSubstring("others have access"));
    CHECK(mode_of(runtime.sockets) == 0755);
    if (::getuid() != 0) return;
    ::chmod(runtime.sockets.c_str(), 0700);
    REQUIRE(::chown(runtime.sockets.c_str(), 65534, 65534) == 0);
    CHECK_THROWS_WITH(run::ControlSocket(), Catch::Matchers::ContainsSubstring("another user"));
}

TEST_CASE("only sockets of processes that are gone are removed") {
    const Runtime runtime;
    runtime.make();
    const std::string own = run::ControlFolder::name_of(::getpid());
    std::ofstream(runtime.sockets / "notes.txt") << "text";
    std::ofstream(runtime.sockets / "999999.socket") << "no socket";
    fs::create_directory(runtime.sockets / "999998.socket");
    fs::create_symlink(runtime.sockets / "notes.txt", runtime.sockets / "999997.socket");
    leave_socket(runtime.sockets / "999996.socket");
    leave_socket(runtime.sockets / "x999995.socket");
    leave_socket(runtime.sockets / own);
    {
        const run::ControlSocket socket;
        CHECK(fs::is_socket(runtime.sockets / own));
        CHECK_FALSE(fs::exists(runtime.sockets / "999996.socket"));
        for (const char* kept : {"notes.txt", "999999.socket", "999998.socket", "999997.socket", "x999995.socket"}) {
            INFO(kept);
            CHECK(fs::exists(fs::symlink_status(runtime.sockets / kept)));
        }
        CHECK(slurp(runtime.sockets / "notes.txt") == "text");
        CHECK(run::ControlFolder(run::ControlFolder::Missing::leave).listening() == std::vector<int>{::getpid()});
    }
    CHECK_FALSE(fs::exists(runtime.sockets / own));
}

TEST_CASE("a new folder is for its user only, whatever its path's length") {
    const Runtime runtime;
    const fs::path deep = runtime.folder.path / std::string(120, 'd');
    fs::create_directory(deep);
    ::setenv("XDG_RUNTIME_DIR", deep.c_str(), 1);
    const run::ControlSocket socket;
    CHECK(mode_of(deep / "tactus") == 0700);
    CHECK(fs::is_socket(deep / "tactus" / run::ControlFolder::name_of(::getpid())));
}

TEST_CASE("a run that is stopped keeps its socket while another begins and ends", "[slow]") {
    const Runtime runtime;
    const Folder& folder = runtime.folder;
    const std::string file = folder.write("p.toml", half_patch).string();
    Run run(folder, file + " --audio none --out " + (folder.path / "first").string());
    REQUIRE(wait_for([&] { return fs::exists(runtime.sockets) && !fs::is_empty(runtime.sockets); }));
    const std::string socket = fs::directory_iterator(runtime.sockets)->path().filename();
    ::kill(std::stoi(socket), SIGSTOP);
    CHECK(
        folder.tactus("run " + file + " --audio none --seconds 0.2 --out " + (folder.path / "second").string()).code ==
        0);
    CHECK(fs::exists(runtime.sockets / socket));
    ::kill(std::stoi(socket), SIGCONT);
    CHECK(folder.tactus("set half.number=0.25").code == 0);
    CHECK(run.stop(SIGINT) == 0);
}

TEST_CASE("a run without a folder for its socket says so and runs") {
    const Runtime runtime;
    runtime.make(0777);
    const std::string file = runtime.folder.write("p.toml", half_patch).string();
    const auto ran = runtime.folder.tactus("run " + file + " --audio none --seconds 0.1 --out " +
                                           (runtime.folder.path / "out").string());
    CHECK(ran.code == 0);
    CHECK(ran.err.find("cannot reach this run") != std::string::npos);
    CHECK(mode_of(runtime.sockets) == 0777);
}
