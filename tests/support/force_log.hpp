// SPDX-License-Identifier: Apache-2.0
// What a watched device was given, with the device's own clock: a file that outlives every process that writes it.
#pragma once

#include "dsp/core/clock.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tactus::test {

class ForceLog {
public:
    struct Entry {
        std::int64_t at_ns;  ///< boot_ns of the device's process
        double force;        ///< N
    };

    explicit ForceLog(const std::string& path) {
        const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        if (file < 0 || ::ftruncate(file, sizeof(Memory)) != 0) throw std::runtime_error("no force log at " + path);
        memory_ = static_cast<Memory*>(::mmap(nullptr, sizeof(Memory), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
        ::close(file);
        if (memory_ == MAP_FAILED) throw std::runtime_error("no force log at " + path);
    }
    ~ForceLog() { ::munmap(memory_, sizeof(Memory)); }
    ForceLog(const ForceLog&) = delete;
    ForceLog& operator=(const ForceLog&) = delete;

    // The device.
    void add(double force) noexcept {
        const std::uint64_t at = memory_->count.load();
        if (at == most) return;
        memory_->entries[at] = {boot_ns(), force};
        memory_->count.store(at + 1);
    }
    void note_open() noexcept { memory_->process.store(::getpid()); }
    void note_closed() noexcept { memory_->closed_ns.store(boot_ns()); }

    // The test.
    std::vector<Entry> entries() const { return {memory_->entries, memory_->entries + memory_->count.load()}; }
    std::uint64_t count() const { return memory_->count.load(); }
    double last() const {
        const std::uint64_t count = memory_->count.load();
        return count == 0 ? 0.0 : memory_->entries[count - 1].force;
    }
    /// Of the last force that was not zero; 0: there was none.
    std::int64_t last_force_ns() const {
        std::int64_t at = 0;
        for (const Entry& entry : entries())
            if (entry.force != 0.0) at = entry.at_ns;
        return at;
    }
    double max_after(std::int64_t from_ns) const {
        double force = 0.0;
        for (const Entry& entry : entries())
            if (entry.at_ns >= from_ns) force = std::max(force, entry.force);
        return force;
    }
    bool is_closed() const { return memory_->closed_ns.load() != 0; }
    pid_t process() const { return memory_->process.load(); }

private:
    static constexpr std::uint64_t most = 400'000;
    struct Memory {
        std::atomic<std::uint64_t> count;
        std::atomic<std::int64_t> closed_ns;
        std::atomic<pid_t> process;
        Entry entries[most];
    };
    Memory* memory_ = nullptr;
};

}  // namespace tactus::test
