// SPDX-License-Identifier: Apache-2.0
// A JACK server without hardware; a second client records what the command plays.
#include "assets/sound/sound.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <jack/jack.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <future>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

using namespace std::chrono_literals;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

const std::string tone = R"(title = "tone"
wires = [ "tone.signal -> speaker.signal" ]
[nodes.tone]
type = "sine"
rate = "48 kHz"
frequency = "441.7 Hz"
[nodes.speaker]
type = "audio_output"
rate = "48 kHz"
)";

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
void use_own_shared_memory() {
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
    Server(const Folder& folder, int period) : name("tactus_test_" + std::to_string(::getpid())) {
        use_own_shared_memory();
        folder.write("asound.conf", "pcm.!default { type null }\n");
        ::setenv("JACK_DEFAULT_SERVER", name.c_str(), 1);
        ::setenv("JACK_NO_START_SERVER", "1", 1);
        ::setenv("JACK_NO_AUDIO_RESERVATION", "1", 1);
        ::setenv("ALSA_CONFIG_PATH", (folder.path / "asound.conf").c_str(), 1);
        jack_set_error_function([](const char*) {});
        jack_set_info_function([](const char*) {});
        log_ = (folder.path / "jackd.log").string();
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
                     "-p", frames.c_str(), "-C", "2", "-P", "2", nullptr);
            ::_exit(1);
        }
    }
    static bool has_client() {
        jack_client_t* client = jack_client_open("probe", JackNoStartServer, nullptr);
        if (client != nullptr) jack_client_close(client);
        return client != nullptr;
    }

    Turn turn_;
    std::string log_;
    bool was_killed_ = false;
    pid_t pid_ = 0;
};

class Recorder {
public:
    Recorder() : heard_(48000 * 20) {
        for (int i = 0; i < 200 && client_ == nullptr; ++i) {
            client_ = jack_client_open("recorder", JackNoStartServer, nullptr);
            if (client_ == nullptr) std::this_thread::sleep_for(50ms);
        }
        if (client_ == nullptr) return;
        port_ = jack_port_register(client_, "in", JACK_DEFAULT_AUDIO_TYPE, JackPortIsInput, 0);
        jack_set_process_callback(
            client_, [](jack_nframes_t n, void* self) { return static_cast<Recorder*>(self)->hear(n); }, this);
        jack_activate(client_);
    }
    ~Recorder() {
        if (client_ != nullptr) jack_client_close(client_);
    }
    bool is_there() const { return client_ != nullptr; }
    bool listen_to(const char* port) {
        for (int i = 0; i < 4000; ++i, std::this_thread::sleep_for(5ms))
            if (jack_port_by_name(client_, port) != nullptr)
                return jack_connect(client_, port, jack_port_name(port_)) == 0;
        return false;
    }
    void freewheel(bool on) { jack_set_freewheel(client_, on ? 1 : 0); }
    void wait_for(std::size_t frames) const {
        for (int i = 0; i < 4000 && count_.load() < frames; ++i) std::this_thread::sleep_for(5ms);
    }
    /// From the first sound on. After the player ended.
    std::vector<float> heard() const {
        return {heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(count_.load())};
    }

private:
    int hear(jack_nframes_t n) {
        const auto* in = static_cast<const float*>(jack_port_get_buffer(port_, n));
        std::size_t count = count_.load(std::memory_order_relaxed);
        for (jack_nframes_t i = 0; i < n; ++i)
            if ((count > 0 || in[i] != 0.0F) && count < heard_.size()) heard_[count++] = in[i];
        count_.store(count, std::memory_order_release);
        return 0;
    }

    jack_client_t* client_ = nullptr;
    jack_port_t* port_ = nullptr;
    std::vector<float> heard_;
    std::atomic<std::size_t> count_{0};
};

bool has_server() {
    if (std::system("command -v jackd >/dev/null") == 0) return true;
    tactus::test::skip("no JACK server (apt-get install jackd2)");
    return false;
}

std::vector<float> rendered(const Folder& folder, const std::string& patch) {
    const Outcome done =
        folder.tactus("render " + patch + " --seconds 1.5 --overwrite --out " + (folder.path / "r").string());
    INFO(done.err);
    REQUIRE(done.code == 0);
    const tactus::sound::Sound sound = tactus::sound::load_sound(folder.path / "r/speaker.wav");
    std::vector<float> samples(sound.samples.begin(), sound.samples.end());
    return {std::ranges::find_if(samples, [](float x) { return x != 0.0F; }), samples.end()};
}

