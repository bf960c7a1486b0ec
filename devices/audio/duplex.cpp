// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/duplex.hpp"

#include "devices/audio/portaudio_session.hpp"
#include "devices/audio/quiet.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <portaudio.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

namespace tactus::audio {

namespace {

/// State shared by the callback and the waiting thread.
struct Exchange {
    std::vector<float> out, in;
    std::size_t outputs = 1, inputs = 1, output_channel = 0, input_channel = 0;
    std::atomic<std::size_t> done{0};
    std::atomic<int> lost{0};
};

int exchange(const void* input, void* output, unsigned long frames, const PaStreamCallbackTimeInfo*,
             PaStreamCallbackFlags flags, void* state) {
    auto& shared = *static_cast<Exchange*>(state);
    const auto* in = static_cast<const float*>(input);
    auto* out = static_cast<float*>(output);
    constexpr PaStreamCallbackFlags trouble = paInputUnderflow | paInputOverflow | paOutputUnderflow | paOutputOverflow;
    std::size_t at = shared.done.load(std::memory_order_relaxed);
    if (at > 0 && (flags & trouble) != 0) shared.lost.fetch_add(1, std::memory_order_relaxed);
    for (unsigned long i = 0; i < frames; ++i) {
        const bool running = at < shared.out.size();
        for (std::size_t c = 0; c < shared.outputs; ++c)
            out[i * shared.outputs + c] = running && c == shared.output_channel ? shared.out[at] : 0.0f;
        if (!running) continue;
        shared.in[at] = in != nullptr ? in[i * shared.inputs + shared.input_channel] : 0.0f;
        ++at;
    }
    shared.done.store(at, std::memory_order_release);
    return paContinue;
}

PaDeviceIndex find_duplex(const std::string& wanted) {
    const PaHostApiIndex jack = Pa_HostApiTypeIdToHostApiIndex(paJACK);
    std::string names;
    PaDeviceIndex best = paNoDevice;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(i);
        if (info.maxInputChannels < 1 || info.maxOutputChannels < 1) continue;
        const std::string name = audio_device_name(i);
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name);
        if (!wanted.empty() && name.find(wanted) != std::string::npos) return i;
        // JACK owns the card when it runs; otherwise the system's default output, if it can also record.
        const bool is_default = info.hostApi == jack || i == Pa_GetDefaultOutputDevice();
        if (best == paNoDevice || (is_default && Pa_GetDeviceInfo(best)->hostApi != jack)) best = i;
    }
    if (names.empty()) throw Error("no sound device on this machine has both outputs and inputs");
    if (!wanted.empty())
        throw Error(fmt::format("no sound device '{}' with both outputs and inputs; there are: {}", wanted, names));
    return best;
}

int checked_channel(int channel, int count, const char* kind) {
    if (channel < 0 || channel >= count)
        throw Error(fmt::format("the device has {} {} channels; channel {} does not exist", count, kind, channel + 1));
    return channel;
}

}  // namespace

Captured play_and_capture(const Duplex& duplex, const std::vector<float>& samples,
                          const std::function<void(double)>& progress) {
    auto session = std::make_unique<PortAudioSession>();
    auto shared = std::make_unique<Exchange>();
    const PaDeviceIndex device = find_duplex(duplex.device);
    const PaDeviceInfo& info = *Pa_GetDeviceInfo(device);
    Captured captured;
    captured.device = audio_device_name(device);
    shared->output_channel =
        static_cast<std::size_t>(checked_channel(duplex.output_channel, info.maxOutputChannels, "output"));
    shared->input_channel =
        static_cast<std::size_t>(checked_channel(duplex.input_channel, info.maxInputChannels, "input"));
    shared->outputs = shared->output_channel + 1;
    shared->inputs = shared->input_channel + 1;
    shared->out = samples;
    shared->in.assign(samples.size(), 0.0f);
    const PaStreamParameters in{device, static_cast<int>(shared->inputs), paFloat32, info.defaultLowInputLatency,
                                nullptr};
    const PaStreamParameters out{device, static_cast<int>(shared->outputs), paFloat32, info.defaultLowOutputLatency,
                                 nullptr};
    PaStream* stream = nullptr;
    PaError error;
    {
        const QuietStderr quiet;
        error = Pa_OpenStream(&stream, &in, &out, duplex.rate, paFramesPerBufferUnspecified, paNoFlag, exchange,
                              shared.get());
        if (error == paNoError) error = Pa_StartStream(stream);
    }
    if (error != paNoError) {
        if (stream != nullptr) Pa_CloseStream(stream);
        throw Error(fmt::format("'{}' cannot play and record at {:g} Hz: {}", captured.device, duplex.rate,
                                Pa_GetErrorText(error)));
    }
    if (const PaStreamInfo* reported = Pa_GetStreamInfo(stream)) {
        captured.output_latency = reported->outputLatency;
        captured.input_latency = reported->inputLatency;
    }
    std::size_t before = 0;
    for (int idle = 0; before < samples.size();) {
        sleep_for(10'000'000);
        const std::size_t now = shared->done.load(std::memory_order_acquire);
        idle = now == before ? idle + 1 : 0;
        before = now;
        if (progress) progress(static_cast<double>(now) / static_cast<double>(samples.size()));
        if (idle < 300) continue;
        // Stopping a stream whose server died would block forever, so it is left open until the process ends.
        static_cast<void>(shared.release());
        static_cast<void>(session.release());
        throw Error(fmt::format("'{}' has stopped answering", captured.device));
    }
    {
        const QuietStderr quiet;
        Pa_StopStream(stream);
        Pa_CloseStream(stream);
    }
    captured.samples = std::move(shared->in);
    captured.underflows = shared->lost.load();
    return captured;
}

}  // namespace tactus::audio
