// SPDX-License-Identifier: Apache-2.0
#include "engine/run/journal.hpp"

#include "dsp/core/error.hpp"

namespace tactus::run {

void Journal::open(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds) {
    file_ = std::make_unique<take::TimingLogWriter>(path, plan_hash, seconds);
}

void Journal::attach(GroupRuntime& group) {
    if ((!take_ && !file_) || group.log.ring) return;
    group.log.ring = rings_.emplace_back(std::make_unique<Ring<take::TimingRecord>>(1 << 14)).get();
}

void Journal::detach(GroupRuntime& group) {
    std::erase_if(rings_, [&](const auto& ring) { return ring.get() == group.log.ring; });
    group.log.ring = nullptr;
}

void Journal::drain(const std::vector<std::shared_ptr<GroupRuntime>>& groups) {
    // What each group had done before its ring is emptied: all up to there is in the log afterwards.
    std::vector<take::TakeWriter::Progress> progress;
    for (const auto& group : groups) {
        // The log already contains the end of this group.
        if (!group->log.ring) continue;
        const std::int64_t done = group->done();
        progress.push_back({group->index, done, done * group->plan->period});
    }
    take::TimingRecord record;
    for (const auto& ring : rings_)
        while (ring->pop(record)) {
            if (file_) write(record);
            if (take_) take_->record(record);
        }
    if (take_) take_->checkpoint(progress);
}

void Journal::write(const take::TimingRecord& record) {
    try {
        file_->write(record);
    } catch (const Error& error) {
        loss_ = error.message();
        close();
    }
}

/// A log that had no room ends with what it has, under its own name.
void Journal::close() {
    if (!file_) return;
    try {
        file_->finish();
    } catch (const Error& error) {
        if (loss_.empty()) loss_ = error.message();
    }
    file_.reset();
}

}  // namespace tactus::run
