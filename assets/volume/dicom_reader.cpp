// SPDX-License-Identifier: Apache-2.0
// Starts and asks the process that reads DICOM files.
#include "assets/file/part.hpp"
#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/dicom_elements.hpp"
#include "assets/volume/dicom_images.hpp"
#include "assets/volume/dicom_message.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace tactus::volume {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif
#else
constexpr bool is_sanitized = false;
#endif

constexpr double max_wait = 60.0;         // s, for a file of any size
constexpr double min_speed = 100'000.0;  // bytes of a file per s
constexpr std::uint64_t program_memory = std::uint64_t{1} << 29;  // of the program itself and its libraries

std::filesystem::path decoder_program() {
    if (const char* given = std::getenv("TACTUS_SCAN_DECODER"); given && *given) return given;
    return file::find_part("the program that reads DICOM files", "tactus-scan-decoder", TACTUS_INSTALLED_PROGRAMS);
}

class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    int get() const { return number_; }

private:
    int number_;
};

/// A copy above the numbers that the process expects, so that dup2 never replaces its own source.
Descriptor high(int number) { return Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, 16)); }

}  // namespace

struct DicomReader::Process {
    pid_t id = -1;
    Descriptor socket, memory;

    ~Process() { end(); }

    bool is_running() const { return id >= 0; }

    void start() {
        std::array<int, 2> pair{};
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0) fail();
        socket = Descriptor(pair[0]);
        const Descriptor theirs(pair[1]);
        memory = Descriptor(::memfd_create("tactus-scan", MFD_CLOEXEC));
        if (memory.get() < 0) fail();
        const Descriptor high_socket = high(theirs.get()), high_memory = high(memory.get());
        posix_spawnattr_t attributes;
        posix_spawn_file_actions_t actions;
        ::posix_spawnattr_init(&attributes);
        ::posix_spawn_file_actions_init(&actions);
        sigset_t none, all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_setsigmask(&attributes, &none);
        ::posix_spawnattr_setsigdefault(&attributes, &all);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
        // Assertions of libraries are no messages to the user; those of sanitizers are to a developer.
        if (!is_sanitized) ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_adddup2(&actions, high_socket.get(), decoder_socket);
        ::posix_spawn_file_actions_adddup2(&actions, high_memory.get(), decoder_memory);
        ::posix_spawn_file_actions_addclosefrom_np(&actions, decoder_memory + 1);
        std::string program = decoder_program().string(),
                    limit = std::to_string(is_sanitized ? 0 : 2 * file::memory_limit() + program_memory);
        std::array<char*, 3> arguments{program.data(), limit.data(), nullptr};
        const int failure = ::posix_spawn(&id, program.c_str(), &actions, &attributes, arguments.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
        if (failure == 0) return;
        id = -1;
        throw Error(fmt::format("{}: the process that reads DICOM files cannot be started: {}", program,
                                std::strerror(failure)));
    }

    /// Ends the process, if there is one, and returns how it ended.
    std::string end() {
        if (id < 0) return {};
        socket = Descriptor();
        int status = 0;
        ::kill(id, SIGKILL);
        const bool is_known = ::waitpid(id, &status, 0) == id;
        id = -1;
        return describe(is_known, status);
    }

    /// The same for a process that closed its socket, without forcing it.
    std::string wait() {
        socket = Descriptor();
        int status = 0;
        const bool is_known = ::waitpid(id, &status, 0) == id;
        id = -1;
        return describe(is_known, status);
    }

    static std::string describe(bool is_known, int status) {
        if (!is_known) return "ended";
        if (WIFSIGNALED(status)) return fmt::format("ended with signal {}", WTERMSIG(status));
        return fmt::format("ended with exit code {}", WEXITSTATUS(status));
    }

    void send(const std::string& bytes) {
        const std::uint64_t size = bytes.size();
        std::string all(reinterpret_cast<const char*>(&size), sizeof size);
        all += bytes;
        for (std::size_t at = 0; at < all.size();) {
            const ssize_t sent = ::send(socket.get(), all.data() + at, all.size() - at, MSG_NOSIGNAL);
            if (sent <= 0) return;  // the answer will be missing, too
            at += static_cast<std::size_t>(sent);
        }
    }

    /// False when the process ended before the answer.
    bool receive(void* to, std::size_t size, std::int64_t until_ns) {
        auto* at = static_cast<char*>(to);
        while (size > 0) {
            pollfd ready{socket.get(), POLLIN, 0};
            if (::poll(&ready, 1, 100) <= 0) {
                try {
                    leave_if_stopped();
                } catch (const Stopped&) {
                    end();
                    throw;
                }
                if (steady_ns() > until_ns) throw TooSlow();
                continue;
            }
            const ssize_t got = ::recv(socket.get(), at, size, 0);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return false;
            at += got, size -= static_cast<std::size_t>(got);
        }
        return true;
    }

    struct TooSlow {};

