// SPDX-License-Identifier: Apache-2.0
// A sweep on a real Slurm, of two nodes on this machine, and under a real mpirun.
#include "tests/support/skip.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/command/sweep/sweep_tests.hpp"

#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

using namespace tactus::test;

namespace {

std::string in(const Folder& folder, const std::string& name) { return (folder.path / name).string(); }

bool has_program(const std::string& name) {
    return std::system(("PATH=$PATH:/usr/sbin command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

std::string output_of(const Folder& folder, const std::string& command) {
    const std::string file = in(folder, "output.txt");
    [[maybe_unused]] const int ignored = std::system((command + " >" + file + " 2>&1").c_str());
    return slurp(file);
}

/// munged, slurmctld and two slurmd, without systemd; ended with the object.
class Slurm {
public:
    explicit Slurm(const Folder& folder) : folder_(folder) {
        const std::string d = folder.path.string();
        char host[256] = {};
        ::gethostname(host, sizeof host - 1);
        const int port = 20000 + 3 * (::getpid() % 8000);
        fs::create_directories(folder.path / "state");
        fs::permissions(folder.path, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                                         fs::perms::others_read | fs::perms::others_exec);
        folder.write("munge.key", std::string(1024, 'k') + std::to_string(::getpid()));
        fs::permissions(folder.path / "munge.key", fs::perms::owner_read | fs::perms::owner_write);
        folder.write(
            "slurm.conf",
            fmt::format("ClusterName=tactus\nSlurmctldHost={1}(127.0.0.1)\nSlurmUser={2}\nSlurmdUser={2}\n"
                        "AuthType=auth/munge\nAuthInfo=socket={0}/munge.socket\nCredType=cred/munge\n"
                        "StateSaveLocation={0}/state\nSlurmdSpoolDir={0}/spool-%n\n"
                        "SlurmctldPidFile={0}/slurmctld.pid\nSlurmdPidFile={0}/slurmd-%n.pid\n"
                        "SlurmctldLogFile={0}/slurmctld.log\nSlurmdLogFile={0}/slurmd-%n.log\nSlurmctldPort={3}\n"
                        "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\n"
                        "MpiDefault=none\nReturnToService=2\nSchedulerParameters=sched_interval=2,batch_sched_delay=1\n"
                        "SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\n"
                        "JobAcctGatherType=jobacct_gather/none\nMaxArraySize=21\nKillWait=2\n"
                        "SlurmdParameters=config_overrides\n"
                        "NodeName=n1 NodeHostname={1} NodeAddr=127.0.0.1 Port={4} CPUs=2 State=UNKNOWN\n"
                        "NodeName=n2 NodeHostname={1} NodeAddr=127.0.0.1 Port={5} CPUs=2 State=UNKNOWN\n"
                        "PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP\n",
                        d, std::string(host).substr(0, std::string(host).find('.')), user(), port, port + 1, port + 2));
        ::setenv("SLURM_CONF", in(folder, "slurm.conf").c_str(), 1);
        ::setenv("PATH", (std::string(std::getenv("PATH")) + ":/usr/sbin").c_str(), 1);
        why_ = output_of(
            folder, fmt::format("munged --force --socket={0}/munge.socket --key-file={0}/munge.key "
                                "--pid-file={0}/munged.pid --log-file={0}/munged.log --seed-file={0}/munge.seed && "
                                "slurmctld -f {0}/slurm.conf && slurmd -N n1 -f {0}/slurm.conf && slurmd -N n2 -f "
                                "{0}/slurm.conf",
                                d));
        is_up_ = wait_for([&] {
            return output_of(folder_, "sinfo --noheader --format='%D %T'").find("2 idle") != std::string::npos;
        });
        if (!is_up_) why_ += output_of(folder_, "sinfo") + output_of(folder_, "tail -n 3 " + d + "/*.log");
    }
    ~Slurm() {
        for (const char* name : {"slurmd-n1.pid", "slurmd-n2.pid", "slurmctld.pid", "munged.pid"}) {
            std::ifstream file(folder_.path / name);
            pid_t process = 0;
            if (!(file >> process) || process <= 1) continue;
            ::kill(process, SIGTERM);
            for (int i = 0; i < 100 && ::kill(process, 0) == 0; ++i) ::usleep(100'000);
        }
    }
    Slurm(const Slurm&) = delete;
    Slurm& operator=(const Slurm&) = delete;

    bool is_up() const { return is_up_; }
    const std::string& why() const { return why_; }
    std::string states() const { return output_of(folder_, "squeue --noheader --array --format='%i %T'"); }

private:
    static std::string user() { return ::getuid() == 0 ? "root" : std::getenv("USER") ? std::getenv("USER") : "root"; }

    const Folder& folder_;
    bool is_up_ = false;
    std::string why_;
};

bool has_slurm() {
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol"})
        if (!has_program(program)) {
            skip(std::string(program) + " is not installed; install slurm-wlm and munge");
            return false;
        }
    return true;
}

/// Kills one process that writes to the logs.
bool kill_a_worker(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder / "log")) {
        // HOST-PID-TIME.jsonl
        const std::string name = entry.path().stem().string();
        const std::size_t last = name.rfind('-'), before = name.rfind('-', last - 1);
        const pid_t process = std::atoi(name.substr(before + 1, last - before - 1).c_str());
        std::error_code ignored;
        const std::string program =
            fs::read_symlink("/proc/" + std::to_string(process) + "/exe", ignored).filename().string();
        if (process > 1 && (program == "tactus" || program == "tactus-full") && ::kill(process, SIGKILL) == 0)
            return true;
    }
    return false;
}

}  // namespace

TEST_CASE("an element of an array that Slurm requeues runs what is left of its share", "[kernel][long]") {
    if (!has_slurm()) return;
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points("sleep 0.2; "));
    REQUIRE(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "local") + " --jobs 20").code == 0);
    const Slurm slurm(folder);
    if (!slurm.is_up()) {
        skip("Slurm does not start here: " + slurm.why());
        return;
    }
    REQUIRE(
        folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --runner slurm --chunk 20 --no-wait")
            .code == 0);
    REQUIRE(wait_for([&] { return rows_in(folder.path / "a") > 8; }));
    std::istringstream states(slurm.states());
    std::string id, state;
    while (states >> id >> state && state != "RUNNING") {
    }
    REQUIRE(state == "RUNNING");
    const std::string answer = output_of(folder, "scontrol requeue " + id);
    CAPTURE(id, answer);
    REQUIRE(answer.empty());
    CHECK(
        wait_for([&] { return output_of(folder, "scontrol show job " + id).find("Restarts=1") != std::string::npos; }));
    // Slurm holds it back for up to two minutes.
    for (int i = 0; i < 10 && !wait_for([&] { return slurm.states().empty(); }); ++i) {
    }
    CAPTURE(slurm.states());
    const SweepStatus status = status_of(folder, "a");
    CHECK(status.done == 200);
    CHECK(status.failed == 0);
    CHECK(status.repeated == 0);
    // The element has two logs, of before and after.
    std::map<std::string, int> logs;
    for (const auto& entry : fs::directory_iterator(folder.path / "a/log")) {
        const std::string text = slurp(entry.path());
        const auto worker = nlohmann::json::parse(text.substr(0, text.find('\n')))["worker"];
        ++logs[worker["runner"].get<std::string>()];
    }
    CHECK(logs.size() == 10);
    CHECK(logs["slurm " + id] == 2);
    CHECK(folder.tactus("sweep status " + in(folder, "a") + " --tables").code == 0);
    CHECK(results_of(folder, "a") == results_of(folder, "local"));
}

