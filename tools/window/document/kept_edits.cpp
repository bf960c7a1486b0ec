// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/kept_edits.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/window/document/unsaved.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

fs::path write(const fs::path& known, const fs::path& patch, const std::string& text) {
    if (!known.empty()) try {
            file::write_durable_file(known, text);
            return known;
        } catch (const Error&) {
            // Kept under another name, and the original is not touched.
        }
    return keep_unsaved(patch, text);
}

}  // namespace

bool is_in_use(const fs::path& kept) {
    const int handle = ::open(kept.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle < 0) return false;
    const bool is_held = ::flock(handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(handle);
    return is_held;
}

KeptEdits::~KeptEdits() {
    finish();
    let_go();
}

void KeptEdits::let_go() {
    if (lock_ >= 0) ::close(std::exchange(lock_, -1));
}

/// Each writing makes another file of the same name.
void KeptEdits::hold() {
    let_go();
    lock_ = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC);
    if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0) let_go();
}

void KeptEdits::finish() {
    if (!written_.valid()) return;
    try {
        const fs::path file = written_.get();
        if (file != file_) was_restored_ = false;
        file_ = file;
        problem_.clear();
        hold();
    } catch (const std::exception& error) {
        problem_ = error.what();
    }
}

std::string KeptEdits::tend(const EditedText& edited, bool has_unsaved_edits) {
    if (written_.valid()) {
        if (written_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
        finish();
        if (!problem_.empty() && problem_ != told_) return told_ = problem_;
    }
    if (edited.is_saved) {
        if (!was_restored_) remove();
        else {
            // Who undoes what was restored may want it later: new edits get a file of their own.
            let_go();
            file_.clear();
            was_restored_ = false;
            kept_version_ = new_version_ = -1;
        }
        return {};
    }
    if (!has_unsaved_edits || edited.version == kept_version_) return {};
    const auto now = std::chrono::steady_clock::now();
    if (new_version_ <= kept_version_) {
        new_version_ = edited.version;
        new_since_ = now;
    }
    if (now - new_since_ < after) return {};
    kept_version_ = new_version_ = edited.version;
    written_ = std::async(std::launch::async, write, file_, edited.file, edited.text());
    return {};
}

fs::path KeptEdits::keep(const EditedText& edited) {
    finish();
    if (file_.empty() || kept_version_ != edited.version || !problem_.empty())
        file_ = write(file_, edited.file, edited.text());
    problem_.clear();
    kept_version_ = new_version_ = edited.version;
    let_go();
    return file_;
}

void KeptEdits::continue_with(const fs::path& file) {
    finish();
    file_ = file;
    was_restored_ = true;
    hold();
}

void KeptEdits::remove() {
    finish();
    std::error_code ignored;
    if (!file_.empty()) fs::remove(std::exchange(file_, {}), ignored);
    let_go();
    was_restored_ = false;
    kept_version_ = new_version_ = -1;
    problem_.clear();
}

}  // namespace tactus::window