    /// Writes the bytes of a file in a zip into the memory.
    void give(const std::string& bytes) {
        if (::ftruncate(memory.get(), static_cast<off_t>(bytes.size())) != 0) fail();
        for (std::size_t at = 0; at < bytes.size();) {
            const ssize_t written =
                ::pwrite(memory.get(), bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
            if (written <= 0) fail();
            at += static_cast<std::size_t>(written);
        }
    }

    /// Asks for a file. Throws Error when the process refuses it, ends on it, or takes too long.
    std::string ask(DecoderRequest what, const std::string& name, const std::string* bytes) {
        if (!is_running()) start();
        const std::uint64_t file_size = bytes ? bytes->size() : file::require_file(name);
        if (bytes) give(*bytes);
        MessageWriter request;
        request.put(what);
        request.put_text(name);
        request.put(static_cast<std::uint64_t>(bytes ? bytes->size() : 0));
        send(request.bytes);
        const double longest = max_wait + static_cast<double>(file_size) / min_speed;
        const std::int64_t until_ns = steady_ns() + static_cast<std::int64_t>(1e9 * longest);
        std::uint64_t size = 0;
        std::string reply;
        bool has_ended = false;
        try {
            has_ended = !receive(&size, sizeof size, until_ns) || size > (std::uint64_t{1} << 30);
            if (!has_ended) {
                reply.resize(size);
                has_ended = !receive(reply.data(), size, until_ns);
            }
        } catch (const TooSlow&) {
            end();
            throw Error(fmt::format("{}: the file was not read within {:.0f} s; it must be damaged", name, longest));
        }
        if (has_ended) {
            const std::string how = wait();
            // Our own element walk may locate the damage.
            const std::string doubt = doubt_about_dicom(bytes ? *bytes : file::read_whole_file(name), name);
            if (!doubt.empty()) throw Error(doubt);
            throw Error(fmt::format(
                "{}: the library that reads DICOM files {} on this file: it is damaged, or of a kind that the library "
                "does not support; save it in another way",
                name, how));
        }
        MessageReader in(reply);
        const auto kind = in.get<DecoderReply>();
        if (kind == DecoderReply::refused) throw Error(in.get_text());
        if (kind == DecoderReply::no_room) {
            const std::string why = in.get_text();
            throw file::NoRoom(
                why.empty() ? fmt::format("{}: the file is damaged, or needs more memory than others of its size", name)
                            : why);
        }
        return reply.substr(sizeof kind);
    }

    [[noreturn]] static void fail() {
        throw Error(fmt::format("the process that reads DICOM files cannot be reached: {}", std::strerror(errno)));
    }
};

DicomReader::DicomReader() : process_(std::make_unique<Process>()) {}
DicomReader::~DicomReader() = default;

namespace {

std::vector<DicomImage> images_in(std::string_view reply, const std::filesystem::path& file) {
    MessageReader in(reply);
    std::vector<DicomImage> images;
    for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
        images.push_back(get_image(in));
        images.back().file = file;
    }
    return images;
}

}  // namespace

std::vector<DicomImage> DicomReader::images(const std::filesystem::path& file) {
    const std::lock_guard lock(one_at_a_time_);
    return images_in(process_->ask(DecoderRequest::headers, file.string(), nullptr), file);
}

std::vector<DicomImage> DicomReader::images(const std::shared_ptr<const file::ZipFile>& archive,
                                            const file::ZipFile::Entry& entry) {
    const std::string bytes = archive->read(entry);
    const std::lock_guard lock(one_at_a_time_);
    std::vector<DicomImage> images = images_in(process_->ask(DecoderRequest::headers, entry.name, &bytes), entry.name);
    for (DicomImage& image : images) image.archive = archive, image.entry = entry;
    return images;
}

DicomSamples DicomReader::samples(const DicomImage& image) {
    std::string bytes;
    if (image.archive) bytes = image.archive->read(image.entry);
    const std::lock_guard lock(one_at_a_time_);
    const std::string reply =
        process_->ask(DecoderRequest::samples, image.file.string(), image.archive ? &bytes : nullptr);
    MessageReader in(reply);
    const auto count = in.get<std::uint64_t>();
    DicomSamples samples;
    samples.padded = in.get<std::uint64_t>();
    samples.padding = in.get<double>();
    samples.is_padding_stated = in.get_flag();
    struct stat now{};
    const std::uint64_t size = count * sizeof(float);
    if (::fstat(process_->memory.get(), &now) != 0 || count > (std::uint64_t{1} << 32) ||
        static_cast<std::uint64_t>(now.st_size) < size)
        throw Error(fmt::format("{}: the samples that were read are incomplete", image.file.string()));
    samples.values.resize(count);
    for (std::uint64_t at = 0; at < size;) {
        const ssize_t got = ::pread(process_->memory.get(), reinterpret_cast<char*>(samples.values.data()) + at,
                                    size - at, static_cast<off_t>(at));
        if (got <= 0) Process::fail();
        at += static_cast<std::uint64_t>(got);
    }
    return samples;
}

}  // namespace tactus::volume