TEST_CASE("Slurm runs a sweep through killed workers, a cancelled array and a full disk", "[kernel][long]") {
    if (!has_slurm()) return;
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points("sleep 0.05; "));
    REQUIRE(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "local")).code == 0);
    const Slurm slurm(folder);
    if (!slurm.is_up()) {
        skip("Slurm does not start here: " + slurm.why());
        return;
    }
    const std::string run = "sweep run " + file.string() + " -o " + in(folder, "a") + " --runner slurm ";
    // 21 elements are too many for this configuration.
    CHECK(folder.tactus(run + "--chunk 9").code == 2);
    REQUIRE(folder.tactus(run + "--chunk 20 --no-wait").code == 0);
    REQUIRE(wait_for([&] { return rows_in(folder.path / "a") > 10; }));
    CHECK(kill_a_worker(folder.path / "a"));
    REQUIRE(wait_for([&] { return rows_in(folder.path / "a") > 40; }));
    output_of(folder, "scancel --name=tactus-sweep");
    REQUIRE(wait_for([&] { return slurm.states().empty(); }));
    const SweepStatus cancelled = status_of(folder, "a");
    CHECK(cancelled.done > 40);
    CHECK(cancelled.done < 200);
    // A full disk for the files of one point in sixteen.
    const Outcome full = folder.tactus(run + "--chunk 20 --sbatch=--export=ALL,LD_PRELOAD=" + failing_disk() +
                                       ",FAILING_DISK_CALLS=open,FAILING_DISK_PATH=/files/3");
    CAPTURE(full.out, full.err, slurp(folder.path / "slurmctld.log"));
    CHECK(full.code == 1);
    CHECK(full.out.find("No space left on device") != std::string::npos);
    CHECK(status_of(folder, "a").failed > 0);
    const Outcome last = folder.tactus(run + "--chunk 20");
    CAPTURE(last.out, last.err);
    CHECK(last.code == 0);
    CHECK(results_of(folder, "a") == results_of(folder, "local"));
    CHECK(status_of(folder, "a").hash == status_of(folder, "local").hash);
    // Nothing is left to submit.
    CHECK(folder.tactus(run + "--chunk 20").out.find("job") == std::string::npos);
}

