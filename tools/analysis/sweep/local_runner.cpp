// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/local_runner.hpp"

#include "assets/file/growing_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/sweep/provenance.hpp"
#include "tools/analysis/sweep/results.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/scratch_folder.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <thread>

namespace tactus::analysis {

namespace fs = std::filesystem;
using sweep::Row;
using Clock = std::chrono::steady_clock;

namespace {

// What a worker keeps between points is bounded: caches of several patches, or a leak.
constexpr double max_resident_between_points = 2e9;
constexpr auto memory_look_every = std::chrono::milliseconds(20);

struct Task {
    std::uint64_t index = 0;
    std::uint64_t attempt = 1;
};

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Resident memory of a process and its descendants, bytes.
double resident_of(pid_t process) {
    double bytes = 0.0;
    std::ifstream statm(fmt::format("/proc/{}/statm", process));
    double size = 0.0, resident = 0.0;
    if (statm >> size >> resident) bytes = resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
    std::error_code ignored;
    for (fs::directory_iterator task(fmt::format("/proc/{}/task", process), ignored), end; !ignored && task != end;
         task.increment(ignored)) {
        std::ifstream children(task->path() / "children");
        for (pid_t child = 0; children >> child;) bytes += resident_of(child);
    }
    return bytes;
}

double number_in(const fs::path& path, double otherwise) {
    std::ifstream file(path);
    double value = 0.0;
    return file >> value ? value : otherwise;
}

/// Memory that a new process could use, bytes: of the machine, and of the control group that a scheduler set.
double available_memory() {
    double available = 1e18;
    std::ifstream info("/proc/meminfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("MemAvailable:")) available = std::strtod(line.c_str() + 13, nullptr) * 1024.0;
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);)
        if (line.starts_with("0::")) {
            const fs::path group = "/sys/fs/cgroup" + line.substr(3);
            const double limit = number_in(group / "memory.max", 1e18);
            if (limit < 1e18) available = std::min(available, limit - number_in(group / "memory.current", 0.0));
        }
    return available;
}

bool read_exactly(int handle, void* to, std::size_t size) {
    auto* at = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t count = ::read(handle, at, size);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

bool send_all(int handle, const void* from, std::size_t size) {
    const auto* at = static_cast<const char*>(from);
    while (size > 0) {
        const ssize_t count = ::send(handle, at, size, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

/// The life of a worker: tasks in, lines of rows out.
[[noreturn]] void work(int handle, const SweepFolder& folder, const LocalRun& options, const fs::path& scratch) {
    const PointContext context{&folder, scratch, options.program, options.run_verb, true, {}};
    Task task;
    while (read_exactly(handle, &task, sizeof task)) {
        std::error_code failure;
        fs::create_directory(scratch, failure);
        fs::current_path(scratch, failure);  // as in a process of its own
        Row row = run_point(context, task.index);
        fs::remove_all(scratch, failure);
        // A verb installed its handlers, and a signal has ended it early, as it would every later one in this process.
        if (options.stop && *options.stop) {
            std::signal(SIGTERM, SIG_DFL);
            std::raise(SIGTERM);
        }
        row.attempt = static_cast<int>(task.attempt);
        const std::string line = sweep::row_line(row);
        const auto size = static_cast<std::uint32_t>(line.size());
        if (!send_all(handle, &size, sizeof size) || !send_all(handle, line.data(), line.size())) break;
    }
    // Without destructors of the parent's objects.
    ::_exit(0);
}

struct Worker {
    pid_t process = -1;
    int handle = -1;
    fs::path scratch;
    std::optional<Task> task;
    Clock::time_point begin;
    std::string inbox;
    double peak = 0.0;  // bytes, of this attempt, as seen from outside
    double resident = 0.0;  // bytes, at the last look; 0 before the first
    std::string killed;  // why; empty: it was not
};

class LocalRunner {
public:
    LocalRunner(const SweepFolder& folder, const LocalRun& options) : folder_(folder), options_(options) {
        jobs_ = options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
        const std::vector<bool> done = finished_points(folder);
        for (std::size_t i = options.share.index; i < folder.tasks().size(); i += options.share.count) {
            ++progress_.points;
            if (done[i]) ++progress_.before;
            else waiting_.push_back({i, 1});
        }
        // By the hash: a random order that all runners agree on. Figures fill evenly, and the time to completion is not
        // that of the cheapest levels.
        std::ranges::sort(waiting_, {}, [&](const Task& task) { return folder.tasks().id(task.index); });
    }

    ~LocalRunner() {
        for (Worker& worker : workers_) end(worker);
        if (writer_ > 0) ::waitpid(writer_, nullptr, 0);
    }
    LocalRunner(const LocalRunner&) = delete;
    LocalRunner& operator=(const LocalRunner&) = delete;

    RunProgress run() {
        begin_ = last_written_ = Clock::now();
        if (!waiting_.empty()) {
            const fs::path log = new_log();
            try {
                log_ = std::make_unique<file::GrowingFile>(log);
            } catch (const Error& error) {
                throw LogFailure(error.what());
            }
            const file::Json worker{{"worker", worker_description(options_.version, options_.runner, jobs_)}};
            append(worker.dump() + "\n");
        }
        while (!is_over()) {
            hand_out();
            wait();
            watch();
            tell(false);
            write_tables_beside();
        }
        tell(true);
        if (log_) log_->close();
        return progress_;
    }

private:
    /// An empty file that no other process has: containers may share name, process number and microsecond.
    fs::path new_log() const {
        for (int tries = 0;; ++tries) {
            const fs::path log = folder_.path() / "log" / (process_name() + ".jsonl");
            const int handle = ::open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (handle >= 0) {
                ::close(handle);
                return log;
            }
            if (errno != EEXIST || tries == 100)
                throw LogFailure(fmt::format("{}: cannot be written: {}", log.string(), std::strerror(errno)));
        }
    }

    /// At once: a row that was reported is not lost when this process ends.
    void append(const std::string& line) {
        try {
            log_->append(line);
            log_->flush();
        } catch (const Error& error) {
            throw LogFailure(error.what());
        }
    }

    bool is_stopped() const { return options_.stop && *options_.stop; }
    bool is_over() const {
        return is_stopped() ||
               (waiting_.empty() && std::ranges::none_of(workers_, [](const Worker& w) { return w.task.has_value(); }));
    }

    void hand_out() {
        progress_.is_waiting_for_memory = false;
        while (!waiting_.empty()) {
            auto idle = std::ranges::find_if(workers_, [](const Worker& w) { return !w.task; });
            const auto busy = static_cast<std::size_t>(
                std::ranges::count_if(workers_, [](const Worker& w) { return w.task.has_value(); }));
            if (idle == workers_.end() && workers_.size() >= static_cast<std::size_t>(jobs_)) return;
            if (busy > 0 && !has_memory_for(idle == workers_.end() ? nullptr : &*idle)) {
                progress_.is_waiting_for_memory = true;
                return;
            }
            if (idle == workers_.end()) {
                start();
                idle = std::prev(workers_.end());
            }
            const Task task = waiting_.front();
            waiting_.pop_front();
            idle->task = task;
            idle->begin = Clock::now();
            idle->peak = 0.0;
            idle->killed.clear();
            idle->inbox.clear();
            // A worker that has died is noticed when its answer is read.
            send_all(idle->handle, &task, sizeof task);
        }
    }

    /// `idle`: the worker that would get a point; null: a new one. Looks at the machine at most every 50 ms; workers that
    /// were started since then count as empty, so that all they may need is reserved.
    bool has_memory_for(const Worker* idle) {
        if (seconds_since(memory_seen_) > 0.05) {
            available_ = available_memory();
            for (Worker& worker : workers_) worker.resident = resident_of(worker.process);
            memory_seen_ = Clock::now();
        }
        const double limit = static_cast<double>(folder_.sweep().limits.bytes);
        std::vector<double> busy;
        double need = limit > 0.0 ? limit : largest_peak_;
        for (const Worker& worker : workers_)
            if (worker.task) {
                busy.push_back(worker.resident);
                if (limit == 0.0) need = std::max(need, worker.resident);
            }
        // Without a limit, nothing is known before the first points run.
        return need == 0.0 || fits_in_memory(available_, need, busy, idle ? idle->resident : 0.0);
    }

    void start() {
        std::array<int, 2> pair{};
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0)
            throw Error(fmt::format("cannot start a worker: {}", std::strerror(errno)));
        Worker worker;
        worker.scratch = scratch_.path() / fmt::format("worker-{}", ++started_);
        const pid_t parent = ::getpid();
        worker.process = ::fork();
        if (worker.process < 0) {
            const int code = errno;
            ::close(pair[0]);
            ::close(pair[1]);
            throw Error(fmt::format("cannot start a worker: {}", std::strerror(code)));
        }
        if (worker.process == 0) {
            // A group of its own: Ctrl-C reaches the parent only, and the parent can end all that a point started.
            ::setpgid(0, 0);
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (::getppid() != parent) ::_exit(0);
            for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_DFL);
            ::close(pair[0]);
            for (const Worker& other : workers_) ::close(other.handle);
            if (const int null = ::open("/dev/null", O_RDONLY | O_CLOEXEC); null >= 0) ::dup2(null, STDIN_FILENO);
            work(pair[1], folder_, options_, worker.scratch);
        }
        ::setpgid(worker.process, worker.process);
        ::close(pair[1]);
        worker.handle = pair[0];
        workers_.push_back(std::move(worker));
    }

    void kill(Worker& worker, const std::string& why) {
        worker.killed = why;
        ::kill(-worker.process, SIGKILL);
        ::kill(worker.process, SIGKILL);
    }

    /// Ends it, if it lives, and clears what it left.
    int end(Worker& worker) {
        ::kill(-worker.process, SIGKILL);
        ::kill(worker.process, SIGKILL);
        int status = 0;
        while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
        }
        ::close(worker.handle);
        std::error_code ignored;
        fs::remove_all(worker.scratch, ignored);
        return status;
    }

    void wait() {
        std::vector<pollfd> polled;
        for (const Worker& worker : workers_) polled.push_back({worker.handle, POLLIN, 0});
        const sweep::Limits& limits = folder_.sweep().limits;
        const bool looks_often = limits.bytes > 0 || limits.seconds > 0.0;
        ::poll(polled.data(), polled.size(), looks_often ? 10 : 100);
        for (std::size_t i = polled.size(); i-- > 0;)
            if (polled[i].revents != 0) receive(i);
    }

    void receive(std::size_t i) {
        Worker& worker = workers_[i];
        std::array<char, 65536> block{};
        const ssize_t count = ::recv(worker.handle, block.data(), block.size(), MSG_DONTWAIT);
        if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
        if (count <= 0) {
            lost(i);
            return;
        }
        worker.inbox.append(block.data(), static_cast<std::size_t>(count));
        std::uint32_t size = 0;
        if (worker.inbox.size() < sizeof size) return;
        std::memcpy(&size, worker.inbox.data(), sizeof size);
        if (worker.inbox.size() < sizeof size + size) return;
        const std::string line = worker.inbox.substr(sizeof size, size);
        worker.inbox.clear();
        const Task task = *worker.task;
        worker.task.reset();
        const Row row = sweep::read_row(std::string_view(line).substr(0, line.size() - 1));
        if (worker.killed.empty()) settle(task, row, line);
        else settle(task, failed_row(task, worker.killed, seconds_since(worker.begin), row.peak), {});
        const double limit = static_cast<double>(folder_.sweep().limits.bytes);
        const double allowed =
            limit > 0.0 ? std::min(0.5 * limit, max_resident_between_points) : max_resident_between_points;
        if (!worker.killed.empty() || (row.peak > allowed && resident_of(worker.process) > allowed)) remove(i);
    }

    void remove(std::size_t i) {
        end(workers_[i]);
        workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
    }

    /// The worker has ended by itself, or was killed.
    void lost(std::size_t i) {
        Worker& worker = workers_[i];
        const std::optional<Task> task = worker.task;
        const std::string killed = worker.killed;
        const double seconds = seconds_since(worker.begin), peak = worker.peak;
        const int status = end(worker);
        workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
        if (!task) return;
        std::string why = killed;
        if (why.empty())
            why = WIFSIGNALED(status) ? fmt::format("the worker was killed by signal {} ({})", WTERMSIG(status),
                                                    ::strsignal(WTERMSIG(status)))
                                      : fmt::format("the worker ended with exit code {}", WEXITSTATUS(status));
        Row row = failed_row(*task, why, seconds, peak);
        if (killed.empty() && WIFSIGNALED(status)) row.signal = WTERMSIG(status);
        settle(*task, row, {});
    }

    Row failed_row(const Task& task, const std::string& why, double seconds, double peak) const {
        Row row;
        row.point = folder_.tasks().id(task.index);
        row.reason = why;
        row.seconds = seconds;
        row.peak = peak;
        row.finished = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
        row.attempt = static_cast<int>(task.attempt);
        return row;
    }

    /// `line`: as the worker wrote it; empty: written here.
    void settle(const Task& task, const Row& row, const std::string& line) {
        largest_peak_ = std::max(largest_peak_, row.peak);
        // A verb that succeeded did not meet the signal; of a program its exit code may hide it.
        const bool is_certain = row.is_ok && std::ranges::all_of(folder_.sweep().steps, &sweep::Step::is_own);
        if (!is_certain && is_being_ended(row)) return;
        if (!row.is_ok && !is_rejected(row) && static_cast<int>(task.attempt) <= folder_.sweep().limits.retries) {
            ++progress_.retried;
            waiting_.push_back({task.index, task.attempt + 1});
            return;
        }
        append(line.empty() ? sweep::row_line(row) : line);
        ++progress_.finished;
        if (!row.is_ok) ++progress_.failed;
        sum_ += row.seconds;
        squares_ += row.seconds * row.seconds;
        longest_ = std::max(longest_, row.seconds);
    }

    /// A verb of Tactus rejected its input, and no program made that input.
    bool is_rejected(const Row& row) const {
        const std::vector<sweep::Step>& steps = folder_.sweep().steps;
        return row.step > 0 && row.exit_code == bad_input &&
               std::all_of(steps.begin(), steps.begin() + row.step,
                           [](const sweep::Step& step) { return step.is_own; });
    }

    /// A scheduler ends a job by SIGTERM to all of its processes, in no particular order: a point that met it neither
    /// failed nor succeeded; it stays unfinished.
    bool is_being_ended(const Row& row) const {
        constexpr int of_shell = 128 + SIGTERM;  // exit code of a shell whose child was ended
        if (!is_stopped() && (row.signal == SIGTERM || row.exit_code == of_shell))
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return is_stopped();
    }

    /// Time and memory of running points.
    void watch() {
        const sweep::Limits& limits = folder_.sweep().limits;
        if (limits.seconds <= 0.0 && limits.bytes == 0) return;
        const bool looks_at_memory = limits.bytes > 0 && Clock::now() - looked_ >= memory_look_every;
        if (looks_at_memory) looked_ = Clock::now();
        for (Worker& worker : workers_) {
            if (!worker.task || !worker.killed.empty()) continue;
            if (limits.seconds > 0.0 && seconds_since(worker.begin) > limits.seconds)
                kill(worker, fmt::format("took longer than {:g} s", limits.seconds));
            if (!looks_at_memory) continue;
            const double resident = resident_of(worker.process);
            worker.peak = std::max(worker.peak, resident);
            if (resident > static_cast<double>(limits.bytes))
                kill(worker, fmt::format("used more than {:g} MB", 1e-6 * static_cast<double>(limits.bytes)));
        }
    }

    void tell(bool is_last) {
        progress_.elapsed = seconds_since(begin_);
        if (!options_.tell || (!is_last && seconds_since(told_) < 0.2)) return;
        told_ = Clock::now();
        progress_.left.reset();
        if (const auto n = static_cast<double>(progress_.finished); n >= 5.0) {
            const auto left = static_cast<double>(progress_.points - progress_.before - progress_.finished);
            const double mean = sum_ / n, spread = std::sqrt(std::max(0.0, squares_ / n - mean * mean) * n / (n - 1.0));
            // From the throughput of this run, which includes what workers cost beside their points.
            const double expected = left * progress_.elapsed / n;
            const double jobs = std::min(static_cast<double>(jobs_), std::max(left, 1.0));
            const double error = 2.0 * spread * (left / std::sqrt(n) + std::sqrt(left)) / jobs;
            progress_.left =
                std::pair(std::max(0.0, expected - error), expected + error + (left > 0.0 ? longest_ : 0.0));
        }
        options_.tell(progress_);
    }

    /// In a child process, so that no worker waits; at most a tenth of the time.
    void write_tables_beside() {
        if (!options_.writes_tables || progress_.finished == 0) return;
        if (writer_ > 0) {
            if (::waitpid(writer_, nullptr, WNOHANG) != writer_) return;
            writer_ = -1;
            write_cost_ = seconds_since(last_written_);
            last_written_ = Clock::now();
            return;
        }
        if (seconds_since(last_written_) < std::max(5.0, 10.0 * write_cost_)) return;
        last_written_ = Clock::now();
        writer_ = ::fork();
        if (writer_ != 0) return;
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (const Worker& worker : workers_) ::close(worker.handle);
        try {
            const Results results(folder_);
            results.write_csv(folder_.path() / "results.csv");
            results.write_sqlite(folder_.path() / "results.sqlite");
        } catch (const std::exception&) {
            // The last write, by the parent, reports it.
        }
        ::_exit(0);
    }

    const SweepFolder& folder_;
    const LocalRun& options_;
    int jobs_ = 1;
    run::ScratchFolder scratch_;
    std::deque<Task> waiting_;
    std::vector<Worker> workers_;
    std::unique_ptr<file::GrowingFile> log_;
    RunProgress progress_;
    Clock::time_point begin_, told_, looked_, memory_seen_, last_written_;
    double available_ = 1e18, largest_peak_ = 0.0, sum_ = 0.0, squares_ = 0.0, longest_ = 0.0, write_cost_ = 0.0;
    std::size_t started_ = 0;
    pid_t writer_ = -1;
};

std::optional<std::size_t> number_of_environment(const char* name) {
    const char* text = std::getenv(name);
    if (!text || !*text) return {};
    std::size_t value = 0;
    const std::string_view given = text;
    const auto [end, failure] = std::from_chars(given.data(), given.data() + given.size(), value);
    if (failure != std::errc{} || end != given.data() + given.size())
        throw Error(fmt::format("the variable {} is '{}' and no number", name, given));
    return value;
}

}  // namespace

bool fits_in_memory(double available, double need, std::span<const double> busy, double idle) {
    double reserved = 1.1 * need - std::min(idle, need);
    for (const double resident : busy) reserved += std::max(0.0, need - resident);
    return available > reserved;
}

RunProgress run_locally(const SweepFolder& folder, const LocalRun& options) {
    return LocalRunner(folder, options).run();
}

std::optional<Share> share_of_environment() {
    // Slurm's last: mpirun within a batch script leaves the script's SLURM_PROCID = 0 to all ranks.
    constexpr std::pair<const char*, const char*> known[] = {
        {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}, {"SLURM_PROCID", "SLURM_NTASKS"}};
    for (const auto& [rank_name, size_name] : known) {
        const auto rank = number_of_environment(rank_name), size = number_of_environment(size_name);
        if (!rank || !size) continue;
        if (*rank >= *size)
            throw Error(fmt::format("{} = {} is not below {} = {}", rank_name, *rank, size_name, *size));
        return Share{*rank, *size};
    }
    return {};
}

Share parse_share(const std::string& text) {
    std::size_t index = 0, count = 0;
    const char* const end = text.data() + text.size();
    const auto [slash, first] = std::from_chars(text.data(), end, index);
    const bool has_slash = first == std::errc{} && slash != end && *slash == '/';
    const auto second = has_slash ? std::from_chars(slash + 1, end, count) : std::from_chars_result{};
    if (!has_slash || second.ec != std::errc{} || second.ptr != end || index < 1 || index > count)
        throw Error(fmt::format("--share must be I/N with I from 1 to N, as in 3/8, not '{}'", text));
    return {index - 1, count};
}

}  // namespace tactus::analysis