/// Plays while the recorder listens; false when this machine was too busy to play without a gap.
bool plays_the_same(const Folder& folder, int period, bool freewheel, const std::vector<float>& wanted) {
    Server server(folder, period);
    Recorder recorder;
    INFO(server.said());
    REQUIRE(recorder.is_there());
    const std::string out = (folder.path / "live").string();
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run " + (folder.path / "tone.toml").string() +
                             " --seconds 1.5 --audio default --audio-margin 500 --overwrite --out " + out);
    });
    const bool listens = recorder.listen_to("PortAudio:out_0");
    if (listens && freewheel) {
        recorder.freewheel(true);
        // Leaving a server that freewheels takes a client ten seconds: it goes back to the usual pace before.
        recorder.wait_for(wanted.size());
        recorder.freewheel(false);
    }
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(listens);
    const json summary = json::parse(slurp(folder.path / "live/summary.json")), sound = summary["sound"][0];
    INFO(sound.dump());
    if (sound["underflows"] > 0 || sound["frames_dropped"] > 0 || sound["frames_left_out"] > 0 ||
        summary["groups"][0]["skipped"] > 0)
        return false;
    CHECK(sound["largest_callback"] == period);
    std::vector<float> heard = recorder.heard();
    REQUIRE(heard.size() >= wanted.size());
    heard.resize(wanted.size());
    CHECK(heard == wanted);
    return true;
}

void check_playing(bool freewheel, std::initializer_list<int> periods) {
    if (!has_server()) return;
    const Folder folder;
    const std::vector<float> wanted = rendered(folder, folder.write("tone.toml", tone).string());
    REQUIRE(wanted.size() > 70'000);
    for (const int period : periods) {
        INFO("period " << period);
        bool played = false;
        for (int attempt = 0; attempt < 3 && !played; ++attempt)
            played = plays_the_same(folder, period, freewheel, wanted);
        if (!played)
            tactus::test::skip("this machine was too busy to play without gaps, period " + std::to_string(period));
    }
}

}  // namespace

TEST_CASE("what a second client records of a live run is the offline render, sample by sample", "[live]") {
    check_playing(false, {16, 64, 100, 256, 1024});
}

TEST_CASE("a server in freewheel gets every sample, too", "[live]") { check_playing(true, {64, 1024}); }

TEST_CASE("a server that dies leaves a run that ends by itself, silent, with faded forces and a whole take", "[live]") {
    if (!has_server()) return;
    const Folder folder;
    Server server(folder, 256);
    auto recorder = std::make_unique<Recorder>();
    INFO(server.said());
    REQUIRE(recorder->is_there());
    const std::string out = (folder.path / "live").string(), take = (folder.path / "take").string();
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run saw-training --seconds 4 --audio default --out " + out + " --record " + take);
    });
    CHECK(recorder->listen_to("PortAudio:out_0"));
    recorder.reset();
    std::this_thread::sleep_for(1500ms);
    server.end(SIGKILL);
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 3);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    INFO(summary["sound"].dump() << summary["notices"].dump());
    CHECK(summary["sound"][0]["losses"] == 1);
    CHECK(summary["notices"].dump().find("was lost") != std::string::npos);
    CHECK(summary["faults"].dump().find("the sound card was lost") != std::string::npos);
    const Outcome again = folder.tactus("replay " + take);
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}

TEST_CASE("an output that an edit makes anew plays on through the card that is open", "[live]") {
    if (!has_server()) return;
    const Folder folder;
    Server server(folder, 256);
    {
        const Recorder there;
        INFO(server.said());
        REQUIRE(there.is_there());
    }
    const std::string patch = folder.write("tone.toml", tone).string(), out = (folder.path / "live").string();
    auto playing = std::async(std::launch::async, [&] {
        return folder.tactus("run " + patch + " --seconds 2.5 --audio default --out " + out);
    });
    std::this_thread::sleep_for(1000ms);
    std::string renamed = tone;
    for (std::size_t at = 0; (at = renamed.find("speaker", at)) != std::string::npos; at += 3)
        renamed.replace(at, 7, "ear");
    folder.write("tone.toml", renamed);
    const Outcome outcome = playing.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json summary = json::parse(slurp(folder.path / "live/summary.json"));
    INFO(summary.dump());
    CHECK(outcome.err.find("edit 1 takes effect") != std::string::npos);
    REQUIRE(summary["sound"].size() == 1);
    CHECK(summary["sound"][0]["frames_written"] > 90'000);
}

TEST_CASE("a card that is not there, or cannot go at the asked pace, is an error that says so", "[live]") {
    const Folder folder;
    const std::string patch = folder.write("tone.toml", tone).string(), out = (folder.path / "live").string();
    const Outcome missing = folder.tactus("run " + patch + " --seconds 0.1 --audio nobody-has-this --out " + out);
    CHECK(missing.code == 2);
    CHECK(missing.err.find("sound output") != std::string::npos);
    const Outcome slow = folder.tactus("run " + patch + " --seconds 0.1 --audio default --dilate 2 --out " + out);
    CHECK(slow.code == 2);
    CHECK(slow.err.find("--dilate") != std::string::npos);
}

TEST_CASE("sound goes to a file or nowhere when asked to", "[live]") {
    const Folder folder;
    const std::string patch = folder.write("tone.toml", tone).string();
    for (const char* where : {"file", "none"}) {
        const std::string out = (folder.path / where).string();
        const Outcome outcome = folder.tactus("run " + patch + " --seconds 0.1 --audio " + where + " --out " + out);
        INFO(outcome.err);
        CHECK(outcome.code == 0);
        CHECK(std::filesystem::exists(folder.path / where / "speaker.wav") == (std::string(where) == "file"));
    }
}