TEST_CASE("mpirun runs a sweep by rank, through a killed rank", "[kernel][long]") {
    if (!has_program("mpirun")) {
        skip("mpirun is not installed; install openmpi-bin");
        return;
    }
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points("sleep 0.02; "));
    REQUIRE(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "local")).code == 0);
    REQUIRE(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --dry-run").code == 0);
    const std::string mpirun = fmt::format("mpirun --allow-run-as-root --oversubscribe -n 4 {} sweep work {}",
                                           tactus::test::command(), in(folder, "a"));
    const pid_t background = ::fork();
    if (background == 0) {
        ::execl("/bin/sh", "sh", "-c", ("exec " + mpirun + " >" + in(folder, "first.txt") + " 2>&1").c_str(), nullptr);
        ::_exit(127);
    }
    CHECK(wait_for([&] { return rows_in(folder.path / "a") > 20; }));
    CHECK(kill_a_worker(folder.path / "a"));
    int status = 0;
    ::waitpid(background, &status, 0);
    CAPTURE(slurp(folder.path / "first.txt"));
    CHECK(status != 0);  // mpirun ends all ranks when one is killed
    CHECK(status_of(folder, "a").done < 200);
    const std::string second = output_of(folder, mpirun);
    CAPTURE(second);
    for (const char* share : {"share 1/4", "share 2/4", "share 3/4", "share 4/4"})
        CHECK(second.find(share) != std::string::npos);
    CHECK(status_of(folder, "a").done == 200);
    CHECK(status_of(folder, "a").repeated == 0);
    CHECK(folder.tactus("sweep status " + in(folder, "a") + " --tables").code == 0);
    CHECK(results_of(folder, "a") == results_of(folder, "local"));
}
