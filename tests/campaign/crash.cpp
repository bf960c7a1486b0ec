// SPDX-License-Identifier: Apache-2.0
// crash ROUNDS [FIRST]: commands that write are ended by force at random instants: killed, told to end, stopped for a
// while, on a disk that gets full or read-only, and two at once. Nothing that stood there before may be lost or changed,
// and what is left must open, or be called `.part`. The number of a round decides what happens in it, and when, as a
// share of the time that the command takes undisturbed. Exit code 1 when something is found.
#include "tests/campaign/crash_jobs.hpp"
#include "tests/campaign/left_behind.hpp"
#include "tests/campaign/limited_run.hpp"
#include "tests/campaign/mutate.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/display.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <thread>

namespace fs = std::filesystem;
using namespace tactus::campaign;
using Clock = std::chrono::steady_clock;

namespace {

constexpr int longest_s = 120;

enum class Harm { kill, term, hup, stop, full_disk, read_only, twin };
constexpr std::array<std::string_view, 7> harm_names{
    "killed",    "told to end",    "left by its terminal", "stopped for a while",
    "disk full", "disk read-only", "two at once"};

/// A job in a group of processes of its own.
class Process {
public:
    Process(const Job& job, const fs::path& folder, const std::string& environment, const std::string& twin) {
        const std::string script =
            fmt::format("cd {0} && export XDG_RUNTIME_DIR={0} XDG_STATE_HOME={0}/state {1} T={2} N={3}\n{4}",
                        folder.string(), environment, tried_command(), twin, job.script);
        process_ = fork();
        if (process_ != 0) return;
        setpgid(0, 0);
        const int told = open((folder.string() + twin + ".said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dup2(told, 1);
        dup2(told, 2);
        execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
        _exit(127);
    }
    ~Process() {
        if (process_ > 0) wait(0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void signal(int number) const {
        if (process_ <= 0 || ::kill(-process_, number) == 0) return;
        ::kill(process_, number);
    }
    /// How it ended, in the words of waitpid; −1: it did not, and was killed.
    int wait(int max_s = longest_s) {
        int status = 0;
        const auto until = Clock::now() + std::chrono::seconds(max_s);
        while (waitpid(process_, &status, WNOHANG) == 0) {
            if (Clock::now() > until) {
                signal(SIGKILL);
                waitpid(process_, &status, 0);
                status = -1;
                break;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        process_ = -1;
        return status;
    }

private:
    pid_t process_ = -1;
};

/// What is wrong with how it ended; `sent`: the signal that may have ended it.
std::string fault_of_end(int status, int sent) {
    if (status == -1) return fmt::format("did not end in {} s", longest_s);
    if (WIFSIGNALED(status)) return WTERMSIG(status) == sent ? "" : fmt::format("ended by signal {}", WTERMSIG(status));
    const int code = WEXITSTATUS(status);
    return code <= 3 || code == 128 + sent ? "" : fmt::format("exit code {}", code);
}

struct Round {
    std::vector<std::string> faults;
    bool was_cut = false;
};

std::string failing_disk(Harm harm, const fs::path& folder, Dice& dice) {
    // A few of the calls are many for a table, and many are few for a sound.
    const std::size_t from = 1 + dice.below(dice.below(2) ? 12 : 150);
    // Some paths are given from the folder on.
    return fmt::format("LD_PRELOAD={} FAILING_DISK_FROM={} FAILING_DISK_PATH={}/:new:take:bone.vdb:case.plan.json {}",
                       tactus::test::failing_disk(), from, folder.string(),
                       harm == Harm::full_disk ? "" : "FAILING_DISK_ERRNO=EROFS FAILING_DISK_CALLS=write,open,rename");
}

Round disturb(const Job& job, Harm harm, const fs::path& folder, const std::string& display, Dice& dice) {
    Round round;
    const auto end = [&round](Process& process, int sent) {
        const int status = process.wait();
        if (const std::string fault = fault_of_end(status, sent); !fault.empty()) round.faults.push_back(fault);
        round.was_cut = round.was_cut || status == -1 || WIFSIGNALED(status) || WEXITSTATUS(status) > 3;
    };
    const bool is_disk = harm == Harm::full_disk || harm == Harm::read_only;
    const std::string environment = display + (is_disk ? failing_disk(harm, folder, dice) : "");
    const auto wait = [&](double share) {
        const double chosen = static_cast<double>(dice.below(1000)) * 1e-3;
        std::this_thread::sleep_for(std::chrono::duration<double>(chosen * share * job.seconds));
    };
    Process first(job, folder, environment, "");
    if (is_disk) {
        end(first, 0);
        round.was_cut = true;
    } else if (harm == Harm::twin) {
        wait(0.3);
        Process second(job, folder, environment, "-2");
        end(first, 0);
        end(second, 0);
    } else {
        wait(1.1);
        const int signal = std::array{SIGKILL, SIGTERM, SIGHUP, SIGSTOP}[static_cast<std::size_t>(harm)];
        first.signal(signal);
        if (harm == Harm::stop) {
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
            first.signal(SIGCONT);
        }
        end(first, harm == Harm::stop ? 0 : signal);
    }
    return round;
}

/// The folder of a run that is no more can be used again, and so can its plan.
void use_again(const fs::path& folder, std::vector<std::string>& faults) {
    const auto must = [&](std::vector<std::string> words) {
        words.insert(words.begin(), tried_command());
        const RunEnd end = run_limited(words, folder);
        if (end.code != 0)
            faults.push_back(fmt::format("afterwards '{}' ends with {} {}", words[1], end.code, end.fault));
    };
    must({"render", "p.toml", "--seconds", "0.02", "--out", "new", "--overwrite"});
    must({"plan", "move", "case.plan.json", "b", "--pose", "0,0,9,1,0,0,0"});
}

/// The folder as it was left, and what the command said.
void keep(const fs::path& folder, const fs::path& kept) {
    constexpr auto how =
        fs::copy_options::recursive | fs::copy_options::overwrite_existing | fs::copy_options::skip_symlinks;
    fs::remove_all(kept);
    fs::create_directories(kept);
    fs::copy(folder, kept, how);
    for (const char* twin : {"", "-2"})
        if (const fs::path said = folder.string() + twin + ".said"; fs::exists(said))
            fs::copy(said, kept / fmt::format("said{}", twin), how);
}

int try_round(const std::vector<Job>& jobs, std::uint64_t number, const fs::path& scratch, const std::string& display) {
    const Job& job = jobs[number % jobs.size()];
    // As seven is prime, each job meets each harm.
    const auto harm = static_cast<Harm>(number % harm_names.size());
    Dice dice(number * 1000003 + 17);
    const fs::path folder = scratch / fmt::format("round-{}", number);
    fs::copy(scratch / "earlier", folder, fs::copy_options::recursive);
    const Snapshot before = snapshot_of(folder);
    Round round = disturb(job, harm, folder, display, dice);
    const auto left = faults_in(folder, before, job.may_change, round.was_cut);
    round.faults.insert(round.faults.end(), left.begin(), left.end());
    // Before it is used again, which writes over it.
    const fs::path kept = fs::path("crash-findings") / fmt::format("round-{}", number);
    if (!round.faults.empty()) keep(folder, kept);
    use_again(folder, round.faults);
    for (const std::string& fault : round.faults)
        fmt::print("round {}: {}, {}: {}\n", number, job.name, harm_names[static_cast<std::size_t>(harm)], fault);
    if (fs::exists(kept)) fmt::print("  kept as {}\n", kept.string());
    std::fflush(stdout);
    fs::remove_all(folder);
    return static_cast<int>(round.faults.size());
}

/// How long each job takes, which must succeed.
void time_jobs(std::vector<Job>& jobs, const fs::path& scratch, const std::string& display) {
    for (Job& job : jobs) {
        const fs::path folder = scratch / ("whole-" + job.name);
        fs::copy(scratch / "earlier", folder, fs::copy_options::recursive);
        const auto begin = Clock::now();
        Process process(job, folder, display, "");
        if (process.wait() != 0) throw std::runtime_error(job.name + " fails undisturbed, see " + folder.string());
        job.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        fs::remove_all(folder);
    }
}

}  // namespace

int main(int count, char** words) {
    if (count < 2 || std::atoi(words[1]) < 1) {
        fmt::print(stderr, "usage: crash ROUNDS [FIRST]\n");
        return 2;
    }
    const int rounds = std::atoi(words[1]), first = count > 2 ? std::atoi(words[2]) : 0;
    const fs::path scratch = fs::temp_directory_path() / fmt::format("tactus-crash-{}", getpid());
    const tactus::test::VirtualDisplay screen;
    const std::string display = screen.is_there() ? screen.environment() : std::string();
    int found = 0;
    try {
        fs::create_directories(scratch / "earlier");
        make_earlier_work(scratch / "earlier");
        std::vector<Job> jobs = crash_jobs(screen.is_there());
        if (!screen.is_there()) fmt::print("Xvfb is not installed: the window is not tried\n");
        time_jobs(jobs, scratch, display);
        for (int n = first; n < first + rounds; ++n)
            found += try_round(jobs, static_cast<std::uint64_t>(n), scratch, display);
        fmt::print("{} rounds, {} findings\n", rounds, found);
    } catch (const std::exception& error) {
        fmt::print(stderr, "crash: {}\n", error.what());
        return 1;
    }
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    return found > 0 ? 1 : 0;
}
