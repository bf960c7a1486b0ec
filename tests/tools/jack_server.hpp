// SPDX-License-Identifier: Apache-2.0
// A JACK server without hardware, and a client that records what others play.
#pragma once

#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <jack/jack.h>

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::test {

using namespace std::chrono_literals;

/// Tests that play run one at a time: two servers at once keep each other from their deadlines.
class Turn {
public:
    Turn()
        : file_(::open((std::filesystem::temp_directory_path() / "tactus_test_sound.lock").c_str(),
                       O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
        ::flock(file_, LOCK_EX);
    }
    ~Turn() { ::close(file_); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

private:
    int file_;
};

/// Gives this process and its children a /dev/shm of their own. JACK keeps a table of eight servers there, and a server
/// that was killed keeps its place: servers of other programs must not decide about these tests. Where this is not
/// permitted, the machine's own is used.
inline void use_own_shared_memory() {
    static bool is_done = false;
    if (std::exchange(is_done, true)) return;
    if (::unshare(CLONE_NEWNS) != 0) {
        const auto user = ::getuid();
        const auto group = ::getgid();
        if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return;
        std::ofstream("/proc/self/setgroups") << "deny";
        std::ofstream("/proc/self/uid_map") << user << ' ' << user << " 1";
        std::ofstream("/proc/self/gid_map") << group << ' ' << group << " 1";
    }
    if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return;
    static_cast<void>(::mount("tmpfs", "/dev/shm", "tmpfs", 0, "mode=1777"));
}

/// A server of our own. Nothing of it is left behind.
class Server {
public:
    Server(const Folder& folder, int period, int outputs = 2) : name("tactus_test_" + std::to_string(::getpid())) {
        use_own_shared_memory();
        folder.write("asound.conf", "pcm.!default { type null }\n");
        ::setenv("JACK_DEFAULT_SERVER", name.c_str(), 1);
        ::setenv("JACK_NO_START_SERVER", "1", 1);
        ::setenv("JACK_NO_AUDIO_RESERVATION", "1", 1);
        ::setenv("ALSA_CONFIG_PATH", (folder.path / "asound.conf").c_str(), 1);
        jack_set_error_function([](const char*) {});
        jack_set_info_function([](const char*) {});
        log_ = (folder.path / "jackd.log").string();
        outputs_ = std::to_string(outputs);
        start(period);
    }
    ~Server() {
        if (was_killed_) {
            // Only a server of the same name that ends in order gives back the place that this one has in JACK's table
            // of eight.
            start(256);
            for (int i = 0; i < 100 && !has_client(); ++i) std::this_thread::sleep_for(20ms);
        }
        end(SIGTERM);
        static_cast<void>(std::system(("rm -f /dev/shm/jack_sem.*_" + name + "_*").c_str()));
    }
    void end(int how) {
        if (pid_ <= 0) return;
        was_killed_ = how == SIGKILL;
        ::kill(pid_, how);
        ::waitpid(pid_, nullptr, 0);
        pid_ = 0;
    }

    /// What the server said, for the message of a failed check.
    std::string said() const { return slurp(log_); }

    std::string name;

private:
    void start(int period) {
        const std::string frames = std::to_string(period), &log = log_;
        pid_ = ::fork();
        if (pid_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGTERM);
            if (!std::freopen(log.c_str(), "w", stdout) || !std::freopen(log.c_str(), "w", stderr)) ::_exit(1);
            // Synchronous: the server waits for late clients instead of leaving them out.
            ::execlp("jackd", "jackd", "-n", name.c_str(), "-S", "-r", "-m", "-t", "5000", "-d", "dummy", "-r", "48000",
                     "-p", frames.c_str(), "-C", "2", "-P", outputs_.c_str(), nullptr);
            ::_exit(1);
        }
    }
    static bool has_client() {
        jack_client_t* client = jack_client_open("probe", JackNoStartServer, nullptr);
        if (client != nullptr) jack_client_close(client);
        return client != nullptr;
    }

    Turn turn_;
    std::string log_, outputs_;
    bool was_killed_ = false;
    pid_t pid_ = 0;
};

/// A client that records what its ports hear.
class Recorder {
public:
    explicit Recorder(int ports = 1) : ports_(static_cast<std::size_t>(ports)), heard_(48000 * 20 * ports_.size()) {
        for (int i = 0; i < 200 && client_ == nullptr; ++i) {
            client_ = jack_client_open("recorder", JackNoStartServer, nullptr);
            if (client_ == nullptr) std::this_thread::sleep_for(50ms);
        }
        if (client_ == nullptr) return;
        for (std::size_t k = 0; k < ports_.size(); ++k)
            ports_[k] = jack_port_register(client_, ("in" + std::to_string(k)).c_str(), JACK_DEFAULT_AUDIO_TYPE,
                                           JackPortIsInput, 0);
        jack_set_process_callback(
            client_, [](jack_nframes_t n, void* self) { return static_cast<Recorder*>(self)->hear(n); }, this);
        jack_activate(client_);
    }
    ~Recorder() {
        if (client_ != nullptr) jack_client_close(client_);
    }
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    bool is_there() const { return client_ != nullptr; }
    bool listen_to(const char* port, std::size_t with = 0) {
        for (int i = 0; i < 4000; ++i, std::this_thread::sleep_for(5ms))
            if (jack_port_by_name(client_, port) != nullptr)
                return jack_connect(client_, port, jack_port_name(ports_[with])) == 0;
        return false;
    }
    void freewheel(bool on) { jack_set_freewheel(client_, on ? 1 : 0); }
    void wait_for(std::size_t frames) const {
        for (int i = 0; i < 4000 && count_.load() < frames; ++i) std::this_thread::sleep_for(5ms);
    }
    /// What port `k` heard, from the first sound of any port on. After the player ended.
    std::vector<float> heard(std::size_t k = 0) const {
        std::vector<float> sound(count_.load());
        for (std::size_t i = 0; i < sound.size(); ++i) sound[i] = heard_[i * ports_.size() + k];
        return sound;
    }

private:
    int hear(jack_nframes_t n) {
        std::size_t count = count_.load(std::memory_order_relaxed);
        for (jack_nframes_t i = 0; i < n && (count + 1) * ports_.size() <= heard_.size(); ++i) {
            bool sounds = count > 0;
            for (std::size_t k = 0; k < ports_.size(); ++k) {
                const float x = static_cast<const float*>(jack_port_get_buffer(ports_[k], n))[i];
                heard_[count * ports_.size() + k] = x;
                sounds = sounds || x != 0.0F;
            }
            count += sounds ? 1 : 0;
        }
        count_.store(count, std::memory_order_release);
        return 0;
    }

    jack_client_t* client_ = nullptr;
    std::vector<jack_port_t*> ports_;
    std::vector<float> heard_;  // frames
    std::atomic<std::size_t> count_{0};
};

inline bool has_server() {
    if (std::system("command -v jackd >/dev/null") == 0) return true;
    skip("no JACK server (apt-get install jackd2)");
    return false;
}

}  // namespace tactus::test
