// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/decoder/decoder_program.hpp"

#include "assets/file/room.hpp"
#include "assets/volume/decoder/dicom_decode.hpp"
#include "assets/volume/dicom_message.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace tactus::volume {

namespace {

bool receive(void* to, std::size_t size) {
    auto* at = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t got = ::recv(decoder_socket, at, size, 0);
        if (got <= 0) return false;
        at += got, size -= static_cast<std::size_t>(got);
    }
    return true;
}

bool send(const std::string& bytes) {
    const std::uint64_t size = bytes.size();
    std::string all(reinterpret_cast<const char*>(&size), sizeof size);
    all += bytes;
    for (std::size_t at = 0; at < all.size();) {
        const ssize_t sent = ::send(decoder_socket, all.data() + at, all.size() - at, MSG_NOSIGNAL);
        if (sent <= 0) return false;
        at += static_cast<std::size_t>(sent);
    }
    return true;
}

/// The memory that both processes see, mapped while a request is answered.
class SharedMemory {
public:
    ~SharedMemory() {
        if (begin_) ::munmap(begin_, size_);
    }
    SharedMemory() = default;
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    void* map(std::size_t size, bool makes_room) {
        if (makes_room && ::ftruncate(decoder_memory, static_cast<off_t>(size)) != 0) throw std::bad_alloc();
        void* mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, decoder_memory, 0);
        if (mapped == MAP_FAILED) throw std::bad_alloc();
        begin_ = mapped, size_ = size;
        return mapped;
    }

private:
    void* begin_ = nullptr;
    std::size_t size_ = 0;
};

/// Bounds the memory of one file: GDCM reserves what damaged lengths state, gigabytes for a file of kilobytes. Compressed files
/// unpack to many times their size, which `samples` counts.
class FileLimit {
public:
    FileLimit(double file_size, double samples) {
        ::getrlimit(RLIMIT_AS, &before_);
        // Sanitizers reserve terabytes: their processes have no limit.
        if (before_.rlim_max == RLIM_INFINITY) return;
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const double present = static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE));
        rlimit own = before_;
        own.rlim_cur = static_cast<rlim_t>(
            std::min(static_cast<double>(before_.rlim_max), present + at_least + 64.0 * file_size + 16.0 * samples));
        ::setrlimit(RLIMIT_AS, &own);
    }
    ~FileLimit() { ::setrlimit(RLIMIT_AS, &before_); }
    FileLimit(const FileLimit&) = delete;
    FileLimit& operator=(const FileLimit&) = delete;

private:
    static constexpr double at_least = 512e6;  // bytes
    rlimit before_{};
};

struct Decoder {
    std::map<std::string, std::vector<DicomImage>> headers;  // of the files of a series
    std::size_t count = 0;

    const std::vector<DicomImage>& images(const DicomSource& source) {
        if (const auto found = headers.find(source.name); found != headers.end()) return found->second;
        if (count > 200'000) headers.clear(), count = 0;
        std::vector<DicomImage> images = decode_dicom_images(source);
        count += images.size() + 1;
        return headers[source.name] = std::move(images);
    }

    std::string answer(MessageReader& in) {
        const auto what = in.get<DecoderRequest>();
        DicomSource source{in.get_text(), nullptr};
        const auto packed = in.get<std::uint64_t>();
        std::string bytes;
        if (packed > 0) {
            SharedMemory memory;
            bytes.assign(static_cast<const char*>(memory.map(packed, false)), packed);
            source.bytes = &bytes;
        }
        MessageWriter out;
        std::error_code unknown;
        const std::uintmax_t on_disk = source.bytes ? packed : std::filesystem::file_size(source.name, unknown);
        const double size = unknown ? 0.0 : static_cast<double>(on_disk);
        if (what == DecoderRequest::headers) {
            const FileLimit limit(size, 0.0);
            headers.erase(source.name);
            const std::vector<DicomImage>& found = images(source);
            out.put(DecoderReply::images);
            out.put(static_cast<std::uint64_t>(found.size()));
            for (const DicomImage& image : found) put_image(out, image);
            return std::move(out.bytes);
        }
        SharedMemory memory;
        std::uint64_t samples = 0;
        const std::vector<DicomImage>& known = images(source);
        double claimed = 0.0;
        for (const DicomImage& image : known) claimed += double(image.rows) * image.columns;
        const FileLimit limit(size, claimed);
        const DicomSamples about = decode_dicom_samples(source, known, [&](std::size_t count) {
            samples = count;
            return static_cast<float*>(memory.map(count * sizeof(float), true));
        });
        out.put(DecoderReply::samples);
        out.put(samples);
        out.put(static_cast<std::uint64_t>(about.padded));
        out.put(about.padding);
        out.put(about.is_padding_stated);
        return std::move(out.bytes);
    }
};

}  // namespace

int run_scan_decoder(const char* argument) {
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    const std::uint64_t bytes = std::strtoull(argument, nullptr, 10);
    if (bytes > 0) {
        const rlimit memory{bytes, bytes};
        ::setrlimit(RLIMIT_AS, &memory);
        file::set_memory_limit(bytes);
    }
    Decoder decoder;
    for (std::uint64_t size = 0; receive(&size, sizeof size);) {
        if (size > 1u << 20) return 2;
        std::string request(size, '\0');
        if (!receive(request.data(), size)) return 0;
        MessageWriter refused;
        std::string reply;
        try {
            MessageReader in(request);
            reply = decoder.answer(in);
        } catch (const Error& error) {
            refused.put(DecoderReply::refused);
            refused.put_text(error.what());
        } catch (const file::NoRoom& error) {
            refused.put(DecoderReply::no_room);
            refused.put_text(error.what());
        } catch (const std::bad_alloc&) {
            refused.put(DecoderReply::no_room);
            refused.put_text("");
        } catch (const std::exception& error) {
            refused.put(DecoderReply::refused);
            refused.put_text(error.what());
        }
        if (!send(reply.empty() ? refused.bytes : reply)) return 0;
    }
    return 0;
}

}  // namespace tactus::volume
