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

#include <cstdlib>
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
        if (what == DecoderRequest::headers) {
            headers.erase(source.name);
            const std::vector<DicomImage>& found = images(source);
            out.put(DecoderReply::images);
            out.put(static_cast<std::uint64_t>(found.size()));
            for (const DicomImage& image : found) put_image(out, image);
            return std::move(out.bytes);
        }
        SharedMemory memory;
        std::uint64_t samples = 0;
        const DicomSamples about = decode_dicom_samples(source, images(source), [&](std::size_t count) {
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
